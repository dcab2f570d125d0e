"""One scale of colours for the gap, shared by the drawings of the bridge and the map of sensors."""

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, to_hex
from matplotlib.patches import Rectangle

from rga.arrays import FloatArray
from rga.drawing.figure_style import STEEL
from rga.quantities import short
from rga.report.figures.of_run.run_gap import mean

LEVELS, BLOCKS = 12, 60
SHADES = LinearSegmentedColormap.from_list(
    "gap",
    [
        (0.0, "#e3ebf2"),
        (0.25, "#f3e3cf"),
        (0.5, "#eda566"),
        (0.7, "#d55e00"),
        (0.87, "#8f2d04"),
        (1.0, "#3d0f00"),
    ],
)
HATCH = "/////"


@dataclass(frozen=True)
class GapColours:
    """Levels of colour between a gap of 1, noise alone, and a largest gap.

    Attributes:
        top: gap from which on the colour is the darkest [-].
        colours: one a level.
    """

    top: float
    colours: tuple[str, ...]

    def level(self, gaps: FloatArray) -> FloatArray:
        """Level of gaps of any shape; NaN where there is none."""
        with np.errstate(invalid="ignore"):
            share = np.log(np.maximum(gaps, 1.0)) / np.log(self.top)
        return np.asarray(np.minimum(np.floor(share * LEVELS), LEVELS - 1))

    def colour(self, gap: float) -> str:
        """Colour of a gap; white where there is none."""
        return self.colours[int(self.level(np.array(gap)))] if np.isfinite(gap) else "white"

    def key(self, axes: Axes) -> None:
        """Paint the scale, and beside it what stands for no value."""
        edges = np.linspace(0.0, 1.0, LEVELS + 1)
        # Painted step by step: matplotlib's own colour bar would be a bitmap.
        axes.bar(edges[:-1], 1.0, np.diff(edges) * 1.02, align="edge", color=self.colours, lw=0)
        steps = [step for step in _STEPS if step <= self.top]
        # Not so many numbers that they touch.
        if len(steps) > 7:
            steps = [step for step in steps if step == self.top or f"{step:.0e}"[0] == "1"]
        names = [short(step) for step in steps[:-1]] + [f"≥ {short(steps[-1])}"]
        axes.set_xticks([np.log(s) / np.log(self.top) for s in steps], names)
        axes.set(xlim=(0, 1.32), ylim=(0, 1), yticks=[])
        for side in ("left", "bottom"):
            axes.spines[side].set_visible(False)
        empty = Rectangle((1.08, 0), 0.06, 1, fc="white", ec=STEEL, lw=0.4, hatch=HATCH)
        axes.add_patch(empty)
        axes.text(1.155, 0.5, "no value", va="center", fontsize=7.5)
        axes.set_xlabel("gap: squared difference over variance of the noise  (1: noise alone)")
        axes.xaxis.label.set(x=0, ha="left", size=7.5)


_STEPS = [1.0, *(m * 10.0**e for e in range(12) for m in (3.0, 10.0))]


def gap_colours(gaps: FloatArray) -> GapColours:
    """The scale for the gaps of a run, float[rows, sensors]; NaN where there is none."""
    blocks = np.array_split(gaps, min(BLOCKS, len(gaps)))
    means = np.array([mean(block, axis=0) for block in blocks])
    finite = means[np.isfinite(means)]
    # A few spikes would leave one colour to all the rest.
    most = float(np.quantile(finite, 0.998)) if len(finite) else 10.0
    top = next((step for step in _STEPS[2:] if most <= step), _STEPS[-1])
    return GapColours(top, tuple(to_hex(SHADES(x)) for x in np.linspace(0.0, 1.0, LEVELS)))
