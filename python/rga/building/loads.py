"""Load cases as the effects of a model file."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from rga.building.quantities import Amount, amount, amounts
from rga.errors import InputError

#: components of a force [N], or of a force and a moment [N, N m]
Force = Sequence[Amount]
Effects = dict[str, dict[str, Any]]


def load_effects(
    name: str,
    factor: Any,
    forces: Mapping[str, Force],
    down: Mapping[str, Amount],
    uniform: Mapping[str, Force],
    points: Mapping[str, tuple[Amount, Force]],
    members_of: Callable[[str, str], list[str]],
) -> Effects:
    """The effects of a load case, by name: that of the case where it needs only one.

    Args:
        factor: on all of them, as in a model file.
        forces, down, uniform, points: see `ModelBuilder.load_case`.
        members_of: members of a member's or a group's name, which is said to stand somewhere.
    """
    where = f"load case {name!r}"
    effects: Effects = {}
    at_nodes = {node: _force(force, f"{where}, node {node!r}") for node, force in forces.items()}
    for node, force in down.items():
        vertical = -amount(force, "N", f"{where}, node {node!r}")
        at_nodes.setdefault(node, [0.0, 0.0, 0.0])[2] += vertical
    if at_nodes:
        effects["at nodes"] = {"kind": "nodal_load", "forces": at_nodes}
    for place, load in uniform.items():
        along = amounts(load, "N/m", f"{where}, {place!r}", 3)
        effects[f"along {place}"] = _on_members(members_of(place, where), {"uniform": along})
    for place, (x, point) in points.items():
        at = {
            "x": amount(x, "m", f"{where}, {place!r}"),
            "point": amounts(point, "N", f"{where}, {place!r}", 3),
        }
        effects[f"on {place}"] = _on_members(members_of(place, where), at)
    if not effects:
        raise InputError("there is no load in it", where, "give forces, down, uniform or points")
    for effect in effects.values():
        effect["factor"] = factor
    if len(effects) == 1:
        return {name: next(iter(effects.values()))}
    return {f"{name} {part}": effect for part, effect in effects.items()}


def _force(force: Force, where: str) -> list[float]:
    if isinstance(force, list | tuple) and len(force) == 6:
        return [*amounts(force[:3], "N", where, 3), *amounts(force[3:], "N m", where, 3)]
    return amounts(force, "N", where, 3)


def _on_members(members: list[str], load: dict[str, Any]) -> dict[str, Any]:
    member = members[0] if len(members) == 1 else members
    return {"kind": "member_load", "member": member, **load}
