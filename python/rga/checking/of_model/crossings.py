"""Members that cross, and nodes that stand on a member, without a joint."""

from collections.abc import Iterator

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.checking.finding import MOST_NAMED, Finding, parts
from rga.checking.over_ranges import OverRanges

#: distance at which lines meet, as a share of the length of the shorter member
MEET = 1e-4
#: sine of the angle between lines that run alongside
ALONGSIDE = 1e-6
#: pairs that are looked at together
CHUNK = 200_000


def crossings(over: OverRanges) -> Iterator[Finding]:
    """Members that pass through a node or through each other and are not joined there."""
    model = over.model
    if not model.members:
        return
    nodes = {name: number for number, name in enumerate(model.nodes)}
    points = np.array(list(model.nodes.values()), dtype=float)
    ends = np.array([[nodes[one] for one in member.nodes] for member in model.members.values()])
    names, node_names = list(model.members), list(model.nodes)
    used = np.unique(ends)
    on = _nodes_on_members(points, ends, used)
    for member, node in on[:MOST_NAMED]:
        yield Finding(
            "warning",
            parts("member", [names[member]]),
            f"node {node_names[node]!r} stands on it and is not joined to it",
            "split the member at the node, if they are joined there",
        )
    if len(on) > MOST_NAMED:
        more = f"{len(on) - MOST_NAMED} more nodes stand on members that they are not joined to"
        yield Finding("warning", "members", more, "split the members there")
    passed = {(int(member), int(node)) for member, node in on}
    across = [
        pair
        for pair in _crossing(points, ends)
        if not any((a, int(n)) in passed for a, b in (pair, pair[::-1]) for n in ends[b])
    ]
    if across:
        shown = ", ".join(f"{names[a]!r} and {names[b]!r}" for a, b in across[:MOST_NAMED])
        more = f" and {len(across) - MOST_NAMED} more pairs" if len(across) > MOST_NAMED else ""
        yield Finding(
            "note",
            f"members {shown}{more}",
            "they cross without a joint",
            "add a node where they cross, if they are joined there",
        )


def _nodes_on_members(points: FloatArray, ends: IntArray, used: IntArray) -> list[tuple[int, int]]:
    """Members and the nodes that stand within them."""
    found = []
    start, along = points[ends[:, 0]], points[ends[:, 1]] - points[ends[:, 0]]
    lengths = np.linalg.norm(along, axis=1)
    step = max(1, CHUNK // max(len(used), 1))
    for first in range(0, len(ends), step):
        some = slice(first, first + step)
        away = points[used][None] - start[some, None]
        share = np.einsum("mnk,mk->mn", away, along[some]) / lengths[some, None] ** 2
        off = np.linalg.norm(away - share[..., None] * along[some, None], axis=2)
        within = (off <= MEET * lengths[some, None]) & (np.abs(share - 0.5) < 0.5 - MEET)
        within &= (used[None] != ends[some, :1]) & (used[None] != ends[some, 1:])
        found += [(first + int(m), int(used[n])) for m, n in np.argwhere(within)]
    return found


def _crossing(points: FloatArray, ends: IntArray) -> list[tuple[int, int]]:
    """Pairs of members that meet within both."""
    found: list[tuple[int, int]] = []
    for one, other in _near(points, ends):
        meets = _meet(points, ends[one], ends[other])
        found += list(zip(one[meets].tolist(), other[meets].tolist(), strict=True))
    return found


def _near(points: FloatArray, ends: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Pairs of members whose boxes touch, in chunks: those that begin before another ends."""
    low, high = points[ends].min(axis=1), points[ends].max(axis=1)
    room = MEET * (high - low).max(initial=0.0)
    axis = int(np.argmax(np.ptp(points, axis=0)))
    order = np.argsort(low[:, axis], kind="stable")
    last = np.searchsorted(low[order, axis], high[order, axis] + room, side="right")
    counts = np.maximum(last - np.arange(len(order)) - 1, 0)
    begin = 0
    while begin < len(order):
        total = np.cumsum(counts[begin:])
        end = begin + max(1, int(np.searchsorted(total, CHUNK, side="right")))
        place = np.repeat(np.arange(begin, end), counts[begin:end])
        within = np.arange(len(place)) - np.repeat(
            np.cumsum(counts[begin:end]) - counts[begin:end], counts[begin:end]
        )
        one, other = order[place], order[place + 1 + within]
        touch = ((low[one] <= high[other] + room) & (low[other] <= high[one] + room)).all(axis=1)
        yield one[touch], other[touch]
        begin = end


def _meet(points: FloatArray, one: IntArray, other: IntArray) -> BoolArray:
    """Whether lines between nodes meet within both, bool[pairs]."""
    p, q = points[one[:, 0]], points[other[:, 0]]
    u, v = points[one[:, 1]] - p, points[other[:, 1]] - q
    shared = (one[:, :, None] == other[:, None, :]).any(axis=(1, 2))
    uu, vv, uv = (np.einsum("ij,ij->i", *pair) for pair in ((u, u), (v, v), (u, v)))
    away = q - p
    au, av = np.einsum("ij,ij->i", away, u), np.einsum("ij,ij->i", away, v)
    apart = uu * vv - uv**2
    skew = apart > ALONGSIDE * uu * vv
    safe = np.where(skew, apart, 1.0)
    s, t = (au * vv - av * uv) / safe, (au * uv - av * uu) / safe
    gap = np.linalg.norm(away + t[:, None] * v - s[:, None] * u, axis=1)
    within = (np.abs(s - 0.5) < 0.5 - MEET) & (np.abs(t - 0.5) < 0.5 - MEET)
    near = gap <= MEET * np.sqrt(np.minimum(uu, vv))
    return np.asarray(~shared & skew & within & near)
