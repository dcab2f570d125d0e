"""What plane trusses have in common: two chords over panels, verticals between them, supports."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.sections.sizes import length
from rga.building.structures.given import (
    AnyMaterial,
    AnySection,
    Joints,
    add_material,
    check_count,
    check_word,
)
from rga.errors import InputError

Shape = Literal["parallel", "gable"]
Ends = Literal["inclined", "vertical"]
#: share of the height at a share of the span
Rise = Callable[[float], float]

MOST_PANELS = 1000


def level(_: float) -> float:
    """The top chord of a parallel truss."""
    return 1.0


def gable(share: float) -> float:
    """The top chord of a roof with two slopes."""
    return 1.0 - abs(2.0 * share - 1.0)


def parabola(share: float) -> float:
    """The top chord of a bowstring."""
    return 4.0 * share * (1.0 - share)


@dataclass(frozen=True)
class Chords:
    """The chords of a plane truss, and how it is put together.

    Attributes:
        span, height: [m].
        panels: their number.
        rise: of the top chord.
        vertical_ends: whether the top chord reaches the supports.
        joints: "pinned" or "rigid".
    """

    span: float
    height: float
    panels: int
    rise: Rise
    vertical_ends: bool
    joints: Joints

    @property
    def first(self) -> int:
        """Number of the first node of the top chord."""
        return 0 if self.vertical_ends else 1

    @property
    def kind(self) -> Literal["truss", "frame"]:
        """Of the members."""
        return "frame" if self.joints == "rigid" else "truss"

    def mirrored(self, node: str) -> str:
        """The node on the other side of the middle."""
        return f"{node[0]}{self.panels - int(node[1:])}"

    def top(self) -> range:
        """Numbers of the nodes of the top chord."""
        return range(self.first, self.panels - self.first + 1)


def chords_of(
    name: str,
    span: Amount,
    height: Amount,
    panels: int,
    rise: Rise,
    ends: str = "inclined",
    joints: str = "pinned",
    fewest: int = 2,
    even: bool = False,
) -> Chords:
    """Chords of sizes that can be some (else InputError)."""
    where = f"truss {name!r}"
    wide, high = length(span, f"span of {where}"), length(height, f"height of {where}")
    check_count(panels, "panels", where, fewest, MOST_PANELS)
    if even and panels % 2:
        raise InputError(
            f"{panels} panels have no node in the middle", where, "give an even number"
        )
    check_word(ends, ("inclined", "vertical"), "ends", where)
    check_word(joints, ("pinned", "rigid"), "joints", where)
    how: Joints = "rigid" if joints == "rigid" else "pinned"
    return Chords(wide, high, panels, rise, ends == "vertical", how)


def drawn_chords(
    name: str,
    chords: Chords,
    chord: AnySection,
    diagonal: AnySection,
    vertical: AnySection | None,
    material: AnyMaterial,
    with_top: bool = True,
) -> ModelBuilder:
    """A truss of chords and supports, and its sections "chord", "diagonal" and "vertical"."""
    truss = ModelBuilder(name, plane="xz")
    add_material(truss, material)
    truss.add_section("chord", chord).add_section("diagonal", diagonal)
    if with_top:
        truss.add_section("vertical", diagonal if vertical is None else vertical)
    panels, kind = chords.panels, chords.kind
    for i in range(panels + 1):
        truss.add_node(f"L{i}", chords.span * i / panels)
    for i in range(panels):
        truss.add_member(f"L{i}", f"L{i + 1}", "chord", kind=kind, groups="bottom chord")
    if with_top:
        _draw_top(truss, chords)
    truss.support("L0", "pinned", name="left")
    return truss.support(f"L{panels}", "roller along x", name="right")


def _draw_top(truss: ModelBuilder, chords: Chords) -> None:
    panels, kind = chords.panels, chords.kind
    for i in chords.top():
        up = chords.height * chords.rise(i / panels)
        truss.add_node(f"U{i}", chords.span * i / panels, z=up)
    for i in chords.top()[:-1]:
        truss.add_member(f"U{i}", f"U{i + 1}", "chord", kind=kind, groups="top chord")
    if not chords.vertical_ends:
        # Where the top chord rises from the supports, what leads up to it is a part of it.
        group = "end posts" if math.isclose(chords.rise(0.0), 1.0) else "top chord"
        for start, end in (("L0", "U1"), (f"U{panels - 1}", f"L{panels}")):
            truss.add_member(start, end, "chord", kind=kind, groups=group)


def add_verticals(truss: ModelBuilder, chords: Chords) -> ModelBuilder:
    """Verticals from chord to chord."""
    for i in chords.top():
        truss.add_member(f"L{i}", f"U{i}", "vertical", kind=chords.kind, groups="verticals")
    return truss


def add_leaning(truss: ModelBuilder, chords: Chords, falling: bool) -> ModelBuilder:
    """Diagonals that fall, or rise, towards the middle; a panel in the middle has both."""
    for i in range(chords.first, chords.panels - chords.first):
        left = min(i, chords.panels - 1 - i)
        falls, rises = (f"U{left}", f"L{left + 1}"), (f"L{left}", f"U{left + 1}")
        chosen = falls if falling else rises
        if 2 * i + 1 == chords.panels:
            pairs = [falls, rises]
        else:
            start, end = chosen
            pairs = [chosen if i == left else (chords.mirrored(end), chords.mirrored(start))]
        for start, end in pairs:
            truss.add_member(start, end, "diagonal", kind=chords.kind, groups="diagonals")
    return truss
