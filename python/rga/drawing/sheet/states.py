"""The deformed shape and diagrams of forces on a view."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.scene import Scene
from rga.drawing.sheet.canvas import Canvas
from rga.drawing.states.deformed import Deformed
from rga.drawing.states.diagrams import Diagram
from rga.quantities import scale, short

#: the largest value of a diagram, and half of an axial force's, which stands on both sides [inch]
REACH, HALF = 0.42, 0.13
#: values that are written, the largest of them; places that are one [inch]
WRITTEN, SAME = 48, 0.05
#: share of the largest value below which one counts as none
NOTHING = 1e-9


@dataclass(frozen=True)
class _Written:
    """A value that is written: its size, its place [inch], its text, and which way it is off."""

    size: float
    top: FloatArray
    text: str
    away: FloatArray | None


def curved_points(scene: Scene, shape: Deformed) -> FloatArray:
    """Points along the members of a deformed structure, enlarged, float[members, stations, 3]."""
    first, last = scene.points[scene.ends[:, :1]], scene.points[scene.ends[:, 1:]]
    shares = np.linspace(0.0, 1.0, shape.curves.shape[1])[:, None]
    return np.asarray(first + shares * (last - first) + shape.scale * shape.curves)


def draw_deformed(canvas: Canvas, scene: Scene, shape: Deformed) -> None:
    """The deformed members."""
    curves = canvas.inches(curved_points(scene, shape))
    chords = np.stack([curves[:, :-1], curves[:, 1:]], axis=2)[canvas.view.members]
    canvas.avoid(chords.reshape(-1, 2, 2))
    frame = scene.frame
    for bends, width in ((0, 1.5), (1, 2.2)):
        chosen = [k for k in canvas.view.members if frame[k] == bends]
        canvas.lines(curves[chosen], canvas.palette.deformed, width, zorder=5)


def draw_diagram(canvas: Canvas, scene: Scene, diagram: Diagram) -> int:
    """Values across the members, and the largest of them written.

    Returns:
        How many of these found no room.
    """
    if diagram.largest == 0:
        return 0
    factor, _ = scale(diagram.unit, diagram.largest)
    both = diagram.quantity == "N"
    reach = (HALF if both else REACH) / diagram.largest
    bases = canvas.inches(scene.points)[scene.ends]
    written: list[_Written] = []
    areas: dict[str, list[FloatArray]] = {canvas.palette.positive: [], canvas.palette.negative: []}
    for member in canvas.view.members:
        values, stations = diagram.values[member], diagram.positions[member]
        first, last = bases[member]
        side = _across(last - first) if both else canvas.direction(diagram.sides[member])
        if np.linalg.norm(side) < 0.1 or np.abs(values).max() <= NOTHING * diagram.largest:
            continue
        for positions, part in _same_signs(stations, values):
            feet = first + positions[:, None] * (last - first)
            tops = feet + (reach * part)[:, None] * side
            colour = canvas.palette.positive if part.sum() > 0 else canvas.palette.negative
            base = (2 * feet - tops)[::-1] if both else feet[[-1, 0]]
            areas[colour].append(np.vstack([tops, base]))
        for k in diagram.told(member):
            foot = first + stations[k] * (last - first)
            value = float(values[k])
            top = foot if both else foot + reach * value * side
            away = None if both else np.sign(value) * side / np.linalg.norm(side)
            written.append(_Written(abs(value), top, short(value * factor), away))
    for colour, polygons in areas.items():
        canvas.areas(polygons, colour, colour, 0.6, zorder=4, alpha=0.45)
    missed = 0
    told = _once_each(sorted(written, key=lambda one: -one.size))
    tops = np.array([one.top for one in told])
    for one in told[:WRITTEN]:
        placed = canvas.room.place(one.text, one.top, over=both, rivals=tops, beyond=one.away)
        if placed is None:
            missed += 1
        else:
            paper = {"facecolor": canvas.palette.paper, "alpha": 0.75, "lw": 0, "pad": 0.4}
            canvas.text(one.text, placed.box[:2], canvas.palette.ink, va="bottom", bbox=paper)
    return missed


def _once_each(written: list[_Written]) -> list[_Written]:
    """Values without one that stands there already for another member."""
    found: list[_Written] = []
    for one in written:
        if not any(
            one.text == other.text and np.abs(one.top - other.top).max() < SAME for other in found
        ):
            found.append(one)
    return found


def _across(along: FloatArray) -> FloatArray:
    size = float(np.linalg.norm(along))
    return np.array([-along[1], along[0]]) / size if size > 0 else np.zeros(2)


def _same_signs(positions: FloatArray, values: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
    """Stretches in which values have one sign, cut where they pass zero."""
    turns = np.flatnonzero(values[:-1] * values[1:] < 0)
    share = values[turns] / (values[turns] - values[turns + 1])
    zeros = positions[turns] + share * (positions[turns + 1] - positions[turns])
    positions = np.insert(positions, turns + 1, zeros)
    values = np.insert(values, turns + 1, 0.0)
    cuts = turns + 1 + np.arange(len(turns))
    edges = [0, *cuts.tolist(), len(values) - 1]
    return [(positions[a : b + 1], values[a : b + 1]) for a, b in pairwise(edges)]
