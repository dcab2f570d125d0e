"""A frame of several storeys."""

from itertools import pairwise

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.sections.sizes import length
from rga.building.structures.given import (
    AnyMaterial,
    AnySection,
    add_material,
    check_count,
    check_word,
)

MOST_BAYS, MOST_STOREYS = 25, 200
AXES = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def storey_frame(
    name: str,
    bays: int,
    bay: Amount,
    storeys: int,
    storey: Amount,
    *,
    columns: AnySection,
    beams: AnySection,
    bases: str = "fixed",
    material: AnyMaterial = None,
) -> ModelBuilder:
    """A frame of columns and beams in the plane xz, all joints rigid.

    Node B2 stands on axis B (x = one bay) at the second floor (z = two storeys); A0, B0 .. are the
    bases. Groups "columns" and "beams", with "storey 1" .. for the columns of each storey and
    "floor 1" .. for the beams on top of it; sections "column" and "beam", whose strong axes resist
    bending in the plane. Supports "A", "B" ..

    Args:
        bays, bay: their number and width [m].
        storeys, storey: their number and height [m].
        bases: "fixed" or "pinned".

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> frame = storey_frame("office", 3, "6 m", 4, "3.5 m", columns="HEB 240", beams="IPE 330")
    >>> model = frame.build()
    >>> len(model.groups["columns"]), model.groups["floor 4"], model.nodes["D4"]
    (16, ['A4-B4', 'B4-C4', 'C4-D4'], (18.0, 0.0, 14.0))
    """
    where = f"frame {name!r}"
    check_count(bays, "bays", where, 1, MOST_BAYS)
    check_count(storeys, "storeys", where, 1, MOST_STOREYS)
    check_word(bases, ("fixed", "pinned"), "bases", where)
    wide, high = length(bay, f"bay of {where}"), length(storey, f"storey of {where}")
    axes = AXES[: bays + 1]
    frame = ModelBuilder(name, plane="xz")
    add_material(frame, material)
    frame.add_section("column", columns).add_section("beam", beams)
    for i, axis in enumerate(axes):
        for floor in range(storeys + 1):
            frame.add_node(f"{axis}{floor}", wide * i, z=high * floor)
    for floor in range(1, storeys + 1):
        for axis in axes:
            groups = ["columns", f"storey {floor}"]
            start, end = f"{axis}{floor - 1}", f"{axis}{floor}"
            frame.add_member(start, end, "column", kind="frame", groups=groups)
        for one, other in pairwise(axes):
            groups = ["beams", f"floor {floor}"]
            start, end = f"{one}{floor}", f"{other}{floor}"
            frame.add_member(start, end, "beam", kind="frame", groups=groups)
    for axis in axes:
        frame.support(f"{axis}0", bases, name=axis)
    return frame
