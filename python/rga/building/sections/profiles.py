"""Open sections: I, channel and angle, welded or rolled."""

import math

from rga.building.quantities import Amount
from rga.building.sections.outline import Corner, enclosed
from rga.building.sections.sizes import check, length, radius
from rga.building.sections.solid import at_the_corners
from rga.errors import InputError
from rga.model.schema import Section


def i_section(
    depth: Amount,
    width: Amount,
    web: Amount,
    flange: Amount,
    root: Amount = 0.0,
    toe: Amount = 0.0,
    slope: float = 0.0,
) -> Section:
    """An I or H section, its web upright: Iy is that of the strong axis.

    A and I are those within the outline, fillets included. J of the web and flanges with their
    junctions by El Darwish and Johnston, Torsion of structural shapes, J. Struct. Div. ASCE 91
    (1965), as in EN 10365 and SCI P363; of tapered flanges it is that of parallel ones, up to 15 %
    too small. Fibres: the four corners.

    Args:
        depth, width, web, flange: h, b, tw and tf; of a tapered flange, tf at the middle of what
            stands out.
        root, toe: radii between web and flange, and at the tips of the flanges.
        slope: of the flanges' inner faces, as a tangent: 0 for parallel ones.

    Raises:
        InputError: a dimension is no length, or they do not go together.

    >>> beam = i_section("200 mm", "100 mm", "5.6 mm", "8.5 mm", root="12 mm")
    >>> f"{beam.A * 1e4:.1f} cm2, {beam.Iy * 1e8:.0f} cm4, {beam.Iz * 1e8:.0f} cm4"
    '28.5 cm2, 1943 cm4, 142 cm4'
    """
    what = "I section"
    h, b, tw, tf = _plates(depth, width, web, flange, what)
    root_, toe_ = radius(root, f"root radius of an {what}"), radius(toe, f"toe of an {what}")
    rise = _rise((b - tw) / 4, tf, slope, what)
    check(tw < b, f"a web of {tw:g} m is wider than the flange", what)
    check(2 * (tf + rise) < h, f"flanges of {tf:g} m fill {h:g} m", what)
    right: list[Corner] = [
        (b / 2, h / 2, 0.0),
        (b / 2, h / 2 - tf + rise, toe_),
        (tw / 2, h / 2 - tf - rise, root_),
    ]
    right += [(y, -z, r) for y, z, r in reversed(right)]
    whole = enclosed(right + [(-y, z, r) for y, z, r in reversed(right)])
    # The circle that the junction of web and flange encloses.
    circle = ((root_ + tw / 2) ** 2 + (root_ + tf) ** 2 - root_**2) / (2 * root_ + tf)
    junction = tw / tf * (0.145 + 0.1 * root_ / tf) * circle**4
    plates = 2 / 3 * (b - 0.63 * tf) * tf**3 + (h - 2 * tf) * tw**3 / 3
    return Section(
        A=whole.area,
        Iy=whole.about_y,
        Iz=whole.about_z,
        J=plates + 2 * junction,
        fibres=at_the_corners(h, b),
    )


def channel(
    depth: Amount,
    width: Amount,
    web: Amount,
    flange: Amount,
    root: Amount = 0.0,
    toe: Amount = 0.0,
    slope: float = 0.0,
    flange_at: Amount | None = None,
) -> Section:
    """A channel, its web upright and its flanges towards +y: Iy is that of the strong axis.

    A and I are those within the outline, about the centroid, from which the fibres (the four
    corners) count as well. J by El Darwish and Johnston (1965), as in SCI P363. That the shear
    centre lies off the centroid is not in the model: a load through the centroid does not twist.

    Args:
        depth, width, web, flange: h, b, tw and tf.
        root, toe: radii between web and flange, and at the tips of the flanges.
        slope: of the flanges' inner faces, as a tangent: 0 for parallel ones.
        flange_at: distance from the tip at which a tapered flange has tf; left out, the middle of
            what stands out of the web.

    Raises:
        InputError: a dimension is no length, or they do not go together.

    >>> one = channel("200 mm", "80 mm", "6 mm", "11 mm", root="13 mm")
    >>> f"{one.A * 1e4:.1f} cm2, {one.Iy * 1e8:.0f} cm4, {one.Iz * 1e8:.0f} cm4"
    '29.0 cm2, 1909 cm4, 187 cm4'
    """
    what = "channel"
    h, b, tw, tf = _plates(depth, width, web, flange, what)
    root_, toe_ = radius(root, f"root radius of a {what}"), radius(toe, f"toe of a {what}")
    check(tw < b, f"a web of {tw:g} m is wider than the flange", what)
    out = b - tw
    to_tip = out / 2 if flange_at is None else length(flange_at, f"flange_at of a {what}")
    at_tip = tf - _rise(to_tip, tf, slope, what)
    at_web = at_tip + slope * out
    check(2 * at_web < h, f"flanges of {tf:g} m fill {h:g} m", what)
    upper: list[Corner] = [
        (0.0, h / 2, 0.0),
        (b, h / 2, 0.0),
        (b, h / 2 - at_tip, toe_),
        (tw, h / 2 - at_web, root_),
    ]
    whole = enclosed(upper + [(y, -z, r) for y, z, r in reversed(upper)])
    circle = 2 * (3 * root_ + tw + tf - math.sqrt(2 * (2 * root_ + tw) * (2 * root_ + tf)))
    share = (
        -0.0908
        + 0.2621 * tw / tf
        + 0.1231 * root_ / tf
        - 0.0752 * tw * root_ / tf**2
        - 0.0945 * (tw / tf) ** 2
    )
    plates = 2 / 3 * b * tf**3 + (h - 2 * tf) * tw**3 / 3
    return Section(
        A=whole.area,
        Iy=whole.about_y,
        Iz=whole.about_z,
        J=plates + 2 * share * circle**4 - 0.42 * tf**4,
        fibres=at_the_corners(h, b, b / 2 - whole.y),
    )


