"""Joints that are not the pins of an ideal truss."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.effect import Effect
from rga.model.parameter import Parameter, Place, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

BENDING = np.array([4, 5, 10, 11])
TORSION = 3


class JointRigidity(Effect):
    """Truss members become frame members with a spring about both bending axes at each end.

    The springs do not pass on torsion.
    """

    kind: Literal["joint_rigidity"] = "joint_rigidity"
    structural = True
    group: Annotated[str | list[str], Place("group")]
    stiffness: Annotated[Value, Parameter("N m/rad", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        bendable = [group for group in model.groups if _flexural_stiffness(model, [group]) > 0]
        yield from ({"group": group} for group in bendable)
        if len(bendable) > 1:
            yield {"group": bendable}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        group = place["group"]
        stiffness = _flexural_stiffness(model, [group] if isinstance(group, str) else group)
        return {"stiffness": Positive(3 * stiffness, 1.5)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        if value["stiffness"] <= 0:
            return
        chosen = structure.named(None, self.group)
        arrays = structure.arrays
        chosen = chosen[
            ~arrays["frame"][chosen] & (arrays["Iy"][chosen] > 0) & (arrays["Iz"][chosen] > 0)
        ]
        arrays["frame"][chosen] = True
        arrays["connection"][np.ix_(chosen, BENDING)] = value["stiffness"]
        arrays["connection"][chosen, TORSION] = 0.0


class RigidEndZone(Effect):
    """A rigid length at each end of frame members: gussets."""

    kind: Literal["rigid_end_zone"] = "rigid_end_zone"
    structural = True
    group: Annotated[str | list[str], Place("group")]
    length: Annotated[Value, Parameter("m", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        for group, names in model.groups.items():
            if any(model.members[name].kind == "frame" for name in names):
                yield {"group": group}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"length": Positive(0.3, 0.7)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        chosen = structure.named(None, self.group)
        longest = 0.45 * structure.lengths[chosen]
        structure.arrays["rigid_end"][chosen] = np.minimum(value["length"], longest)[:, None]


def _flexural_stiffness(model: Model, groups: list[str]) -> float:
    """Mean EI/L of the truss members of some groups [N m]; 0 where one has no second moment."""
    found = []
    for name in dict.fromkeys(name for group in groups for name in model.groups[group]):
        member, section = model.members[name], model.sections[model.members[name].section]
        ends = [np.array(model.nodes[node]) for node in member.nodes]
        if member.kind == "truss":
            moment = min(section.Iy, section.Iz)
            found.append(
                model.materials[member.material].E * moment / np.linalg.norm(ends[1] - ends[0])
            )
    return float(np.mean(found)) if found and min(found) > 0 else 0.0
