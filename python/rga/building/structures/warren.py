"""The Warren truss."""

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.structures.given import AnyMaterial, AnySection, Joints
from rga.building.structures.truss_chords import (
    Chords,
    add_verticals,
    chords_of,
    drawn_chords,
    level,
)


def warren_truss(
    name: str,
    span: Amount,
    height: Amount,
    panels: int,
    *,
    chords: AnySection,
    diagonals: AnySection,
    verticals: AnySection | None = None,
    with_verticals: bool = False,
    material: AnyMaterial = None,
    joints: Joints = "pinned",
) -> ModelBuilder:
    """A Warren truss in the plane xz: diagonals that rise and fall in turn.

    Nodes L0, L1 .. of the bottom chord stand at z = 0 from x = 0 to the span. Without verticals U1,
    U2 .. stand above the middles of the panels, and each panel has two diagonals; with verticals
    they stand above L1, L2 .., of an even number of panels, each with one diagonal. Groups "bottom
    chord", "top chord", "diagonals", "verticals", and with verticals "end posts"; sections,
    supports and other arguments as of `howe_truss`.

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> truss = warren_truss("span", "30 m", "4 m", 6, chords="HEA 200", diagonals="HEA 140")
    >>> model = truss.build()
    >>> len(model.members), len(model.nodes), model.nodes["U1"]
    (23, 13, (2.5, 0.0, 4.0))
    """
    line = chords_of(name, span, height, panels, level, joints=joints, even=with_verticals)
    if with_verticals:
        truss = drawn_chords(name, line, chords, diagonals, verticals, material)
        return _with_one_diagonal(add_verticals(truss, line), line)
    truss = drawn_chords(name, line, chords, diagonals, None, material, with_top=False)
    for i in range(1, panels + 1):
        truss.add_node(f"U{i}", line.span * (i - 0.5) / panels, z=line.height)
    for i in range(1, panels):
        truss.add_member(f"U{i}", f"U{i + 1}", "chord", kind=line.kind, groups="top chord")
    for i in range(1, panels + 1):
        for start, end in ((f"L{i - 1}", f"U{i}"), (f"U{i}", f"L{i}")):
            truss.add_member(start, end, "diagonal", kind=line.kind, groups="diagonals")
    return truss


def _with_one_diagonal(truss: ModelBuilder, line: Chords) -> ModelBuilder:
    for i in range(1, line.panels - 1):
        start, end = (f"U{i}", f"L{i + 1}") if i % 2 else (f"L{i}", f"U{i + 1}")
        truss.add_member(start, end, "diagonal", kind=line.kind, groups="diagonals")
    return truss
