"""The K truss."""

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.structures.given import AnyMaterial, AnySection, Joints
from rga.building.structures.truss_chords import chords_of, drawn_chords, level


def k_truss(
    name: str,
    span: Amount,
    height: Amount,
    panels: int,
    *,
    chords: AnySection,
    diagonals: AnySection,
    verticals: AnySection | None = None,
    material: AnyMaterial = None,
    joints: Joints = "pinned",
) -> ModelBuilder:
    """A K truss in the plane xz: from the middle of each vertical two diagonals lead inward.

    Nodes L0, L1 .. of the bottom chord, U1, U2 .. of the top chord above L1, L2 .., and M1, M2 ..
    in the middles of all verticals but the central one. An even number of panels, of four and more.
    Groups "bottom chord", "top chord", "end posts", "diagonals", "verticals" (halves of them);
    sections, supports and other arguments as of `howe_truss`.

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> truss = k_truss("span", "64 m", "12 m", 8, chords="HEB 300", diagonals="HEA 200")
    >>> model = truss.build()
    >>> len(model.members), len(model.nodes), model.nodes["M1"]
    (41, 22, (8.0, 0.0, 6.0))
    """
    line = chords_of(name, span, height, panels, level, joints=joints, fewest=4, even=True)
    truss = drawn_chords(name, line, chords, diagonals, verticals, material)
    middle = panels // 2
    for i in range(1, panels):
        if i == middle:
            truss.add_member(f"L{i}", f"U{i}", "vertical", kind=line.kind, groups="verticals")
            continue
        inward = i + 1 if i < middle else i - 1
        truss.add_node(f"M{i}", line.span * i / panels, z=line.height / 2)
        for start, end in ((f"L{i}", f"M{i}"), (f"M{i}", f"U{i}")):
            truss.add_member(start, end, "vertical", kind=line.kind, groups="verticals")
        for end in (f"L{inward}", f"U{inward}"):
            truss.add_member(f"M{i}", end, "diagonal", kind=line.kind, groups="diagonals")
    return truss
