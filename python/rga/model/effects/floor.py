"""Floors and decks that carry a share of the force of a chord."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.effect import Effect
from rga.model.parameter import Parameter, Place, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure


class AddedAxialArea(Effect):
    """Area [m2] parallel to the members of a group, fully tied: a deck that shares the force."""

    kind: Literal["added_axial_area"] = "added_axial_area"
    structural = True
    group: Annotated[str | list[str], Place("group")]
    area: Annotated[Value, Parameter("m2", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"group": group} for group in model.groups)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"area": Positive(0.3 * _mean_area(model, place["group"]), 1.0)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        chosen = structure.named(None, self.group)
        if value["area"] > 0:
            structure.add_bars(structure.arrays["ends"][chosen], value["area"], chosen)


class FloorParticipation(Effect):
    """A chord parallel to a group, tied to its nodes by springs: stringers through cross girders.

    The parallel chord has the modulus and the temperature of the members beside it. Its nodes move
    with those of the group across the chord, and along it through the springs.

    Attributes:
        area: area of the parallel chord [m2].
        connector_stiffness: stiffness of the tie at each node [N/m].
    """

    kind: Literal["floor_participation"] = "floor_participation"
    structural = True
    group: Annotated[str | list[str], Place("group")]
    area: Annotated[Value, Parameter("m2", 0.0, least=0.0)] = 0.0
    connector_stiffness: Annotated[Value, Parameter("N/m", None, least=0.0)]

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        for group, names in model.groups.items():
            nodes = [node for name in names for node in model.members[name].nodes]
            if len(names) > 1 and max(nodes.count(node) for node in nodes) == 2:
                yield {"group": group}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        area = _mean_area(model, place["group"])
        chord = np.mean([_axial_stiffness(model, name) for name in model.groups[place["group"]]])
        return {
            "area": Positive(0.3 * area, 1.0),
            "connector_stiffness": Positive(0.03 * float(chord), 2.0),
        }

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        if value["area"] <= 0 or value["connector_stiffness"] <= 0:
            return
        chosen = structure.named(None, self.group)
        ends = structure.arrays["ends"][chosen]
        beside, numbers = np.unique(ends, return_inverse=True)
        coordinates = structure.arrays["coordinates"]
        parallel = structure.add_nodes(coordinates[beside])
        axis = coordinates[ends[0, 1]] - coordinates[ends[0, 0]]
        along = int(np.argmax(np.abs(axis)))
        structure.arrays["fixed"][parallel] = True
        structure.arrays["fixed"][parallel, along] = False
        ties = np.column_stack([beside, parallel])
        structure.add_springs(ties, along, value["connector_stiffness"])
        structure.add_bars(parallel[numbers.reshape(-1, 2)], value["area"], chosen)


def _mean_area(model: Model, group: str) -> float:
    return float(np.mean([model.sections[model.members[m].section].A for m in model.groups[group]]))


def _axial_stiffness(model: Model, name: str) -> float:
    member = model.members[name]
    ends = [np.array(model.nodes[node]) for node in member.nodes]
    modulus = model.materials[member.material].E
    return float(modulus * model.sections[member.section].A / np.linalg.norm(ends[1] - ends[0]))
