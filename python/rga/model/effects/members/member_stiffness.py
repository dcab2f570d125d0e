"""Members that are stiffer or softer than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.effect import Effect
from rga.model.effects.members.places import Groups, Members, members_and_groups, some_member
from rga.model.effects.members.positive import positive
from rga.model.parameter import Factor, Parameter, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Structure

#: a member, or all braces of a panel, may also be lost altogether
MEMBER, GROUP = Factor(0.5, tail=0.5), Factor(0.2, tail=0.5)


class MemberStiffness(Effect):
    """A factor on EA and EI of members: section loss, a crack, corrosion, or a larger section."""

    kind: Literal["member_stiffness"] = "member_stiffness"
    action = Action(
        inspect=(
            "{place}: section loss, cracks, loose rivets or bolts, buckled plates, and its "
            "connections; measure the remaining thickness"
        ),
        check=(
            "the section of {place} in the drawings against the structure, and the gauge on it if "
            "there is one"
        ),
        test=(
            "{load}, near {place}, with a gauge on it: where area is lost its force hardly "
            "changes and its strain grows"
        ),
    )
    usual = (
        f"factor {MEMBER} of a member, {GROUP} of a group: a judgement, that half of a section may "
        "be lost at one place and hardly all along a group; more, to all of it, is rare"
    )
    structural = True
    takes_section = True
    member: Members = None
    group: Groups = None
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from members_and_groups(model, set(model.members))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": MEMBER if "member" in place else GROUP}

    def check(self, model: Model) -> None:
        some_member(self, self.member, self.group)

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        positive(self, value["factor"])
        chosen = structure.named(self.member, self.group)
        structure.arrays["E"][chosen] *= value["factor"]
        structure.arrays["G"][chosen] *= value["factor"]
