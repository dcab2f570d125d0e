"""Hollow sections."""

import math

from rga.building.quantities import Amount
from rga.building.sections.outline import Corner, Enclosed, enclosed
from rga.building.sections.sizes import check, length, radius
from rga.building.sections.solid import at_the_corners, on_the_axes
from rga.model.schema import Section


def circular_hollow(diameter: Amount, wall: Amount) -> Section:
    """A round tube, of an outer diameter D and a wall T.

    With d = D - 2 T: A = pi (D^2 - d^2) / 4, I = pi (D^4 - d^4) / 64, J = 2 I (EN 10210-2, annex
    B). Fibres: top, bottom, left, right; bending about both axes at once stresses a point between
    them most.

    Raises:
        InputError: a dimension is no length, or the wall is thicker than half of the diameter.

    >>> tube = circular_hollow("114.3 mm", "5 mm")
    >>> f"{tube.A * 1e4:.1f} cm2, {tube.Iy * 1e8:.0f} cm4"
    '17.2 cm2, 257 cm4'
    """
    outer = length(diameter, "diameter of a circular hollow section")
    wall_ = length(wall, "wall of a circular hollow section")
    inner = outer - 2 * wall_
    check(inner > 0, f"a wall of {wall_:g} m fills {outer:g} m", "circular hollow section")
    inertia = math.pi * (outer**4 - inner**4) / 64
    return Section(
        A=math.pi * (outer**2 - inner**2) / 4,
        Iy=inertia,
        Iz=inertia,
        J=2 * inertia,
        fibres=on_the_axes(outer, outer),
    )


def rectangular_hollow(
    depth: Amount,
    width: Amount,
    wall: Amount,
    outer_radius: Amount | None = None,
    inner_radius: Amount | None = None,
) -> Section:
    """A rectangular or square tube, its depth upright.

    A and I are those between two rounded outlines. J = T^3 h / 3 + 2 K A_h, by EN 10210-2, annex B,
    with h the length of the wall's middle line, A_h what it encloses, and K = 2 A_h T / h. Fibres:
    the corners, as if they were sharp.

    Args:
        depth, width, wall: outer dimensions H and B, and T.
        outer_radius, inner_radius: of the corners; left out, 1.5 T and 1.0 T, as EN 10210-2 has
            them for hot-finished sections. For cold-formed ones EN 10219-2 has 2.0 T and 1.0 T up
            to 6 mm, 2.5 T and 1.5 T up to 10 mm, 3.0 T and 2.0 T beyond.

    Raises:
        InputError: a dimension is no length, or they do not go together.

    >>> tube = rectangular_hollow("100 mm", "100 mm", "5 mm")
    >>> f"{tube.A * 1e4:.1f} cm2, {tube.Iy * 1e8:.0f} cm4, J {tube.J * 1e8:.0f} cm4"
    '18.7 cm2, 279 cm4, J 439 cm4'
    """
    what = "rectangular hollow section"
    h, b = length(depth, f"depth of a {what}"), length(width, f"width of a {what}")
    t = length(wall, f"wall of a {what}")
    outer = 1.5 * t if outer_radius is None else radius(outer_radius, f"outer radius of a {what}")
    inner = 1.0 * t if inner_radius is None else radius(inner_radius, f"inner radius of a {what}")
    check(min(h, b) > 2 * t, f"a wall of {t:g} m fills {h:g} x {b:g} m", what)
    whole, hole = _rounded(h, b, outer), _rounded(h - 2 * t, b - 2 * t, inner)
    middle = (outer + inner) / 2
    line = 2 * (h + b - 2 * t) - 2 * middle * (4 - math.pi)
    within = (h - t) * (b - t) - middle**2 * (4 - math.pi)
    return Section(
        A=whole.area - hole.area,
        Iy=whole.about_y - hole.about_y,
        Iz=whole.about_z - hole.about_z,
        J=t**3 * line / 3 + 4 * within**2 * t / line,
        fibres=at_the_corners(h, b),
    )


def _rounded(depth: float, width: float, corner: float) -> Enclosed:
    sides: list[Corner] = [
        (across * width / 2, up * depth / 2, corner)
        for across, up in ((1, 1), (1, -1), (-1, -1), (-1, 1))
    ]
    return enclosed(sides)
