"""The plots of a challenge: calibration, and which kind is taken for which."""

from collections import Counter
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas
from scipy.special import logit
from scipy.stats import norm

from rga_bench.diagnosis.figures import (
    CONTEXTS,
    FAINT,
    PLAIN,
    ChallengeFigure,
    knowledge,
    nulls_of,
    rate,
    singles,
)
from rga_bench.diagnosis.judge import DrawOutcome
from rga_bench.diagnosis.tables import KINDS, named_as

LEVELS = (0.5, 0.68, 0.8, 0.9, 0.95, 0.99)
BINS = (0.0, 3.0, 5.0, 6.5, 8.0, 12.0, 20.0, 35.0, np.inf)
#: bounds of the log-odds of explanations that count alike
ODDS = (-np.inf, -6.9, -4.6, -2.3, 0.0, 2.3, 4.6, 6.9, np.inf)


def plot(outcomes: Sequence[DrawOutcome], folder: Path) -> list[Path]:
    """Write `calibration.png` and `confusion.png` to a folder."""
    canvas = Canvas(figsize=(12, 9), layout="constrained")
    axes = canvas.subplots(2, 2)
    _intervals(axes[0, 0], outcomes)
    _found(axes[0, 1], outcomes)
    _odds(axes[1, 0], outcomes)
    _nulls(axes[1, 1], outcomes)
    table = Canvas(figsize=(12, 9), layout="constrained")
    _confusion(table, outcomes)
    paths = []
    for name, drawn in (("calibration.png", canvas), ("confusion.png", table)):
        draft = folder / f".{name}"
        drawn.savefig(draft, format="png", dpi=110)
        paths.append(draft.replace(folder / name))
    return paths


def _bar(axes: Axes, x: float, one: ChallengeFigure, color: str = "C0") -> None:
    """A rate with its interval and the number of draws."""
    if one.value is None or one.low is None or one.high is None:
        return
    axes.plot([x, x], [one.low, one.high], color=color, lw=1.2)
    axes.plot(x, one.value, "o", color=color, ms=5)
    axes.annotate(str(one.of), (x, one.value), (4, 3), textcoords="offset points", size=7)


def _intervals(axes: Axes, outcomes: Sequence[DrawOutcome]) -> None:
    axes.plot([0, 1], [0, 1], color="0.7", lw=1)
    groups = (*dict.fromkeys(CONTEXTS.values()), "base error")
    for number, name in enumerate(groups):
        off = np.abs(
            [
                x
                for o in outcomes
                if knowledge(o) == name
                for found in o.deviations.values()
                for x in found.values()
            ]
        )
        if not len(off):
            continue
        held = [rate("", off <= norm.ppf((1 + level) / 2)) for level in LEVELS]
        at = np.array(LEVELS) + 0.004 * (number - 1.5)
        middle, low, high = np.array([(one.value, one.low, one.high) for one in held], float).T
        bars = [middle - low, high - middle]
        axes.errorbar(at, middle, yerr=bars, fmt="o-", ms=4, lw=1, label=f"{name} ({len(off)})")
    axes.set(
        title="Intervals of parameters", xlabel="level", ylabel="share that holds the truth",
        xlim=(0.45, 1.01), ylim=(0.2, 1.02),
    )  # fmt: skip
    if axes.get_legend_handles_labels()[1]:
        axes.legend(loc="lower right", fontsize=8, title="estimates of parameters")


def _found(axes: Axes, outcomes: Sequence[DrawOutcome]) -> None:
    names = []
    for x, (low, high) in enumerate(pairwise(BINS)):
        _bar(axes, x, rate("", [o.found for o in singles(outcomes, low, high)]))
        names.append(f"{low:g} to {high:g}" if np.isfinite(high) else f"{low:g} +")
    first, plain = BINS.index(FAINT), BINS.index(PLAIN)
    axes.plot([first - 0.5, plain - 0.5], [0.85, 0.85], "k--", lw=1)
    axes.plot([plain - 0.5, len(names) - 0.5], [0.97, 0.97], "k--", lw=1, label="asked for")
    axes.set(
        title="Single effects found", xlabel="d_perp", ylabel="share found", ylim=(-0.08, 1.04)
    )
    axes.set_xticks(range(len(names)), names, fontsize=8)
    axes.legend(loc="lower right", fontsize=8)


def _odds(axes: Axes, outcomes: Sequence[DrawOutcome]) -> None:
    pairs = [pair for o in outcomes if o.draw.stratum != "outside" for pair in o.chances]
    shares = np.array([share for share, _ in pairs])
    right = np.array([hit for _, hit in pairs], dtype=bool)
    odds = np.clip(logit(np.clip(shares, 1e-6, 1 - 1e-6)), -12, 12)
    grid = np.linspace(-12, 12, 100)
    axes.plot(grid, 1 / (1 + np.exp(-grid)), color="0.7", lw=1, label="as told")
    for low, high in pairwise(ODDS):
        within = (odds >= low) & (odds < high)
        if within.any():
            _bar(axes, float(odds[within].mean()), rate("", right[within]))
    axes.set(
        title="Chances of explanations", xlabel="log-odds told", ylabel="share that is true",
        ylim=(-0.08, 1.04),
    )  # fmt: skip
    axes.legend(loc="upper left", fontsize=8)


def _nulls(axes: Axes, outcomes: Sequence[DrawOutcome]) -> None:
    nulls = nulls_of(outcomes)
    for x, null in enumerate(nulls):
        own = [bool(o.named) for o in outcomes if o.draw.null and o.null == null]
        _bar(axes, x, rate("", own))
    axes.axhline(0.02, color="k", ls="--", lw=1, label="at most")
    axes.set(title="Null records on which a cause was named", ylabel="share")
    axes.set_ylim(-0.04, 1.04)
    axes.set_xticks(
        range(len(nulls)),
        [name.replace(", ", ",\n").replace("a channel ", "a channel\n") for name in nulls],
        fontsize=8,
    )
    axes.legend(loc="upper left", fontsize=8)


def _confusion(canvas: Canvas, outcomes: Sequence[DrawOutcome]) -> None:
    counts = Counter((o.hidden[0]["kind"], named_as(o)) for o in singles(outcomes, FAINT))
    rows = [kind for kind in KINDS if any(hidden == kind for hidden, _ in counts)]
    others = sorted({named for _, named in counts if named not in rows})
    columns = [*rows, *others]
    axes = canvas.subplots()
    if not rows:
        axes.set(title="There are no single effects of such a size")
        return
    table = np.array([[counts[row, column] for column in columns] for row in rows], dtype=float)
    shares = table / table.sum(1, keepdims=True)
    axes.imshow(shares, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    for (row, column), share in np.ndenumerate(shares):
        if share:
            many = f"{table[row, column]:.0f}"
            color = "white" if share > 0.5 else "black"
            axes.text(column, row, many, ha="center", va="center", fontsize=8, color=color)
    axes.set_xticks(range(len(columns)), columns, rotation=60, ha="right", fontsize=8)
    axes.set_yticks(range(len(rows)), rows, fontsize=8)
    axes.set(
        title=f"What single effects of d_perp {FAINT:g} and more were named",
        xlabel="named", ylabel="hidden",
    )  # fmt: skip
