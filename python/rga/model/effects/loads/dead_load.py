"""Permanent loads that the model does not have."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.loads.line_forces import line_forces
from rga.model.parameter import Normal, Parameter, Place, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Load, Structure

USUAL = Normal(0.0, 1000.0)


class DeadLoad(Effect):
    """A permanent load along the members of a group, downward [N/m]."""

    kind: Literal["dead_load"] = "dead_load"
    action = Action(
        inspect="what was put on or taken off {place}: surfacing, ballast, pipes, stored goods",
        check="works on the structure about the onset",
        test="level the span against earlier levels",
    )
    usual = f"force per length {USUAL} N/m: a judgement"
    loads_by_geometry = True
    group: Annotated[str | list[str], Place("group")]
    force_per_length: Annotated[Value, Parameter("N/m", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"group": group} for group in model.groups)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"force_per_length": USUAL}

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        forces = line_forces(structure, self.group, (0.0, 0.0, -1.0))
        return [Load(values["force_per_length"], forces=forces, permanent=not self.drivers())]
