"""Floors that carry a share of the force of a chord."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.scales import axial_stiffness, mean_area
from rga.model.parameter import Parameter, Place, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

#: share of its length by which a member of a chord goes along the axis that the floor runs along
STRAIGHT = 0.95
AREA, TIES = Positive(0.3, 1.0), Positive(0.03, 2.0)


class FloorParticipation(Effect):
    """A chord parallel to a group, tied to its nodes by springs: stringers through cross girders.

    The parallel chord has the modulus and the temperature of the members beside it. Its nodes move
    with those of the group across the chord, and along it through the springs.

    Attributes:
        area: area of the parallel chord [m2].
        connector_stiffness: stiffness of the tie at each node [N/m].
    """

    kind: Literal["floor_participation"] = "floor_participation"
    action = Action(
        inspect=(
            "stringers and cross girders along {place} and their connections: a share of the "
            "chord's force runs through them, and they were seldom designed for it"
        ),
        check=(
            "whether the drawings show expansion joints in the floor, and whether these still move"
        ),
        test=(
            "{load}, with gauges on the stringers beside {place} and on the end panels of the chord"
        ),
    )
    usual = (
        f"area {AREA} times the mean area of the group, connector stiffness {TIES} times the mean "
        "EA/L of its members: a judgement"
    )
    structural = True
    group: Annotated[str | list[str], Place("group")]
    area: Annotated[Value, Parameter("m2", 0.0, least=0.0)] = 0.0
    connector_stiffness: Annotated[Value, Parameter("N/m", None, least=0.0)]

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        for group, names in model.groups.items():
            nodes = [node for name in names for node in model.members[name].nodes]
            joined = len(names) > 1 and max(nodes.count(node) for node in nodes) == 2
            if joined and _runs_along_an_axis(model, names):
                yield {"group": group}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        area = mean_area(model, place["group"])
        chord = np.mean([axial_stiffness(model, name) for name in model.groups[place["group"]]])
        return {
            "area": AREA.times(area),
            "connector_stiffness": TIES.times(float(chord)),
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


def _runs_along_an_axis(model: Model, names: Iterable[str]) -> bool:
    """Whether members lie along one global axis: no floor runs along rakers or diagonals."""
    ends = np.array([[model.nodes[node] for node in model.members[name].nodes] for name in names])
    spans = np.abs(ends[:, 1] - ends[:, 0])
    along = spans / np.linalg.norm(spans, axis=1, keepdims=True)
    return bool((along.min(axis=0) >= STRAIGHT).any())
