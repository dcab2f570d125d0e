"""Trusses whose diagonals lean one way on either side of the middle: Howe and Pratt."""

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.structures.given import AnyMaterial, AnySection, Joints, check_word
from rga.building.structures.truss_chords import (
    Ends,
    Shape,
    add_leaning,
    add_verticals,
    chords_of,
    drawn_chords,
    gable,
    level,
)


def leaning_truss(
    name: str,
    span: Amount,
    height: Amount,
    panels: int,
    chords: AnySection,
    diagonals: AnySection,
    verticals: AnySection | None,
    material: AnyMaterial,
    shape: Shape,
    ends: Ends,
    joints: Joints,
    *,
    pushed: bool,
) -> ModelBuilder:
    """A Howe truss, whose diagonals gravity pushes, or a Pratt truss, whose it pulls.

    Args:
        pushed: whether gravity pushes the diagonals; the others are as for `howe_truss`.
    """
    check_word(shape, ("parallel", "gable"), "shape", f"truss {name!r}")
    roof = shape == "gable"
    line = chords_of(name, span, height, panels, gable if roof else level, ends, joints, even=roof)
    if roof:
        check_word(ends, ("inclined",), "ends of a gable", f"truss {name!r}")
    truss = drawn_chords(name, line, chords, diagonals, verticals, material)
    return add_leaning(add_verticals(truss, line), line, falling=roof == pushed)
