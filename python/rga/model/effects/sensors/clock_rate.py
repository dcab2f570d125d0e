"""A clock that runs at another rate than the logger says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.parameter import Factor, Parameter, Prior, Value
from rga.model.schema import Model

USUAL = Factor(0.01)


class ClockRate(Effect):
    """A factor on all natural frequencies as they are read: a sampling rate that is not as stated.

    All modes move alike, as with another modulus, or another mass of everything.
    """

    kind: Literal["clock_rate"] = "clock_rate"
    action = Action(
        inspect="the sampling rate of the logger against a clock that is right",
        check="the length of a long file against its first and last time",
        test="record a tone of known frequency with the same logger",
    )
    usual = f"factor {USUAL}: a judgement; a quartz is a hundred times better, a timer is not"
    on_sensors = True
    on_modes = True
    factor: Annotated[Value, Parameter("-", 1.0, least=0.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield {}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": USUAL}

    def frequency_factor(self, values: Values) -> FloatArray:
        return values["factor"]
