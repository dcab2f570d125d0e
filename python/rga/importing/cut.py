"""Members that nodes cut into several of the model, and loads along the whole of them."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.importing.draft import NEAR, ModelDraft


@dataclass(frozen=True)
class CutPart:
    """A member of the model: from where to where it goes along the whole [m]."""

    name: str
    start: float
    end: float


@dataclass
class CutMember:
    """A member of a file as members of the model, in order.

    Attributes:
        name: of the file's member.
        axes: local axes as rows, in the model's axes, float[3, 3].
        parts: the members; none where they could not be added.
    """

    draft: ModelDraft
    name: str
    axes: FloatArray
    parts: list[CutPart] = field(default_factory=list)

    @property
    def length(self) -> float:
        """Length of the whole [m]."""
        return self.parts[-1].end

    def local(self, vector: Sequence[float]) -> FloatArray:
        """A vector of the file's axes in local axes, float[3]."""
        return np.asarray(self.axes @ np.array(self.draft.vector(vector)))

    def load_point(self, case: str, place: float, force: FloatArray, where: str) -> None:
        """Put a point load [N] in local axes at a place [m]; one beyond its ends is refused."""
        if not self.draft.within(self.name, [place], self.length, where):
            return
        place = min(max(place, 0.0), self.length)
        part = next((one for one in self.parts if place <= one.end), self.parts[-1])
        at = min(max(place - part.start, 0.0), part.end - part.start)
        self.draft.load_member(case, part.name, where, point=clean(force), x=at)

    def load_line(
        self,
        case: str,
        places: tuple[float, float],
        sizes: tuple[FloatArray, FloatArray],
        where: str,
    ) -> None:
        """Put a load that grows from one size to another in local axes [N/m] between two places.

        One that reaches beyond the ends, or runs backwards, is refused.
        """
        if not self.draft.within(self.name, places, self.length, where):
            return
        (start, end), (first, last) = places, sizes
        near = NEAR * self.length
        for part in self.parts:
            low, high = max(part.start, start), min(part.end, end)
            if high - low <= near:
                continue
            ends = [first + (last - first) * (at - start) / (end - start) for at in (low, high)]
            whole = low - part.start <= near and part.end - high <= near
            if whole and np.allclose(ends[0], ends[1], rtol=1e-12, atol=0):
                self.draft.load_member(case, part.name, where, uniform=clean(ends[0]))
                continue
            for axis, (one, other) in zip("xyz", zip(*map(clean, ends), strict=True), strict=True):
                if one or other:
                    shape = (low - part.start, high - part.start, one, other)
                    self.draft.load_member(case, part.name, where, trapezoid=shape, axis=axis)


def add_cut(
    draft: ModelDraft,
    name: str,
    nodes: Sequence[str],
    section: str,
    material: str,
    where: str,
    axes: FloatArray,
    *,
    kind: Literal["truss", "frame"] = "frame",
    releases: dict[str, list[str]] | None = None,
    end_springs: dict[str, dict[str, float]] | None = None,
    groups: Collection[str] = (),
) -> CutMember | None:
    """Add a member that goes through nodes, as one of the model between each and the next.

    Args:
        draft: takes them.
        name: of the member; its parts have it with a number, where there are several.
        nodes: from its beginning to its end.
        axes: local axes as rows, in the model's axes, float[3, 3].
        releases: of the two ends of the whole, as `end_springs` are.

    Returns:
        What became of it; None where it has no length.
    """
    cut = CutMember(draft, name, axes)
    pairs = list(pairwise(nodes))
    at = 0.0
    for number, pair in enumerate(pairs, start=1):
        ends = [end for end, own in (("i", number == 1), ("j", number == len(pairs))) if own]
        part = name if len(pairs) == 1 else f"{name} {number}"
        first, last = (np.array(draft.nodes[node]) for node in pair)
        size = float(np.linalg.norm(last - first))
        more: dict[str, Any] = {"local_y": draft.unturned(axes[1].tolist())}
        if kind == "frame":
            more["releases"] = {end: (releases or {}).get(end, []) for end in ends}
            more["end_springs"] = {end: (end_springs or {}).get(end, {}) for end in ends}
        if not draft.add_member(
            part, pair, section, material, where, kind=kind, groups=list(groups), **more
        ):
            return None
        cut.parts.append(CutPart(part, at, at + size))
        at += size
    draft.frames += 1
    draft.cut_frames += len(pairs) > 1
    if len(pairs) > 1:
        between = ", ".join(nodes[1:-1][:10]) + (" ..." if len(nodes) > 12 else "")
        said = f"member {name} is {len(pairs)} members, {name} 1 and so on: {between} cut it"
        draft.notes.say("assumed", where, said)
    return cut


def nodes_between(draft: ModelDraft, first: str, last: str) -> list[str]:
    """Nodes on the line between two, from the first to the last, these among them."""
    names = list(draft.nodes)
    points = np.array(list(draft.nodes.values()))
    start, along = np.array(draft.nodes[first]), np.subtract(draft.nodes[last], draft.nodes[first])
    size = float(np.linalg.norm(along))
    shares = (points - start) @ along / size**2
    off = np.linalg.norm(points - start - np.outer(shares, along), axis=1)
    inside = (off <= NEAR * size) & (shares > NEAR) & (shares < 1 - NEAR)
    between = sorted(np.flatnonzero(inside), key=lambda k: float(shares[k]))
    return [first, *(names[k] for k in between), last]


def clean(vector: FloatArray) -> tuple[float, ...]:
    """A vector without what rounding leaves of components that are none.

    >>> clean(np.array([1e-17, -2.0, 0.0]))
    (0.0, -2.0, 0.0)
    """
    largest = float(np.abs(vector).max())
    return tuple(0.0 if abs(v) <= 1e-14 * largest else float(v) for v in vector)
