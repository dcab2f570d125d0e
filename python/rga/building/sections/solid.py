"""Solid bars."""

import math

from rga.building.quantities import Amount
from rga.building.sections.sizes import length
from rga.model.schema import Section

#: terms of the series of a rectangle's torsion: the next one is below 1e-9 of the whole
TERMS = 40


def rod(diameter: Amount) -> Section:
    """A round bar.

    A = pi d^2 / 4, I = pi d^4 / 64, J = 2 I. Fibres: top, bottom, left, right.

    Raises:
        InputError: the diameter is no length.

    >>> bar = rod("20 mm")
    >>> f"{bar.A * 1e6:.1f} mm2, {bar.Iy * 1e12:.0f} mm4"
    '314.2 mm2, 7854 mm4'
    """
    d = length(diameter, "diameter of a rod")
    inertia = math.pi * d**4 / 64
    return Section(
        A=math.pi * d**2 / 4, Iy=inertia, Iz=inertia, J=2 * inertia, fibres=on_the_axes(d, d)
    )


def rectangle(depth: Amount, width: Amount) -> Section:
    """A solid rectangle, its depth upright.

    A = b h, Iy = b h^3 / 12, Iz = h b^3 / 12; J by the series of Saint-Venant (Timoshenko and
    Goodier, Theory of Elasticity, section 109). Fibres: the corners.

    Raises:
        InputError: a dimension is no length.

    >>> beam = rectangle("300 mm", "100 mm")
    >>> f"{beam.Iy * 1e12:.4g} mm4, J {beam.J * 1e12:.4g} mm4"
    '2.25e+08 mm4, J 7.9e+07 mm4'
    """
    h, b = length(depth, "depth of a rectangle"), length(width, "width of a rectangle")
    long, short = max(h, b), min(h, b)
    series = sum(
        math.tanh(odd * math.pi * long / (2 * short)) / odd**5 for odd in range(1, 2 * TERMS, 2)
    )
    torsion = long * short**3 * (1 / 3 - 64 * short / (math.pi**5 * long) * series)
    return Section(
        A=b * h, Iy=b * h**3 / 12, Iz=h * b**3 / 12, J=torsion, fibres=at_the_corners(h, b)
    )


def on_the_axes(depth: float, width: float) -> dict[str, tuple[float, float]]:
    """The fibres of what is round."""
    return {
        "top": (0.0, depth / 2),
        "bottom": (0.0, -depth / 2),
        "left": (width / 2, 0.0),
        "right": (-width / 2, 0.0),
    }


def at_the_corners(depth: float, width: float, y: float = 0.0) -> dict[str, tuple[float, float]]:
    """The fibres of what has corners, of which y is the middle [m]; left is +y, seen along x."""
    return {
        f"{end} {side}": (y + across * width / 2, up * depth / 2)
        for end, up in (("top", 1), ("bottom", -1))
        for side, across in (("left", 1), ("right", -1))
    }
