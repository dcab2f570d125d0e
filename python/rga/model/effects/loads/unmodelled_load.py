"""Loads that the model does not have."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.loads.line_forces import line_forces
from rga.model.parameter import Normal, Number, Parameter, Place, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Load, Structure, check_direction
from rga.model.structure.arrays import HELD_BY_PLANE

USUAL = Normal(0.0, 1000.0)


class UnmodelledLoad(Effect):
    """A load along the members of a group that follows a context: wind, snow.

    Attributes:
        direction: of the load in global axes.
        context: the context variable that the load follows.
        rate: [N/m per unit of the context].
    """

    kind: Literal["unmodelled_load"] = "unmodelled_load"
    action = Action(
        inspect="what loads {place}: wind, snow, water, stored goods",
        check="a record of that load (wind, snow depth) beside this one",
        test="compare days with it and days without it",
    )
    usual = f"from one end of the range of the context to the other {USUAL} N/m: a judgement"
    loads_by_geometry = True
    group: Annotated[str | list[str], Place("group")]
    direction: Annotated[tuple[Number, Number, Number], Place("")]
    context: Annotated[str, Place("context")]
    rate: Annotated[Value, Parameter("N/m per unit", 0.0)] = 0.0

    def check(self, model: Model) -> None:
        check_direction(self.direction)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        for group in model.groups:
            for held, direction in ((1, (0.0, 1.0, 0.0)), (2, (0.0, 0.0, 1.0))):
                if held not in HELD_BY_PLANE.get(model.plane or "", ()):
                    for context in model.context:
                        yield {"group": group, "direction": direction, "context": context}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        low, high = model.context[place["context"]].range
        return {"rate": Normal(0.0, USUAL.spread / (high - low))}

    def drivers(self) -> set[str]:
        return super().drivers() | {self.context}

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        return {"rate": super().values(contexts, rows)["rate"] * contexts[self.context]}

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        return [Load(values["rate"], forces=line_forces(structure, self.group, self.direction))]
