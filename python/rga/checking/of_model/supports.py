"""Supports that hold nothing."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.errors import InputError
from rga.model.schema import DOFS, Model
from rga.model.structure.arrays import HELD_BY_PLANE


def supports(over: OverRanges) -> Iterator[Finding]:
    """Supports that fix no direction, that the plane holds already, or that stand twice."""
    model = over.model
    of_plane = {DOFS[dof] for dof in HELD_BY_PLANE.get(model.plane or "", ())}
    turning = _turning(model)
    seen: dict[tuple[str, str], str] = {}
    for name, support in model.supports.items():
        where = parts("support", [name])
        if support.along is not None:
            continue
        if not support.fixed:
            yield Finding(
                "warning", where, "it fixes nothing", 'give it "fixed" directions, or "along"'
            )
            continue
        left = [dof for dof in support.fixed if dof not in of_plane]
        if not left:
            what = f"it fixes {', '.join(support.fixed)} alone, which the plane {model.plane} holds"
            yield Finding("warning", where, what, "fix a direction of the plane")
        elif all(dof[0] == "r" for dof in left) and support.node not in turning:
            what = "it fixes rotations alone, of a node at which no frame member turns"
            yield Finding("warning", where, what, "fix directions, or join a frame member")
        for dof in left:
            first = seen.setdefault((support.node, dof), name)
            if first != name:
                what = f"{dof} of node {support.node!r} is fixed by support {first!r} already"
                yield Finding("note", where, what, "name it in one of them")
    yield from _stiffened(over)


def _turning(model: Model) -> set[str]:
    """Nodes at which a frame member, a spring or a tie turns."""
    found = {node for one in model.members.values() if one.kind == "frame" for node in one.nodes}
    found |= {
        node for one in model.springs if one.dof[0] == "r" for node in (one.node, one.to or "")
    }
    return found | {node for tie in model.ties for node in tie.nodes}


def _stiffened(over: OverRanges) -> Iterator[Finding]:
    """Springs to the ground in a direction that a support fixes."""
    try:
        arrays = over.structure.arrays
    except InputError:
        return
    names = list(over.model.nodes)
    nodes, dofs = arrays["spring_node"], arrays["spring_dof"]
    idle = (
        (nodes[:, 1] < 0) & arrays["fixed"][nodes[:, 0], dofs] if len(nodes) else np.zeros(0, bool)
    )
    held = [f"{names[n]} {DOFS[d]}" for n, d in zip(nodes[idle, 0], dofs[idle], strict=True)]
    if held:
        yield Finding(
            "warning",
            f"springs at {', '.join(held[:6])}",
            "a support fixes the direction of the spring: the spring does nothing",
            "take that direction out of the support, or take the spring out",
        )
