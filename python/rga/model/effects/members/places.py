"""Members and groups as places of effects."""

from collections.abc import Iterator
from typing import Annotated, Any

from rga.model.effect import Effect
from rga.model.parameter import Place, listed
from rga.model.schema import Model

Members = Annotated[str | list[str] | None, Place("member")]
Groups = Annotated[str | list[str] | None, Place("group")]


def members_and_groups(model: Model, members: set[str]) -> Iterator[dict[str, Any]]:
    """Some members one by one, and the groups that hold more than one of them."""
    yield from ({"member": name} for name in model.members if name in members)
    for group, names in model.groups.items():
        if len(members.intersection(names)) > 1:
            yield {"group": group}


def trusses(model: Model) -> Iterator[dict[str, Any]]:
    """Truss members one by one, and groups of two and more of them and of nothing else."""
    bars = {name for name, member in model.members.items() if member.kind == "truss"}
    yield from ({"member": name} for name in model.members if name in bars)
    for group, names in model.groups.items():
        if len(names) > 1 and bars >= set(names):
            yield {"group": group}


def some_member(
    effect: Effect, member: str | list[str] | None, group: str | list[str] | None
) -> None:
    """ValueError where a place names neither members nor groups."""
    if not listed(member) + listed(group):
        raise ValueError(f"{effect.kind} needs a place: give 'member' or 'group'")


def only_trusses(
    effect: Effect, model: Model, member: str | list[str] | None, group: str | list[str] | None
) -> None:
    """ValueError where a place names no members, or a frame member."""
    some_member(effect, member, group)
    members = [*listed(member), *(name for one in listed(group) for name in model.groups[one])]
    for name in members:
        if model.members[name].kind != "truss":
            raise ValueError(f"{effect.kind} acts on truss members, and {name!r} is a frame member")
