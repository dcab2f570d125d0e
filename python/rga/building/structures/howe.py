"""The Howe truss."""

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.structures.given import AnyMaterial, AnySection, Joints
from rga.building.structures.leaning import leaning_truss
from rga.building.structures.truss_chords import Ends, Shape


def howe_truss(
    name: str,
    span: Amount,
    height: Amount,
    panels: int,
    *,
    chords: AnySection,
    diagonals: AnySection,
    verticals: AnySection | None = None,
    material: AnyMaterial = None,
    shape: Shape = "parallel",
    ends: Ends = "inclined",
    joints: Joints = "pinned",
) -> ModelBuilder:
    """A Howe truss in the plane xz: under gravity diagonals push and verticals pull.

    Nodes L0, L1 .. of the bottom chord stand at z = 0 from x = 0 to the span, U0 (or U1), U1 .. of
    the top chord above them. Diagonals of a parallel truss rise towards the middle, those of a
    gable fall towards it. With an odd number of panels the one in the middle has both diagonals,
    so that the truss is symmetric, and once indeterminate: 7 panels make 26 members.

    Groups: "bottom chord", "top chord", "end posts" (L0-U1 and its mirror image in a parallel truss
    with inclined ends), "diagonals", "verticals". Sections: "chord" (end posts too), "diagonal",
    "vertical". Supports: "left", pinned, and "right", a roller along x.

    Args:
        span, height: of the axes; of a gable the height of the ridge [m].
        chords, diagonals, verticals: sections, or names of rolled ones; left out, verticals are as
            diagonals.
        material: or a grade of steel such as "S355"; left out, steel.
        shape: "parallel", or "gable" with an even number of panels.
        ends: "inclined" end posts, or "vertical" ones with U0 above L0 (of a parallel truss).
        joints: "pinned", or "rigid" with members that bend.

    Raises:
        InputError: a size that is none, an unknown word or section.

    >>> truss = howe_truss("roof", "20 m", "2.4 m", 7, chords="SHS 120x6.3", diagonals="SHS 80x5")
    >>> model = truss.build()
    >>> len(model.members), len(model.nodes), model.members["L1-U2"].groups
    (26, 14, ['diagonals'])
    """
    return leaning_truss(
        name, span, height, panels, chords, diagonals, verticals, material, shape, ends, joints,
        pushed=True,
    )  # fmt: skip
