"""Section properties of shapes by their dimensions."""

from collections.abc import Callable
from math import pi

#: A [m2], Iy and Iz [m4] about the horizontal and the vertical axis, J [m4]
Properties = dict[str, float]


def rectangles(parts: list[tuple[float, float, float, float]], torsion: float) -> Properties:
    """Properties of rectangles put together.

    Args:
        parts: width, height, and place of the centre (y, z) of each; a hole has a negative width
            [m].
        torsion: torsion constant [m4].

    >>> found = rectangles([(0.2, 0.4, 0, 0)], 1.0)
    >>> round(found["Iy"] / (0.2 * 0.4**3 / 12), 12)
    1.0
    """
    areas = [width * height for width, height, _, _ in parts]
    area = sum(areas)
    if any(height <= 0 for _, height, _, _ in parts):
        raise ValueError("the parts of the section overlap")
    y0 = sum(a * y for a, (_, _, y, _) in zip(areas, parts, strict=True)) / area
    z0 = sum(a * z for a, (_, _, _, z) in zip(areas, parts, strict=True)) / area
    about_y = sum(
        a * (h**2 / 12 + (z - z0) ** 2) for a, (_, h, _, z) in zip(areas, parts, strict=True)
    )
    about_z = sum(
        a * (w**2 / 12 + (y - y0) ** 2) for a, (w, _, y, _) in zip(areas, parts, strict=True)
    )
    return {"A": area, "Iy": about_y, "Iz": about_z, "J": torsion}


def solid_torsion(one: float, other: float) -> float:
    """Torsion constant of a solid rectangle [m4]: Young and Budynas, Roark's Formulas for Stress
    and Strain, 8th edition, table 10.7, case 4.

    >>> round(solid_torsion(2.0, 2.0), 3)
    2.253
    """
    a, b = max(one, other) / 2, min(one, other) / 2
    return a * b**3 * (16 / 3 - 3.36 * b / a * (1 - b**4 / (12 * a**4)))


def thin_torsion(*strips: tuple[float, float]) -> float:
    """Torsion constant of an open section of strips of a length and a thickness [m4]."""
    return sum(length * thickness**3 for length, thickness in strips) / 3


def rectangle(height: float, width: float) -> Properties:
    """A solid rectangle."""
    return rectangles([(width, height, 0, 0)], solid_torsion(height, width))


def circle(diameter: float) -> Properties:
    """A solid circle."""
    second = pi * diameter**4 / 64
    return {"A": pi * diameter**2 / 4, "Iy": second, "Iz": second, "J": 2 * second}


def pipe(diameter: float, wall: float) -> Properties:
    """A round tube."""
    outer, inner = circle(diameter), circle(diameter - 2 * wall)
    return {name: outer[name] - inner[name] for name in outer}


def tube(height: float, width: float, wall: float, *_: float) -> Properties:
    """A rectangular tube with sharp corners; torsion by Bredt."""
    inside = (height - wall) * (width - wall)
    torsion = 2 * inside**2 * wall / (height + width - 2 * wall)
    hole = (-(width - 2 * wall), height - 2 * wall, 0.0, 0.0)
    return rectangles([(width, height, 0, 0), hole], torsion)


def i_section(
    height: float, top: float, bottom: float, bottom_wall: float, top_wall: float, web: float
) -> Properties:
    """An I of three plates: height, widths and thicknesses of its flanges, and its web."""
    clear = height - top_wall - bottom_wall
    parts = [
        (top, top_wall, 0.0, (height - top_wall) / 2),
        (bottom, bottom_wall, 0.0, -(height - bottom_wall) / 2),
        (web, clear, 0.0, (bottom_wall - top_wall) / 2),
    ]
    strips = thin_torsion((top, top_wall), (bottom, bottom_wall), (clear, web))
    return rectangles(parts, strips)


def i_rolled(height: float, width: float, flange: float, web: float, *_: float) -> Properties:
    """A rolled I without its fillets."""
    return i_section(height, width, width, flange, flange, web)


def t_section(height: float, width: float, flange: float, web: float, *_: float) -> Properties:
    """A T: its flange on top of its web."""
    clear = height - flange
    parts = [(width, flange, 0.0, (height - flange) / 2), (web, clear, 0.0, -flange / 2)]
    return rectangles(parts, thin_torsion((width, flange), (clear, web)))


def channel(height: float, width: float, flange: float, web: float, *_: float) -> Properties:
    """A channel without its fillets, whose web is upright."""
    arm = width - web
    parts = [
        (web, height, web / 2, 0.0),
        (arm, flange, web + arm / 2, (height - flange) / 2),
        (arm, flange, web + arm / 2, -(height - flange) / 2),
    ]
    return rectangles(parts, thin_torsion((height - flange, web), (width, flange), (width, flange)))


#: shapes by name, how many dimensions they have at least, and whether roundings are left out
SHAPES: dict[str, tuple[Callable[..., Properties], int, bool]] = {
    "rectangle": (rectangle, 2, False),
    "circle": (circle, 1, False),
    "pipe": (pipe, 2, False),
    "tube": (tube, 3, True),
    "i section": (i_section, 6, False),
    "i rolled": (i_rolled, 4, True),
    "t section": (t_section, 4, False),
    "t tee": (t_section, 4, True),
    "channel": (channel, 4, True),
}


def by_shape(shape: str, dimensions: list[float]) -> tuple[Properties | None, bool]:
    """Properties of a shape, and whether roundings are left out; None where it is not known.

    Args:
        shape: its name as SAF has it.
        dimensions: its parameters [m].
    """
    function, least, rounded = SHAPES.get(shape.lower(), (None, 0, False))
    if function is None or len(dimensions) < least or min(dimensions[:least]) <= 0:
        return None, False
    try:
        found = function(*dimensions)
    except (ValueError, ZeroDivisionError, TypeError):
        return None, False
    return (found, rounded) if all(value > 0 for value in found.values()) else (None, False)


#: areas of shapes whose axes are no principal ones, or that are of several pieces
AREAS: dict[str, Callable[..., float]] = {
    "l section": lambda height, width, flange, web: width * flange + (height - flange) * web,
    "angle": lambda height, width, wall, *_: wall * (height + width - wall),
    "double rectangle": lambda width, height, _: 2 * width * height,
    "triple rectangle": lambda width, height, _: 3 * width * height,
}


def area_of(shape: str, dimensions: list[float]) -> Properties | None:
    """The area alone of a shape [m2], for members of axial force; None where it is not known.

    >>> area_of("Angle", [0.1, 0.1, 0.01])
    {'A': 0.0019}
    """
    function = AREAS.get(shape.lower())
    try:
        area = function(*dimensions) if function is not None else 0.0
    except TypeError:
        return None
    return {"A": round(area, 15)} if area > 0 else None