def angle(
    height: Amount, width: Amount, thickness: Amount, root: Amount = 0.0, toe: Amount = 0.0
) -> Section:
    """An angle about its principal axes, since a member has no product of inertia.

    Iy is that of the strong axis u, Iz that of the weak axis v. For a frame member whose legs are
    to lie level and upright, give it the direction of u as `local_y`: with the heel below and the
    legs along z (height) and +y (width), u leans by atan(2 Iyz / (Iz - Iy)) / 2 from y, which is
    [0, 1, 1] for equal legs on a member along x. A truss member needs none of this. J by El
    Darwish and Johnston (1965), as in SCI P363. Fibres: the heel and the ends of the legs.

    Raises:
        InputError: a dimension is no length, or they do not go together.

    >>> one = angle("100 mm", "100 mm", "10 mm", root="12 mm", toe="6 mm")
    >>> f"{one.A * 1e4:.1f} cm2, {one.Iy * 1e8:.0f} cm4, {one.Iz * 1e8:.1f} cm4"
    '19.2 cm2, 280 cm4, 73.0 cm4'
    """
    what = "angle"
    h, b = length(height, f"height of an {what}"), length(width, f"width of an {what}")
    t = length(thickness, f"thickness of an {what}")
    root_, toe_ = radius(root, f"root radius of an {what}"), radius(toe, f"toe of an {what}")
    check(t < min(h, b), f"{t:g} m is thicker than a leg is long", what)
    corners: list[Corner] = [
        (0.0, 0.0, 0.0),
        (b, 0.0, 0.0),
        (b, t, toe_),
        (t, t, root_),
        (t, h, toe_),
        (0.0, h, 0.0),
    ]
    whole = enclosed(corners)
    middle = (whole.about_y + whole.about_z) / 2
    half = math.hypot((whole.about_y - whole.about_z) / 2, whole.product)
    lean = math.atan2(-2 * whole.product, whole.about_y - whole.about_z) / 2
    ends = {
        "heel": (0.0, 0.0),
        "end of the width, outside": (b, 0.0),
        "end of the width, inside": (b, t),
        "end of the height, inside": (t, h),
        "end of the height, outside": (0.0, h),
    }
    circle = 2 * (3 * root_ + 2 * t - math.sqrt(2) * (2 * root_ + t))
    share = 0.0768 + 0.0479 * root_ / t
    return Section(
        A=whole.area,
        Iy=middle + half,
        Iz=middle - half,
        J=(b * t**3 + (h - t) * t**3) / 3 + share * circle**4 - 0.21 * t**4,
        fibres={
            name: (
                (y - whole.y) * math.cos(lean) + (z - whole.z) * math.sin(lean),
                (z - whole.z) * math.cos(lean) - (y - whole.y) * math.sin(lean),
            )
            for name, (y, z) in ends.items()
        },
    )


def _plates(
    depth: Amount, width: Amount, web: Amount, flange: Amount, what: str
) -> tuple[float, float, float, float]:
    return (
        length(depth, f"depth of an {what}" if what[0] == "I" else f"depth of a {what}"),
        length(width, f"width of the {what}"),
        length(web, f"web of the {what}"),
        length(flange, f"flange of the {what}"),
    )


def _rise(reach: float, flange: float, slope: float, what: str) -> float:
    """By how much a tapered flange is thinner at its tip than where it is measured [m]."""
    if not (math.isfinite(slope) and 0 <= slope < 1):
        raise InputError(f"a slope of {slope!r} is none", what, "give a tangent, such as 0.08")
    check(slope * reach < flange, "the flange tapers to nothing", what)
    return slope * reach
