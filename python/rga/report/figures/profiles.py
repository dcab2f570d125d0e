"""How sure the parameters of a cause are: the evidence over their range, and over onsets."""

import numpy as np
from markupsafe import Markup
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rga.arrays import FloatArray
from rga.diagnosis.checks.profiles import Onset, Profile
from rga.drawing.figure_style import AFTER, FAINT, INK, STEEL, grid, inline, style
from rga.drawing.label import label
from rga.model.parameter import NORMAL_90
from rga.quantities import duration, scale
from rga.report.pages.cards import plain

#: half width of the 90 % interval in standard deviations, and its depth in log probability
DEPTH = NORMAL_90**2 / 2
LEAST, MOST_PANELS = -8.0, 3


def draw_profiles(
    shown: list[Profile], units: list[str], onset: Onset | None, likeliest: str, name: str
) -> Markup:
    """A panel for every parameter, and one for the onset.

    Args:
        shown: of the parameters of one cause.
        units: of the parameters, as they are to be read.
        onset: of that cause; its likeliest moment as the record writes it.
        name: as for `inline`.
    """
    panels = len(shown) + (onset is not None)
    with style():
        wide = max(panels, MOST_PANELS)
        figure = Figure(figsize=(10.0, 2.15))
        cells = figure.add_gridspec(
            1, wide, left=0.065, right=0.985, top=0.86, bottom=0.21, wspace=0.27
        )
        for place, (one, unit) in enumerate(zip(shown, units, strict=True)):
            _profile(figure.add_subplot(cells[place]), one, unit)
        if onset is not None:
            _onset(figure.add_subplot(cells[len(shown)]), onset, likeliest)
        names = ", ".join(label(plain(one.parameter)) for one in shown)
        return inline(figure, name, f"Log probability over the range of: {names}.")


def _profile(axes: Axes, one: Profile, unit: str) -> None:
    factor, shown_unit = scale(unit, float(np.abs(one.values).max()))
    values = one.values * factor
    fine = np.linspace(one.away[0], one.away[-1], 61)
    at = np.interp(fine, one.away, values)
    interval = np.interp([-NORMAL_90, NORMAL_90], one.away, values)
    axes.axvspan(*sorted(float(end) for end in interval), color=FAINT, alpha=0.6, lw=0)
    axes.axhline(-DEPTH, color=STEEL, lw=0.7, dashes=(3, 2))
    axes.plot(at, -(fine**2) / 2, color=STEEL, lw=1.0)
    axes.plot(values, np.maximum(one.height, LEAST), "o-", color=AFTER, lw=1.0, markersize=3.4)
    axes.axvline(float(values[len(values) // 2]), color=INK, lw=0.6)
    axes.set_ylim(max(LEAST, 1.15 * float(min(one.height.min(), -4.5))), 0.5)
    axes.set_xlabel(f"{plain(one.parameter)}{f' [{shown_unit}]' if shown_unit else ''}")
    axes.set_ylabel("log probability")
    axes.locator_params(axis="x", nbins=5)
    grid(axes)


def _onset(axes: Axes, onset: Onset, likeliest: str) -> None:
    first, last = _likely(onset.chances)
    margin = max(3, last - first)
    rows = slice(max(first - margin, 0), last + margin + 1)
    times = onset.times[rows]
    length, unit = duration(float(np.abs(onset.times).max()))
    factor = length / max(float(np.abs(onset.times).max()), 1e-300)
    step = float(np.median(np.diff(times))) if len(times) > 1 else 1.0
    axes.bar(times * factor, onset.chances[rows], 0.8 * step * factor, color=AFTER, lw=0)
    axes.set_ylim(0, 1.08 * float(onset.chances.max()))
    axes.set_xlabel(f"onset, from the first row [{unit}]")
    axes.set_ylabel("probability")
    axes.set_title(f"estimate: {likeliest}")
    axes.locator_params(axis="x", nbins=5)
    grid(axes, "y")


def _likely(chances: FloatArray) -> tuple[int, int]:
    """First and last of the onsets that hold all but a thousandth of the probability."""
    below = np.cumsum(chances)
    first = int(np.searchsorted(below, 5e-4))
    return first, min(int(np.searchsorted(below, 1 - 5e-4)), len(chances) - 1)
