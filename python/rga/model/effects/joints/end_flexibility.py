"""Joints of a frame that are not rigid."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.action import Action
from rga.model.bending import bending_stiffness
from rga.model.effect import Effect
from rga.model.effects.members.places import Groups, Members, some_member
from rga.model.joints import joints, run_on
from rga.model.parameter import Parameter, Place, Positive, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Structure

BENDING = np.array([4, 5, 10, 11])
#: A joint between a pin and a rigid one, over EI/L of its beam, as the median and the spread of a
#: log-normal whose 90 % range is that of semi-rigid joints: below 0.5 it is as good as a pin,
#: above 25 it is rigid even in a frame that sways (EN 1993-1-8, 5.2.2.5; 8 where it cannot sway).
PINNED, RIGID = 0.5, 25.0
USUAL = Positive(float(np.sqrt(PINNED * RIGID)), float(np.log(RIGID / PINNED) / (2 * 1.645)))


class EndFlexibility(Effect):
    """Springs about both bending axes at the rigid ends of frame members: semi-rigid joints.

    An end at which a member runs on in a straight line as another one is no joint and stays rigid.
    It is proposed where members are joined to others: of those that meet at a corner the steepest,
    a column, is what the others are joined to.

    Attributes:
        at_end: the first or the last node of the members; None: both.
    """

    kind: Literal["end_flexibility"] = "end_flexibility"
    action = Action(
        inspect=(
            "the joints at the ends of {place}: bolts, end plates, welds and web of what it is "
            "joined to"
        ),
        check=(
            "whether these joints were designed as rigid, as semi-rigid or as pins, and their "
            "details in the drawings"
        ),
        test=(
            "{load}, on {place}, with tilt sensors on both sides of the joint: their "
            "difference is how far it turns"
        ),
    )
    usual = (
        f"stiffness {USUAL} times the mean EI/L of the members: semi-rigid joints by EN 1993-1-8, "
        "5.2.2.5"
    )
    structural = True
    member: Members = None
    group: Groups = None
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
        return {"stiffness": USUAL.times(mean)}

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


def _nothing_else(model: Model, names: list[str], count: int) -> bool:
    """Whether frame members have so many ends at which they do not run on."""
    numbers = {node: number for number, node in enumerate(model.nodes)}
    points = np.array(list(model.nodes.values()), dtype=float)
    frames = [name for name, member in model.members.items() if member.kind == "frame"]
    ends = np.array([[numbers[node] for node in model.members[name].nodes] for name in frames])
    return int((~run_on(points, ends))[np.isin(frames, names)].sum()) == count
