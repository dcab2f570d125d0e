"""Labels of sensors in a drawing, placed so that they do not cover each other."""

from collections.abc import Callable
from dataclasses import dataclass

from rga.drawing.labels import LETTER, LINE, Box, overlap
from rga.report.drawing.places import Spot

STEP, MOST_STEPS = 0.06, 14


@dataclass(frozen=True)
class Label:
    """Where a label goes, in inches from its spot.

    Attributes:
        x, y: of the corner or edge that faces the spot.
        names: whether it gives the names of the sensors, or their values alone.
        box: left, bottom, right, top, in inches from the origin of the view.
        far: the label was moved away, and needs a line to its spot.
    """

    x: float
    y: float
    names: bool
    box: Box
    far: bool


def place_labels(
    here: list[Spot],
    unit: float,
    lines: Callable[[Spot, bool], list[str]],
    supports: list[tuple[float, float]],
) -> list[Label | None]:
    """A label for every spot; values alone where names do not fit, None where nothing does.

    Args:
        here: the spots.
        unit: metres in an inch.
        lines: the text of a spot, with or without names.
        supports: where supports are drawn, in the coordinates of the view [m].
    """
    taken: list[Box] = [_marker(spot, unit) for spot in here]
    taken += [(x / unit - 0.08, y / unit - 0.14, x / unit + 0.08, y / unit) for x, y in supports]
    chosen: list[Label | None] = []
    for spot in here:
        label = next(
            (
                label
                for names in (True, False)
                for label in _candidates(spot, unit, lines(spot, names), names)
                if not any(overlap(label.box, other) for other in taken)
            ),
            None,
        )
        if label is not None:
            taken.append(label.box)
        chosen.append(label)
    return chosen


def marker_offset(spot: Spot) -> float:
    """How far below or above its spot a marker is drawn [inch]."""
    return {"below": -1.0, "above": 1.0, "right": 0.0}[spot.side] * (0.2 if spot.tier == 2 else 0.0)


def marker_row(spot: Spot) -> float:
    """Distance from the middle of a row of markers to the last of them [inch]."""
    return 0.055 * (len(spot.sensors) - 1)


def _marker(spot: Spot, unit: float) -> Box:
    x, y = spot.x / unit, spot.y / unit + marker_offset(spot)
    half = marker_row(spot) + 0.05
    return x - half, y - 0.05, x + half, y + 0.05


def _candidates(spot: Spot, unit: float, text: list[str], names: bool) -> list[Label]:
    wide, high = LETTER * max(map(len, text)), LINE * len(text)
    x0, y0 = spot.x / unit, spot.y / unit
    middle = marker_offset(spot)
    found = []
    for number in range(MOST_STEPS):
        away = number * STEP + (0.055 if spot.tier == 2 else 0.0)
        if spot.side == "right":
            # A label beside a member may slide up or down, first the one and then the other.
            x, y = marker_row(spot) + 0.08, (-1) ** number * (number + 1) // 2 * STEP
            box = (x0 + x, y0 + y - high / 2, x0 + x + wide, y0 + y + high / 2)
        elif spot.side == "below":
            x, y = 0.0, middle - 0.075 - away
            box = (x0 - wide / 2, y0 + y - high, x0 + wide / 2, y0 + y)
        else:
            x, y = 0.0, middle + 0.075 + away
            box = (x0 - wide / 2, y0 + y, x0 + wide / 2, y0 + y + high)
        found.append(Label(x, y, names, box, number > 1))
    return found
