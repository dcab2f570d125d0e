"""What moves with the structure and is not in the model."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.parameter import Normal, Parameter, Place, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Structure

USUAL = Normal(0.0, 100.0)
#: on a node, where it may be a vehicle
USUAL_ON_NODE = Normal(0.0, 1000.0, tail=0.5)
#: of what the model states there already, where that is more
SHARE = 0.25


class AddedMass(Effect):
    """A mass along the members of a group [kg/m], or on nodes [kg]: ballast, asphalt, ice.

    It changes natural frequencies alone: what it weighs is a load of its own. Negative, something
    that the model has was taken off.

    Attributes:
        per_length: along the members of the group [kg/m].
        mass: on each of the nodes [kg].
    """

    kind: Literal["added_mass"] = "added_mass"
    action = Action(
        inspect="what was put on or taken off {place}: surfacing, ballast, ice, equipment",
        check="works on the structure about the onset, and the weather",
        test="level the span against earlier levels: what moves also weighs",
    )
    usual = (
        f"per_length {USUAL} kg/m, mass {USUAL_ON_NODE} kg with a long tail, or {SHARE:.0%} of "
        "what the model has there where that is more: judgements"
    )
    structural = True
    on_modes = True
    group: Annotated[str | list[str] | None, Place("group")] = None
    node: Annotated[str | list[str] | None, Place("node")] = None
    per_length: Annotated[Value, Parameter("kg/m", 0.0)] = 0.0
    mass: Annotated[Value, Parameter("kg", 0.0)] = 0.0

    def check(self, model: Model) -> None:
        given = self.model_fields_set
        along, on_nodes = self.group is not None, self.node is not None
        if along == on_nodes or (along and "mass" in given) or (on_nodes and "per_length" in given):
            raise ValueError(
                "added_mass is along the members of a group (give group and per_length [kg/m]) or "
                "on nodes (give node and mass [kg])"
            )

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"group": group} for group in model.groups)
        yield from ({"node": node} for node in model.nodes)
        masses = (mass.node for mass in model.masses.values() if mass.node is not None)
        heavy = list(dict.fromkeys(masses))
        if len(heavy) > 1:
            yield {"node": heavy}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        key, parameter, usual = "node", "mass", USUAL_ON_NODE
        if "group" in place:
            key, parameter, usual = "group", "per_length", USUAL
        there = set(listed(place[key]))
        stated = [
            getattr(one, parameter)
            for one in model.masses.values()
            if there & set(listed(getattr(one, key)))
        ]
        return {parameter: usual.times(max([1.0, *(SHARE * one / usual.spread for one in stated)]))}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        masses = structure.masses
        if self.group is not None:
            masses["line"][structure.named(None, self.group)] += value["per_length"]
        else:
            at = sorted({structure.nodes[name] for name in listed(self.node)})
            masses["nodal"][at, :3] += value["mass"]
