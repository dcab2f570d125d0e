"""The Pratt truss."""

from rga.building.builder import ModelBuilder
from rga.building.quantities import Amount
from rga.building.structures.given import AnyMaterial, AnySection, Joints
from rga.building.structures.leaning import leaning_truss
from rga.building.structures.truss_chords import Ends, Shape


def pratt_truss(
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
    """A Pratt truss in the plane xz: under gravity diagonals pull and inner verticals push.

    As `howe_truss`, with its names, groups, sections, supports and arguments, and diagonals that
    lean the other way: those of a parallel truss fall towards the middle, those of a gable rise.

    >>> truss = pratt_truss("span", "24 m", "3 m", 8, chords="HEA 200", diagonals="HEA 120")
    >>> model = truss.build()
    >>> len(model.members), "U1-L2" in model.members, model.supports["right"].fixed
    (29, True, ['uz'])
    """
    return leaning_truss(
        name, span, height, panels, chords, diagonals, verticals, material, shape, ends, joints,
        pushed=False,
    )  # fmt: skip
