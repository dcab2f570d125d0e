"""Members and supports that carry nothing until they are stretched or moved far enough."""

from collections.abc import Mapping
from typing import Annotated, Literal

from rga.model.effect import Effect
from rga.model.effects.bearings import Direction, Supports, only_free, supported
from rga.model.effects.stiffness import some_member
from rga.model.parameter import Parameter, Place, Value, listed
from rga.model.schema import DOFS, Model
from rga.model.structure import Law, Structure

Members = Annotated[str | list[str] | None, Place("member")]
Groups = Annotated[str | list[str] | None, Place("group")]


class JointSlip(Effect):
    """Bolts that slip: truss members carry nothing within +-slip [m] of their length."""

    kind: Literal["joint_slip"] = "joint_slip"
    structural = True
    member: Members = None
    group: Groups = None
    slip: Annotated[Value, Parameter("m", 0.0, least=0.0)] = 0.0

    def check(self, model: Model) -> None:
        _only_trusses(self, model, self.member, self.group)

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for member in structure.named(self.member, self.group):
            structure.laws.append(Law("play", int(member), None, abs(value["slip"])))


class TensionOnly(Effect):
    """Rods and cables: truss members carry nothing until they are longer by a slack [m]."""

    kind: Literal["tension_only"] = "tension_only"
    structural = True
    member: Members = None
    group: Groups = None
    slack: Annotated[Value, Parameter("m", None)]

    def check(self, model: Model) -> None:
        _only_trusses(self, model, self.member, self.group)
        if self.onset is not None:
            raise ValueError("tension_only has no onset: a member is a rod or it is none")

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for member in structure.named(self.member, self.group):
            structure.laws.append(Law("tension", int(member), None, value["slack"]))


class SupportGap(Effect):
    """A stop on a free direction: a stiffness [N/m] once the support has moved by a gap [m]."""

    kind: Literal["support_gap"] = "support_gap"
    structural = True
    support: Supports
    dof: Direction
    gap: Annotated[Value, Parameter("m", None, least=0.0)]
    stiffness: Annotated[Value, Parameter("N/m", 0.0, least=0.0)] = 0.0

    def check(self, model: Model) -> None:
        only_free(model, self.support, self.dof)

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for node in supported(structure, self.support):
            if value["stiffness"] > 0:
                spring = len(structure.arrays["spring_dof"])
                structure.add_spring(node, -1, DOFS.index(self.dof), value["stiffness"])
                structure.laws.append(Law("play", None, spring, abs(value["gap"])))


def _only_trusses(
    effect: Effect, model: Model, member: str | list[str] | None, group: str | list[str] | None
) -> None:
    some_member(effect, member, group)
    members = [*listed(member), *(name for one in listed(group) for name in model.groups[one])]
    for name in members:
        if model.members[name].kind != "truss":
            raise ValueError(f"{effect.kind} acts on truss members, and {name!r} is a frame member")
