"""Labels that cover neither each other nor what is drawn."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from unicodedata import east_asian_width

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray

#: inches, at the size at which labels are set
LETTER, LINE = 0.058, 0.112
#: directions in which a label may stand beside its place, the best first
SIDES = ((1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1), (0, -1), (1, 0), (-1, 0))
#: distances from the place [inch]
DISTANCES = (0.05, 0.11, 0.19)
#: how many samples of lines a label may cover
MOST_COVERED = 6
Box = tuple[float, float, float, float]
Point = Sequence[float] | FloatArray


@dataclass(frozen=True)
class PlacedLabel:
    """A label with its place: left, bottom, right and top of its box [inch]."""

    text: str
    box: Box


@dataclass
class Room:
    """What is taken on a sheet, in inches.

    Attributes:
        boxes: left, bottom, right, top of what no label may cover.
        lines: points along lines, float[k, 2], of which a label covers as few as it can.
        limits: within which labels stay; None: anywhere.
    """

    boxes: list[Box] = field(default_factory=list)
    lines: FloatArray = field(default_factory=lambda: np.zeros((0, 2)))
    limits: Box | None = None

    def place(
        self,
        text: str,
        at: Point,
        width: float = 0.0,
        letter: float = LETTER,
        over: bool = False,
        rivals: FloatArray | None = None,
        beyond: FloatArray | None = None,
    ) -> PlacedLabel | None:
        """The best free place beside a point, which is taken from then on; None where none is.

        Args:
            text: one line.
            at: the point [inch].
            width: of the mark that stands at the point [inch].
            letter: width of a letter [inch].
            over: the label may stand on its place and on lines.
            rivals: points that a reader may take the label for, float[k, 2] [inch]: the middle of
                the label stands nearer to its own; None: a line leads from the label to its point.
            beyond: direction of length one in which the middle of the label had best stand from its
                point, float[2].

        >>> room = Room()
        >>> [room.place("S1", (0.0, 0.0)).box[0] > 0, room.place("S2", (0.0, 0.0)).box[0] > 0]
        [True, False]
        """
        wide, high = letter * columns(text), LINE
        found = [(-1, self._around(at, wide, high))] if over else []
        if beyond is not None:
            for step, distance in enumerate(DISTANCES):
                away = distance + float(np.abs(beyond) @ (wide, high)) / 2
                middle = np.asarray(at) + away * beyond
                found.append((step - len(DISTANCES), self._around(middle, wide, high)))
        for step, distance in enumerate(DISTANCES):
            for side, (right, up) in enumerate(SIDES):
                away = width / 2 + distance * (0.75 if right and up else 1.0)
                x = at[0] + right * away - (wide if right < 0 else 0 if right else wide / 2)
                y = at[1] + up * away - (high if up < 0 else 0 if up else high / 2)
                found.append((step * len(SIDES) + side, (x, y, x + wide, y + high)))
        boxes = np.array([box for _, box in found])
        free = self._free(boxes)
        if rivals is not None and len(rivals):
            middles = (boxes[:, None, :2] + boxes[:, None, 2:]) / 2
            nearest = np.linalg.norm(middles - rivals, axis=2).min(axis=1)
            free &= np.linalg.norm(middles[:, 0] - at, axis=1) <= nearest + 1e-9
        if not free.any():
            return None
        covered = np.zeros(len(boxes)) if over else self._covered(boxes)
        costs = np.where(free, 4.0 * covered + np.array([rank for rank, _ in found]), np.inf)
        best = int(np.argmin(costs))
        if covered[best] > MOST_COVERED:
            return None
        self.boxes.append(found[best][1])
        return PlacedLabel(text, found[best][1])

    @staticmethod
    def _around(at: Point, wide: float, high: float) -> Box:
        return at[0] - wide / 2, at[1] - high / 2, at[0] + wide / 2, at[1] + high / 2

    def _free(self, boxes: FloatArray) -> NDArray[np.bool_]:
        free = np.ones(len(boxes), dtype=bool)
        if self.boxes:
            taken = np.array(self.boxes)
            apart = (
                (boxes[:, None, 2] <= taken[:, 0])
                | (boxes[:, None, 0] >= taken[:, 2])
                | (boxes[:, None, 3] <= taken[:, 1])
                | (boxes[:, None, 1] >= taken[:, 3])
            )
            free &= apart.all(axis=1)
        if self.limits is not None:
            left, bottom, right, top = self.limits
            free &= (boxes[:, 0] >= left) & (boxes[:, 1] >= bottom)
            free &= (boxes[:, 2] <= right) & (boxes[:, 3] <= top)
        return free

    def _covered(self, boxes: FloatArray) -> FloatArray:
        near = self.lines
        if not len(near):
            return np.zeros(len(boxes))
        low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
        near = near[((near > low) & (near < high)).all(axis=1)]
        inside = (near > boxes[:, None, :2]) & (near < boxes[:, None, 2:])
        return np.asarray(inside.all(axis=2).sum(axis=1), dtype=float)


def columns(text: str) -> int:
    """Width of a text in letters; those of East Asian scripts are twice as wide.

    >>> columns("mast"), columns("桁")
    (4, 2)
    """
    return sum(2 if east_asian_width(letter) in "WF" else 1 for letter in text)


def overlap(a: Box, b: Box) -> bool:
    """Whether two boxes share more than an edge."""
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
