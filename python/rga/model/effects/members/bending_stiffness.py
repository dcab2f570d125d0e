"""Frame members that bend more or less than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.member_stiffness import MemberStiffness
from rga.model.effects.members.places import Groups, Members, members_and_groups, some_member
from rga.model.effects.members.positive import positive
from rga.model.parameter import Parameter, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure


class BendingStiffness(Effect):
    """A factor on EI alone of frame members: what bends is not what stretches.

    A flange that is lost or was added, a slab that cracks, a section that was laid on its side.
    `member_stiffness` is the factor on EA and EI together.
    """

    kind: Literal["bending_stiffness"] = "bending_stiffness"
    action = Action(
        inspect=(
            "{place}: flanges that are corroded, cracked or added, a slab that acts with it or "
            "has cracked"
        ),
        check=(
            "the second moment of area of {place} in the drawings, and which way its section lies"
        ),
        test=(
            "{load}, across {place}, with gauges on both of its flanges: their difference over"
            " the bending moment is 1/EI"
        ),
    )
    usual = "as of `member_stiffness`"
    structural = True
    member: Members = None
    group: Groups = None
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        frames = {name for name, member in model.members.items() if member.kind == "frame"}
        yield from members_and_groups(model, frames)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return MemberStiffness.priors(model, place)

    def check(self, model: Model) -> None:
        some_member(self, self.member, self.group)

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"])
        chosen = structure.named(self.member, self.group)
        structure.arrays["Iy"][chosen] *= value["factor"]
        structure.arrays["Iz"][chosen] *= value["factor"]
