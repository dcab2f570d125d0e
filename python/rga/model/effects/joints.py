"""Joints that are neither the pins of an ideal truss nor the rigid ones of an ideal frame."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.bending import bending_stiffness
from rga.model.effect import Effect
from rga.model.effects.stiffness import some_member
from rga.model.joints import joints, run_on
from rga.model.parameter import Parameter, Place, Positive, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Structure

BENDING = np.array([4, 5, 10, 11])
TORSION = 3
#: A joint between a pin and a rigid one, over EI/L of its beam, as the middle and the spread of a
#: log-normal whose 90 % range is that of semi-rigid joints: below 0.5 it is as good as a pin,
#: above 25 it is rigid even in a frame that sways (EN 1993-1-8, 5.2.2.5; 8 where it cannot sway).
PINNED, RIGID = 0.5, 25.0
SEMI_RIGID = float(np.sqrt(PINNED * RIGID))
SEMI_RIGID_SPREAD = float(np.log(RIGID / PINNED) / (2 * 1.645))


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


class EndFlexibility(Effect):
    """Springs about both bending axes at the rigid ends of frame members: semi-rigid joints.

    An end at which a member runs on in a straight line as another one is no joint and stays rigid.

    Attributes:
        at_end: the first or the last node of the members; None: both.
    """

    kind: Literal["end_flexibility"] = "end_flexibility"
    structural = True
    member: Annotated[str | list[str] | None, Place("member")] = None
    group: Annotated[str | list[str] | None, Place("group")] = None
    at_end: Annotated[Literal["i", "j"] | None, Place("")] = None
    stiffness: Annotated[Value, Parameter("N m/rad", float("inf"), least=0.0)] = float("inf")

    def check(self, model: Model) -> None:
        some_member(self, self.member, self.group)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        ends = joints(model)
        for name, own in ends.items():
            yield from ({"member": name, "at_end": end} for end in own)
            if len(own) > 1:
                yield {"member": name}
        for group, names in model.groups.items():
            frames = [name for name in names if model.members[name].kind == "frame"]
            joined = [end for name in frames for end in ends.get(name, ())]
            if len(frames) > 1 and len(joined) > 1 and _nothing_else(model, frames, len(joined)):
                yield {"group": group}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        named = [*listed(place.get("member"))]
        named += [name for group in listed(place.get("group")) for name in model.groups[group]]
        frames = [name for name in named if model.members[name].kind == "frame"]
        mean = float(np.mean([bending_stiffness(model, name) for name in frames]))
        return {"stiffness": Positive(SEMI_RIGID * mean, SEMI_RIGID_SPREAD)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        if np.isinf(value["stiffness"]):
            return
        arrays = structure.arrays
        frames = np.flatnonzero(arrays["frame"])
        joined = ~run_on(arrays["coordinates"], arrays["ends"][frames])
        joined &= np.isin(frames, structure.named(self.member, self.group))[:, None]
        if self.at_end is not None:
            joined[:, "ji".index(self.at_end)] = False
        yields = np.repeat(joined, 2, axis=1)
        connection = arrays["connection"][np.ix_(frames, BENDING)]
        yields &= np.isinf(connection)
        arrays["connection"][np.ix_(frames, BENDING)] = np.where(
            yields, value["stiffness"], connection
        )


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


def _nothing_else(model: Model, names: list[str], count: int) -> bool:
    """Whether frame members have so many ends at which they do not run on."""
    numbers = {node: number for number, node in enumerate(model.nodes)}
    points = np.array(list(model.nodes.values()), dtype=float)
    frames = [name for name, member in model.members.items() if member.kind == "frame"]
    ends = np.array([[numbers[node] for node in model.members[name].nodes] for name in frames])
    return int((~run_on(points, ends))[np.isin(frames, names)].sum()) == count


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
