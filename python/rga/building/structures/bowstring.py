"""The bowstring truss."""

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.structures.given import AnyMaterial, AnySection, Joints
from rga.building.structures.truss_chords import (
    add_leaning,
    add_verticals,
    chords_of,
    drawn_chords,
    parabola,
)


def bowstring_truss(
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
    """A bowstring truss in the plane xz: the top chord rises as z = 4 h x (span - x) / span^2.

    Nodes L0, L1 .. of the bottom chord stand at z = 0, U1, U2 .. of the top chord above L1, L2 ..;
    h is the rise of the parabola, which an odd number of panels has no node at. Diagonals fall
    towards the middle; under a load that is the same at all nodes of the bottom chord they are
    idle. Groups "bottom chord", "top chord", "diagonals", "verticals"; sections, supports and other
    arguments as of `howe_truss`.

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> truss = bowstring_truss("span", "32 m", "5 m", 8, chords="HEA 240", diagonals="CHS 76.1x5")
    >>> model = truss.build()
    >>> len(model.members), model.nodes["U4"], model.nodes["U1"]
    (29, (16.0, 0.0, 5.0), (4.0, 0.0, 2.1875))
    """
    line = chords_of(name, span, height, panels, parabola, joints=joints)
    truss = drawn_chords(name, line, chords, diagonals, verticals, material)
    return add_leaning(add_verticals(truss, line), line, falling=True)
