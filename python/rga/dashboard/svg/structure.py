"""The drawing of a structure as SVG: its members, supports and sensors, each with an id.

Sensors are dots of a size that stays the same however wide the drawing is shown; their colours are
those of the style sheet, so that a newer state changes a class and nothing else.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.label import label
from rga.drawing.labels import Room
from rga.drawing.projection import Projection, views
from rga.model.schema import Model
from rga.report.drawing.labels import marker_offset, marker_row
from rga.report.drawing.places import Named, Spot, spots

#: width of a drawing, and room on either side of it
WIDE, SIDE = 1000.0, 54.0
#: units of the drawing in an inch of a printed one, by which sensors are moved off their members
INCH = 100.0
#: by which sensors stand below a support [inches of a printed drawing]
FOOT = 0.14
#: height of a drawing over its width, at most and, where it has any, at least
HIGHEST, LOWEST = 0.55, 0.12
#: share of the width below which what is drawn has no height
FLAT = 1e-3
#: letters of a name that are shown, and their width
LONGEST, LETTER = 14, 7.2
#: distance of points along a member that names had best not cover [inches of a printed drawing]
SAMPLED = 0.12
#: names that are written into a drawing; pointing at a sensor tells the others
MOST_NAMED = 14
#: what stands for a kind of sensor
SHAPES = {"displacement": "round", "rotation": "round", "strain": "square", "force": "square"}


@dataclass(frozen=True)
class Bar:
    """A member: its number in the model, its name, its ends and whether something names it."""

    number: int
    name: str
    ends: tuple[float, float, float, float]
    marked: bool


@dataclass(frozen=True)
class Dot:
    """A sensor.

    Attributes:
        number: in the model, from 0.
        name: of it.
        x, y: in the drawing.
        shape: by its kind.
    """

    number: int
    name: str
    x: float
    y: float
    shape: str


@dataclass(frozen=True)
class Foot:
    """A support: its name, where it is, whether it rolls, and whether something names it."""

    name: str
    x: float
    y: float
    rolls: bool
    marked: bool


@dataclass(frozen=True)
class Name:
    """The name of a sensor beside it."""

    number: int
    x: float
    y: float
    words: str


@dataclass(frozen=True)
class Elevation:
    """A view of the structure.

    Attributes:
        title: in words.
        stretch: by which heights are drawn larger than lengths.
        box: of the drawing, as SVG states it.
        bars, feet, dots, names: what is drawn.
    """

    title: str
    stretch: float
    box: str
    bars: tuple[Bar, ...]
    feet: tuple[Foot, ...]
    dots: tuple[Dot, ...]
    names: tuple[Name, ...]


def elevations(model: Model, marked: Named, named_first: Mapping[str, float]) -> list[Elevation]:
    """Every view of a structure that its sensors need.

    Args:
        model: the structure.
        marked: parts that are to be seen.
        named_first: how much each sensor matters: the names of those that matter most are written.
    """
    taken: set[str] = set()
    found = []
    columns = {name: number for number, name in enumerate(model.sensors)}
    for view in views(model, set(marked.members)):
        here = [
            name
            for name, sensor in model.sensors.items()
            if name not in taken and view.holds(sensor)
        ]
        taken |= set(here)
        sensors = {columns[name]: name for name in here}
        found.append(_elevation(model, view, sensors, marked, named_first))
    return found


def outline(model: Model) -> Elevation:
    """The first view of a structure without its sensors, for a small drawing."""
    nothing = Named(frozenset(), frozenset())
    return _elevation(model, views(model, set())[0], {}, nothing, {})


class _Sheet:
    """From the coordinates of a view [m] to those of its drawing."""

    def __init__(self, model: Model, view: Projection) -> None:
        points = np.array([model.nodes[node] for node in sorted(view.nodes)])[:, list(view.axes)]
        low, high = points.min(axis=0), points.max(axis=0)
        span = float(max(high[0] - low[0], (high[1] - low[1]) / HIGHEST, 1e-9))
        self.scale = (WIDE - 2 * SIDE) / span
        height = float(high[1] - low[1]) / span
        #: by how much heights are drawn larger than lengths
        self.stretch = max(1.0, LOWEST / height) if height > FLAT else 1.0
        self._left = SIDE + (WIDE - 2 * SIDE - self.scale * float(high[0] - low[0])) / 2
        self._low, self._top = low, float(high[1])
        self.high = self.scale * self.stretch * float(high[1] - low[1])

    def at(self, x: float, y: float) -> tuple[float, float]:
        """A place of the view in the drawing, where y runs downwards."""
        across = self._left + self.scale * (x - float(self._low[0]))
        return round(across, 1), round(SIDE + self.scale * self.stretch * (self._top - y), 1)


def _elevation(
    model: Model,
    view: Projection,
    sensors: Mapping[int, str],
    marked: Named,
    named_first: Mapping[str, float],
) -> Elevation:
    sheet = _Sheet(model, view)
    right, up = view.axes

    def of_node(node: str) -> tuple[float, float]:
        return sheet.at(model.nodes[node][right], model.nodes[node][up])

    numbers = {name: number for number, name in enumerate(model.members)}
    bars = tuple(
        Bar(
            numbers[name],
            name,
            (*of_node(model.members[name].nodes[0]), *of_node(model.members[name].nodes[1])),
            name in marked.members,
        )
        for name in view.members
    )
    along = ("ux", "uy", "uz")[right]
    feet = tuple(
        Foot(name, *of_node(one.node), along not in one.fixed, one.node in marked.nodes)
        for name, one in model.supports.items()
        if one.node in view.nodes
    )
    here = spots(model, view, dict(sensors))
    held = frozenset(one.node for one in model.supports.values())
    dots = tuple(dot for spot in here for dot in _dots(model, sheet, spot, sensors, held))
    box = f"0 0 {WIDE:g} {sheet.high + 2 * SIDE:.0f}"
    names = _names(bars, dots, feet, named_first, sheet.high + 2 * SIDE)
    return Elevation(view.title, sheet.stretch, box, bars, feet, dots, names)


def _dots(
    model: Model, sheet: _Sheet, spot: Spot, sensors: Mapping[int, str], held: frozenset[str]
) -> list[Dot]:
    """The sensors of a place in a row; below the support, where the place is held."""
    on_foot = model.sensors[sensors[spot.sensors[0]]].node in held
    found = []
    below = 0.0 if spot.tier == 1 or not on_foot else FOOT
    across, down = sheet.at(spot.x, spot.y)
    down = round(down - (marker_offset(spot) - below) * INCH, 1)
    for place, number in enumerate(spot.sensors):
        x = round(across + (0.16 * place - 1.45 * marker_row(spot)) * INCH, 1)
        name = sensors[number]
        shape = SHAPES.get(model.sensors[name].kind, "round")
        found.append(Dot(number, name, x, down, shape))
    return found


def _names(
    bars: tuple[Bar, ...],
    dots: tuple[Dot, ...],
    feet: tuple[Foot, ...],
    named_first: Mapping[str, float],
    high: float,
) -> tuple[Name, ...]:
    """Names of the sensors that matter most, where there is room for them."""
    room = Room(lines=_samples(bars), limits=(0.0, -high / INCH, WIDE / INCH, 0.0))
    room.boxes += [_box(dot.x, dot.y, 8.0) for dot in dots]
    room.boxes += [_box(foot.x, foot.y + 9.0, 11.0) for foot in feet]
    # The room is measured in inches upwards.
    room.boxes = [(a / INCH, -d / INCH, c / INCH, -b / INCH) for a, b, c, d in room.boxes]
    first = sorted(dots, key=lambda dot: -named_first.get(dot.name, 0.0))[:MOST_NAMED]
    found = []
    for dot in first:
        words = label(dot.name, LONGEST)
        at = (dot.x / INCH, -dot.y / INCH)
        place = room.place(words, at, 0.14, LETTER / INCH)
        if place is not None:
            left, bottom, *_ = place.box
            found.append(Name(dot.number, round(left * INCH, 1), round(-bottom * INCH, 1), words))
    return tuple(found)


def _samples(bars: tuple[Bar, ...]) -> FloatArray:
    """Points along the members [inch upwards]."""
    if not bars:
        return np.zeros((0, 2))
    ends = np.array([one.ends for one in bars]) / INCH
    length = float(np.median(np.linalg.norm(ends[:, 2:] - ends[:, :2], axis=1)))
    share = np.linspace(0.0, 1.0, int(np.clip(length / SAMPLED, 2, 25)))[:, None, None]
    points = ends[:, :2] + share * (ends[:, 2:] - ends[:, :2])
    return np.asarray(points.reshape(-1, 2) * (1.0, -1.0))


def _box(x: float, y: float, half: float) -> tuple[float, float, float, float]:
    return x - half, y - half, x + half, y + half
