"""One view of a structure on matplotlib's axes, at a scale that symbols can be drawn to."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from rga.arrays import FloatArray
from rga.drawing.labels import Point, Room
from rga.drawing.palette import Palette
from rga.drawing.views import View

#: points along lines that labels avoid [inch]
SAMPLE = 0.05
#: samples beyond which labels look at no more lines
MOST_SAMPLES = 20000
#: below a view: the scale and the global axes [inch]
FOOT = 0.42


@dataclass
class Canvas:
    """A view to draw on.

    Attributes:
        axes: matplotlib's, in the metres of the view.
        view: the view.
        unit: metres in an inch.
        palette: the colours.
        room: what labels must not cover.
    """

    axes: Axes
    view: View
    unit: float
    palette: Palette
    room: Room = field(default_factory=Room)

    def inches(self, points: FloatArray) -> FloatArray:
        """Points float[..., 3] on the paper in inches, float[..., 2]."""
        return self.view.flat(np.asarray(points, dtype=float)) / self.unit

    def direction(self, vector: FloatArray) -> FloatArray:
        """A direction on the paper, float[2], shorter than one where it is inclined to it."""
        size = float(np.linalg.norm(vector))
        return self.view.flat(np.asarray(vector)) / size if size > 0 else np.zeros(2)

    def lines(
        self, lines: Sequence[FloatArray] | FloatArray, colour: str, width: float, **look: Any
    ) -> None:
        """Lines through points in inches, float[k, 2] each."""
        if len(lines):
            scaled = [np.asarray(line) * self.unit for line in lines]
            self.axes.add_collection(
                LineCollection(
                    scaled,
                    colors=colour,
                    linewidths=width,
                    capstyle="round",
                    **look,
                ),
                autolim=False,
            )

    def areas(
        self, areas: Sequence[FloatArray], face: str, edge: str, width: float, **look: Any
    ) -> None:
        """Polygons through points in inches, float[k, 2] each."""
        if len(areas):
            scaled = [np.asarray(area) * self.unit for area in areas]
            self.axes.add_collection(
                PolyCollection(scaled, facecolors=face, edgecolors=edge, linewidths=width, **look),
                autolim=False,
            )

    def text(self, text: str, at: Point, colour: str, **look: Any) -> None:
        """Text at a point in inches."""
        given = {"fontsize": 6.6, "zorder": 9, "clip_on": False, **look}
        self.axes.text(at[0] * self.unit, at[1] * self.unit, text, color=colour, **given)

    def avoid(self, lines: FloatArray) -> None:
        """Let labels avoid lines between two points each, float[k, 2, 2] [inch]."""
        if not len(lines):
            return
        lengths = np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1)
        counts = np.ceil(lengths / SAMPLE).astype(int) + 1
        if counts.sum() + len(self.room.lines) > MOST_SAMPLES:
            return
        points = [
            line[0] + share[:, None] * (line[1] - line[0])
            for line, share in zip(lines, (np.linspace(0, 1, k) for k in counts), strict=True)
        ]
        self.room.lines = np.vstack([self.room.lines, *points])

    def keep_clear(self, at: FloatArray, half: float) -> None:
        """Let no label cover the square about a point [inch]."""
        self.room.boxes.append((at[0] - half, at[1] - half, at[0] + half, at[1] + half))


def canvas_in(
    axes: Axes, view: View, points: FloatArray, margin: float, palette: Palette
) -> Canvas:
    """Axes set to the largest scale at which a view and the symbols around it fit.

    Args:
        axes: matplotlib's; their size is that on the figure now.
        view: the view.
        points: what must be seen, float[k, 3] [m].
        margin: around it [inch].
        palette: the colours.
    """
    box = axes.get_window_extent().width, axes.get_window_extent().height
    dpi = axes.figure.dpi
    wide, high = (side / dpi for side in box)
    flat = view.flat(points)
    low, size = flat.min(axis=0), np.ptp(flat, axis=0)
    unit = metres_per_inch(size, wide, high, margin)
    middle = low + size / 2
    left = middle[0] - wide * unit / 2
    bottom = middle[1] - (high + FOOT) * unit / 2
    axes.set_axis_off()
    axes.set_xlim(left, left + wide * unit)
    axes.set_ylim(bottom, bottom + high * unit)
    axes.set_aspect("equal", adjustable="datalim")
    box_in = (left / unit, bottom / unit + FOOT * 0.8, left / unit + wide, bottom / unit + high)
    return Canvas(axes, view, unit, palette, Room(limits=box_in))


def metres_per_inch(size: FloatArray, wide: float, high: float, margin: float) -> float:
    """The scale at which a box [m] fits an area [inch] with a margin all around."""
    room = max(wide - 2 * margin, 0.3 * wide), max(high - FOOT - 2 * margin, 0.3 * high)
    return float(max(size[0] / room[0], size[1] / room[1], 1e-9))
