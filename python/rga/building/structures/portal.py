"""A portal frame."""

from itertools import pairwise

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount, amount
from rga.building.sections.sizes import length
from rga.building.structures.given import (
    AnyMaterial,
    AnySection,
    add_material,
    check_count,
    check_word,
)
from rga.errors import InputError

MOST_PIECES = 200


def portal_frame(
    name: str,
    span: Amount,
    eaves: Amount,
    rise: Amount = 0.0,
    *,
    columns: AnySection,
    rafters: AnySection,
    column_pieces: int = 2,
    rafter_pieces: int = 4,
    bases: str = "fixed",
    material: AnyMaterial = None,
) -> ModelBuilder:
    """A portal frame in the plane xz: two columns, and two rafters or a level beam.

    Columns are cut into pieces at the nodes W0, W1 .. and E0, E1 .. from the bases at z = 0 to the
    eaves, at x = 0 and at x = span; each rafter at R1, R2 .. from the west eaves on, so that the
    ridge is R of `rafter_pieces`. All joints are rigid. Groups "west column", "east column", "west
    rafter", "east rafter"; sections "column" and "rafter", whose strong axes resist bending in the
    plane. Supports "west" and "east".

    Args:
        span, eaves, rise: between the axes; the rise from the eaves to the ridge [m], 0 for a beam.
        column_pieces, rafter_pieces: of each column and each rafter.
        bases: "fixed" or "pinned".

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> frame = portal_frame("hall", "20 m", "6 m", "2 m", columns="HEA 300", rafters="IPE 400")
    >>> model = frame.build()
    >>> len(model.members), model.nodes["R4"], model.supports["west"].fixed
    (12, (10.0, 0.0, 8.0), ['ux', 'uz', 'ry'])
    """
    where = f"frame {name!r}"
    wide, high = length(span, f"span of {where}"), length(eaves, f"eaves of {where}")
    up = amount(rise, "m", f"rise of {where}")
    if up < 0:
        raise InputError(f"a rise of {up:g} m falls", where, "give 0 or a height")
    check_count(column_pieces, "pieces of a column", where, 1, MOST_PIECES)
    check_count(rafter_pieces, "pieces of a rafter", where, 1, MOST_PIECES)
    check_word(bases, ("fixed", "pinned"), "bases", where)
    frame = ModelBuilder(name, plane="xz")
    add_material(frame, material)
    frame.add_section("column", columns).add_section("rafter", rafters)
    for side, x in (("W", 0.0), ("E", wide)):
        for i in range(column_pieces + 1):
            frame.add_node(f"{side}{i}", x, z=high * i / column_pieces)
    for i in range(1, 2 * rafter_pieces):
        slope = 1 - abs(i - rafter_pieces) / rafter_pieces
        frame.add_node(f"R{i}", wide * i / (2 * rafter_pieces), z=high + up * slope)
    for side, group in (("W", "west column"), ("E", "east column")):
        for i in range(column_pieces):
            frame.add_member(f"{side}{i}", f"{side}{i + 1}", "column", kind="frame", groups=group)
    inner = [f"R{i}" for i in range(1, 2 * rafter_pieces)]
    line = [f"W{column_pieces}", *inner, f"E{column_pieces}"]
    for i, (start, end) in enumerate(pairwise(line)):
        group = "west rafter" if i < rafter_pieces else "east rafter"
        frame.add_member(start, end, "rafter", kind="frame", groups=group)
    return frame.support("W0", bases, name="west").support("E0", bases, name="east")
