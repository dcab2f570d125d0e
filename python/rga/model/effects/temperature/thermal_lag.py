"""Members that warm later than the air."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.temperature.temperature import Temperature
from rga.model.parameter import Parameter, Positive, Prior, Value
from rga.model.schema import Model

USUAL = Positive(2.0, 1.0)


class ThermalLag(Effect):
    """Members that follow the air temperature late, with a time constant [h]."""

    kind: Literal["thermal_lag"] = "thermal_lag"
    action = Action(
        check="where the temperature sensor sits: air and steel warm at different rates",
        test="a temperature sensor on the steel beside the one there is",
    )
    usual = f"time constant {USUAL} h: a judgement"
    remembers = True
    time_constant: Annotated[Value, Parameter("h", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if any(
            effect.drivers() for effect in model.effects.values() if isinstance(effect, Temperature)
        ):
            yield {}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"time_constant": USUAL}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        for other in all_values.values():
            for key in ("delta", "temperature"):
                if key in other:
                    other[key] = lagged(other[key], time, values["time_constant"] * 3600)


def lagged(driver: FloatArray, time: FloatArray, time_constant: FloatArray) -> FloatArray:
    """First-order lag of a driver that is linear between rows; it starts in equilibrium."""
    step, constant = np.diff(time), time_constant[1:]
    lags, later = constant > 0, step > 0
    ratio = np.where(lags & later, step, 1.0) / np.where(lags, constant, 1.0)
    decay = np.exp(-ratio)
    slope = np.diff(driver) / ratio
    added = driver[1:] - slope - decay * (driver[:-1] - slope)
    # The same moment twice: nothing follows at once.
    decay = np.where(lags, np.where(later, decay, 1.0), 0.0)
    added = np.where(lags, np.where(later, added, 0.0), driver[1:])
    state = [float(driver[0])]
    for kept, more in zip(decay.tolist(), added.tolist(), strict=True):
        state.append(kept * state[-1] + more)
    return np.array(state)
