"""Joints of a truss that are no pins."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.parameter import Parameter, Place, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

BENDING = np.array([4, 5, 10, 11])
TORSION = 3
USUAL = Positive(3.0, 1.5)


class JointRigidity(Effect):
    """Truss members become frame members with a spring about both bending axes at each end.

    The springs do not pass on torsion.
    """

    kind: Literal["joint_rigidity"] = "joint_rigidity"
    action = Action(
        inspect=(
            "gusset plates and end connections of {place}: stiff joints bend the members, look "
            "for cracks at their ends"
        ),
        check="gauges off the axis of their member: they read this bending",
        test="{load}, with gauges on both faces at the ends of a member of {place}",
    )
    usual = f"stiffness {USUAL} times the mean EI/L of the members: a judgement"
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
        return {"stiffness": USUAL.times(stiffness)}

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
