"""A roof of two layers of bars."""

from itertools import product

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
from rga.errors import InputError

MOST_CELLS = 100


def space_truss_roof(
    name: str,
    cells: tuple[int, int],
    cell: Amount,
    depth: Amount,
    *,
    chords: AnySection,
    webs: AnySection,
    material: AnyMaterial = None,
    supported: str = "corners",
) -> ModelBuilder:
    """A double-layer grid, square on square, offset: pyramids of four webs under each cell.

    Nodes T0,0 .. of the top layer stand at z = depth, T1,0 one cell along x and T0,1 one along y;
    B0,0 .. of the bottom layer stand under the middles of the cells at z = 0. Groups "top chord",
    "bottom chord", "webs"; sections "chord" and "web". Supports, of the top layer: "SW" (the
    origin) is pinned, "SE" a roller along x, "NW" one along y, "NE" and those between move along
    both, so that warmth strains nothing.

    Args:
        cells: numbers of cells along x and y.
        cell: their side; depth: between the layers [m].
        supported: at the "corners", or along all "edges".

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> roof = space_truss_roof(
    ...     "hall", (4, 4), "3 m", "2 m", chords="CHS 101.6x5", webs="CHS 76.1x4"
    ... )
    >>> model = roof.build()
    >>> len(model.nodes), len(model.members), list(model.supports)
    (41, 128, ['SW', 'SE', 'NW', 'NE'])
    """
    where = f"roof {name!r}"
    if not isinstance(cells, tuple | list) or len(cells) != 2:
        raise InputError(f"{cells!r} are no cells", where, "give two numbers: along x, along y")
    for number in cells:
        check_count(number, "cells", where, 2, MOST_CELLS)
    check_word(supported, ("corners", "edges"), "supported", where)
    side, deep = length(cell, f"cell of {where}"), length(depth, f"depth of {where}")
    along, across = cells
    roof = ModelBuilder(name)
    add_material(roof, material)
    roof.add_section("chord", chords).add_section("web", webs)
    for i, j in product(range(along + 1), range(across + 1)):
        roof.add_node(f"T{i},{j}", side * i, side * j, deep)
    for i, j in product(range(along), range(across)):
        roof.add_node(f"B{i},{j}", side * (i + 0.5), side * (j + 0.5), 0.0)
    for layer, group, wide, broad in (
        ("T", "top chord", along + 1, across + 1),
        ("B", "bottom chord", along, across),
    ):
        for i, j in product(range(wide), range(broad)):
            for k, m in ((i + 1, j), (i, j + 1)):
                if k < wide and m < broad:
                    roof.add_member(f"{layer}{i},{j}", f"{layer}{k},{m}", "chord", groups=group)
    for i, j in product(range(along), range(across)):
        for k, m in product((i, i + 1), (j, j + 1)):
            roof.add_member(f"B{i},{j}", f"T{k},{m}", "web", groups="webs")
    roof.support("T0,0", "pinned", name="SW")
    roof.support(f"T{along},0", "roller along x", name="SE")
    roof.support(f"T0,{across}", "roller along y", name="NW")
    roof.support(f"T{along},{across}", "roller along x and y", name="NE")
    if supported == "edges":
        for i, j in product(range(along + 1), range(across + 1)):
            if (i in (0, along)) != (j in (0, across)):
                roof.support(f"T{i},{j}", "roller along x and y")
    return roof
