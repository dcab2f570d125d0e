"""Axles that stand elsewhere than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.loads.axle_load import AxleLoad
from rga.model.effects.loads.targets import Effects, check_target, together
from rga.model.parameter import Driven, Normal, Parameter, Prior, Value, listed
from rga.model.schema import Model

USUAL = Normal(0.0, 1.0)


class LoadPosition(Effect):
    """Axles that stand ahead of the position given [m]."""

    kind: Literal["load_position"] = "load_position"
    action = Action(
        check="the position that is assumed for {place}: path, first axle, lane, and the clock",
        test="a vehicle at rest at marked places",
    )
    usual = f"offset {USUAL} m: a judgement"
    effect: Effects
    offset: Annotated[Value, Parameter("m", 0.0)] = 0.0

    def check(self, model: Model) -> None:
        check_target(self, self.effect, model, "position")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        # The offset of a position that is inferred cannot be separated from the position itself.
        names = [
            name
            for name, effect in model.effects.items()
            if isinstance(effect, AxleLoad)
            and (
                not isinstance(effect.position, Driven)
                or model.context[effect.position.context].law == "independent"
            )
        ]
        yield from together(model, names)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"offset": USUAL}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        for name in listed(self.effect):
            other = all_values[name]
            other["position"] = other["position"] + values["offset"]
