"""A lattice mast."""

import math

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

MOST_BAYS = 200


def lattice_mast(
    name: str,
    height: Amount,
    bays: int,
    foot: Amount,
    *,
    legs: AnySection,
    braces: AnySection,
    number_of_legs: int = 4,
    top: Amount | None = None,
    material: AnyMaterial = None,
    joints: Joints = "pinned",
) -> ModelBuilder:
    """A mast of three or four legs that stands free, each face with one diagonal a bay.

    Nodes 0A, 0B, 0C (and 0D) at the feet, 1A .. a bay higher, and so on; A .. stand around the z
    axis, the first side along x. Groups "legs", "diagonals", "horizontals" and, of four legs,
    "plan bracing" across each level; sections "leg" and "brace". Supports "foot A" .. are pinned.

    Args:
        height: of the mast; bays of one height each [m].
        foot, top: sides of its triangle or square at the ends [m]; left out, the top is as wide.
        joints: "pinned", or "rigid" with members that bend, and feet that do not turn.

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> mast = lattice_mast(
    ...     "antenna", "30 m", 6, "2.4 m", top="1.2 m", number_of_legs=3, legs="CHS 114.3x6.3",
    ...     braces="CHS 48.3x4",
    ... )
    >>> model = mast.build()
    >>> len(model.members), model.groups["legs"][:2], [round(x, 3) for x in model.nodes["6C"]]
    (54, ['0A-1A', '0B-1B'], [0.0, 0.693, 30.0])
    """
    where = f"mast {name!r}"
    if number_of_legs not in (3, 4):
        raise InputError(f"{number_of_legs!r} legs make no mast", where, "give 3 or 4")
    check_count(bays, "bays", where, 1, MOST_BAYS)
    check_word(joints, ("pinned", "rigid"), "joints", where)
    high, low_side = length(height, f"height of {where}"), length(foot, f"foot of {where}")
    top_side = low_side if top is None else length(top, f"top of {where}")
    corners = "ABCD"[:number_of_legs]
    mast = ModelBuilder(name)
    add_material(mast, material)
    mast.add_section("leg", legs).add_section("brace", braces)
    for level in range(bays + 1):
        side = low_side + (top_side - low_side) * level / bays
        radius = side / (2 * math.sin(math.pi / number_of_legs))
        for turn, corner in enumerate(corners):
            # The first side, from A to B, lies along x at the smallest y.
            at = math.pi * (2 * turn - 1) / number_of_legs - math.pi / 2
            x, y = radius * math.cos(at), radius * math.sin(at)
            mast.add_node(f"{level}{corner}", round(x, 9), round(y, 9), high * level / bays)
    rigid = joints == "rigid"
    for level in range(1, bays + 1):
        around = [(corner, corners[(k + 1) % number_of_legs]) for k, corner in enumerate(corners)]
        bars = [("leg", "legs", f"{level - 1}{one}", f"{level}{one}") for one in corners]
        bars += [
            ("brace", "diagonals", f"{level - 1}{one}", f"{level}{next_}") for one, next_ in around
        ]
        bars += [
            ("brace", "horizontals", f"{level}{one}", f"{level}{next_}") for one, next_ in around
        ]
        if number_of_legs == 4:
            bars.append(("brace", "plan bracing", f"{level}A", f"{level}C"))
        for section, group, start, end in bars:
            mast.add_member(start, end, section, kind="frame" if rigid else "truss", groups=group)
    for corner in corners:
        mast.support(f"0{corner}", "fixed" if rigid else "pinned", name=f"foot {corner}")
    return mast
