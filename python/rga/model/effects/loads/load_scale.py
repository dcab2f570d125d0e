"""Loads that are larger or smaller than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.loads.targets import Effects, check_target, load_names, together
from rga.model.parameter import Factor, Parameter, Prior, Value, listed
from rga.model.schema import Model

USUAL = Factor(0.15)


class LoadScale(Effect):
    """A factor on a load, or on several: weights, impact."""

    kind: Literal["load_scale"] = "load_scale"
    action = Action(
        check=(
            "the weights that are assumed for {place}, by weighing them, and the dynamic increment"
        ),
        test="a known weight, moved at a crawl",
    )
    usual = f"factor {USUAL}: a judgement"
    effect: Effects
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    def check(self, model: Model) -> None:
        check_target(self, self.effect, model, "factor")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from together(model, list(load_names(model)))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": USUAL}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        for name in listed(self.effect):
            other = all_values[name]
            other["factor"] = other["factor"] * values["factor"]
