"""Members and supports that carry nothing until they are stretched or moved far enough."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.effect import Effect
from rga.model.effects.bearings import (
    Direction,
    Supports,
    directions,
    member_scale,
    only_free,
    supported,
)
from rga.model.effects.stiffness import some_member
from rga.model.parameter import Parameter, Place, Positive, Prior, Value, listed
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

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from _trusses(model)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"slip": Positive(5e-4, 1.0, trials=(-2.0, 0.5))}

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

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from directions(model, held=False, axes=("ux",))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        scale = 0.1 * member_scale(model)
        return {
            "gap": Positive(2e-3, 1.0, trials=(-1.0, 0.0, 1.0)),
            "stiffness": Positive(scale, 2.0, trials=(-1.0, 1.0)),
        }

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        for node in supported(structure, self.support):
            if value["stiffness"] > 0:
                spring = len(structure.arrays["spring_dof"])
                structure.add_spring(node, -1, DOFS.index(self.dof), value["stiffness"])
                structure.laws.append(Law("play", None, spring, abs(value["gap"])))


def _trusses(model: Model) -> Iterator[dict[str, Any]]:
    """Truss members one by one, and groups of nothing else."""
    trusses = {name for name, member in model.members.items() if member.kind == "truss"}
    yield from ({"member": name} for name in model.members if name in trusses)
    yield from ({"group": group} for group, names in model.groups.items() if trusses >= set(names))


def _only_trusses(
    effect: Effect, model: Model, member: str | list[str] | None, group: str | list[str] | None
) -> None:
    some_member(effect, member, group)
    members = [*listed(member), *(name for one in listed(group) for name in model.groups[one])]
    for name in members:
        if model.members[name].kind != "truss":
            raise ValueError(f"{effect.kind} acts on truss members, and {name!r} is a frame member")
