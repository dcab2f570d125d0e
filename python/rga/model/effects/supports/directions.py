"""Directions of supports as places of effects."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any

import numpy as np

from rga.model.bending import bending_at
from rga.model.parameter import Place, listed
from rga.model.schema import DOFS, Dof, Model
from rga.model.structure import Structure
from rga.model.structure.arrays import HELD_BY_PLANE

Supports = Annotated[str | list[str], Place("support")]
MaybeSupports = Annotated[str | list[str] | None, Place("support")]
MaybeNodes = Annotated[str | list[str] | None, Place("node")]
Direction = Annotated[Dof, Place("")]


def directions(
    model: Model, *, held: bool, axes: tuple[str, ...] = ("ux", "uy", "uz")
) -> Iterator[dict[str, Any]]:
    """Support directions that are held, or free: one by one, by lines across the bridge, all."""
    for dof in (axis for axis in _in_plane(model, DOFS[:3]) if axis in axes):
        yield from _alone_and_together(model, dof, _acting(model, dof, held))


def rotations(model: Model, *, held: bool) -> Iterator[dict[str, Any]]:
    """The same of rotations that bend a frame member there: that of a pin means nothing."""
    for dof in _in_plane(model, DOFS[3:]):
        bending = [
            name
            for name in _acting(model, dof, held)
            if bending_at(model, model.supports[name].node, dof) > 0
        ]
        yield from _alone_and_together(model, dof, bending)


def sprung_nodes(model: Model) -> Iterator[dict[str, Any]]:
    """Nodes that springs of the model tie to the ground: one by one, by lines, and all."""
    for dof in _in_plane(model, DOFS):
        names = [one.node for one in model.springs if one.to is None and one.dof == dof]
        yield from (
            {"node": place, "dof": dof} for place in _lines(model, {name: name for name in names})
        )


def check_sprung_or_supported(
    kind: str, support: str | list[str] | None, node: str | list[str] | None, dof: str, model: Model
) -> None:
    """ValueError unless one place is given, and springs to the ground hold its nodes."""
    if (support is None) == (node is None):
        raise ValueError(f"{kind} needs one place: give 'support' or 'node'")
    sprung = {(spring.node, spring.dof) for spring in model.springs if spring.to is None}
    for name in listed(node):
        if (name, dof) not in sprung:
            raise ValueError(f"no spring to the ground holds node {name!r} in {dof}")


def sprung_stiffness(model: Model, place: Mapping[str, Any]) -> float:
    """Mean stiffness of the springs to the ground at the nodes of a place [N/m or N m/rad]."""
    named = listed(place["node"])
    known = [
        spring.stiffness
        for spring in model.springs
        if spring.node in named and spring.dof == place["dof"] and spring.to is None
    ]
    return float(np.mean(known))


def turns(dof: str) -> bool:
    """Whether a dof is a rotation."""
    return DOFS.index(dof) >= 3


def only_free(model: Model, support: str | list[str] | None, dof: str) -> None:
    """ValueError where one of the supports holds the direction."""
    for name in listed(support):
        if dof in model.supports[name].fixed:
            raise ValueError(f"support {name!r} holds {dof}: name a free direction")


def supported(structure: Structure, support: str | list[str] | None) -> list[int]:
    """Nodes of the supports of a place."""
    return [structure.supports[name] for name in listed(support)]


def _in_plane(model: Model, dofs: tuple[str, ...]) -> list[str]:
    held = [DOFS[k] for k in HELD_BY_PLANE.get(model.plane or "", ())]
    return [dof for dof in dofs if dof not in held]


def _acting(model: Model, dof: str, held: bool) -> list[str]:
    """Supports that hold a dof, or leave it free."""
    return [
        name
        for name, support in model.supports.items()
        if (dof in support.fixed) == held and support.along is None
    ]


def _alone_and_together(model: Model, dof: str, names: list[str]) -> Iterator[dict[str, Any]]:
    """A dof of supports one by one, by lines across the bridge, and of all."""
    nodes = {name: model.supports[name].node for name in names}
    yield from ({"support": place, "dof": dof} for place in _lines(model, nodes))


def _lines(model: Model, nodes: dict[str, str]) -> Iterator[str | list[str]]:
    """Names of nodes one by one, those of a line across the bridge together, and all of them."""
    yield from nodes
    lines: dict[float, list[str]] = {}
    for name, node in nodes.items():
        lines.setdefault(round(model.nodes[node][0], 3), []).append(name)
    together = [*lines.values(), list(nodes)] if len(lines) > 1 else [list(nodes)]
    yield from (line for line in together if len(line) > 1)
