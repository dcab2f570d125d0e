"""Methods beside each other, and what levels change."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure as Canvas

from rga_bench.contexts.floors import FLOORS
from rga_bench.contexts.result import ContextsResult
from rga_bench.contexts.rows import ORACLE
from rga_bench.contexts.setting import LEVELS
from rga_bench.contexts.tables.aggregate import at_level, mean, over_drifts, scores
from rga_bench.contexts.tables.level_tables import NULL


def plot(result: ContextsResult, folder: Path) -> None:
    """Write `methods.png`, and `levels.png` where there were drifts, to a folder."""
    drawn = {"methods.png": methods(result)}
    if result.setting.drifts:
        drawn["levels.png"] = levels(result)
    for name, canvas in drawn.items():
        canvas.savefig(folder / name, format="png", dpi=110)


def methods(result: ContextsResult) -> Canvas:
    """Error and RG of each method under the full gap, level A, with 90 % intervals."""
    gap, manner = result.setting.gaps[-1], result.setting.manners[0]
    errors = {
        row: mean(scores(result.outcomes, row, gap, manner, lambda one: one.error))
        for row in result.rows
    }
    own = [row for row, error in errors.items() if error is not None]
    gaps = {
        row: mean(scores(result.outcomes, row, gap, manner, lambda one: one.rg))
        for row in result.rows
    }
    own.sort(key=lambda row: -np.inf if (one := errors[row]) is None else -one.value)
    canvas = Canvas(figsize=(11.0, 1.6 + 0.32 * len(own)), layout="constrained")
    left, right = canvas.subplots(1, 2, sharey=True)
    for axes, found in ((left, errors), (right, gaps)):
        for height, row in enumerate(own):
            one = found[row]
            if one is not None:
                axes.errorbar(
                    one.value, height, xerr=one.reach or 0.0, fmt="o", color="C0", capsize=3
                )
        axes.grid(alpha=0.25)
    floor = errors.get(ORACLE)
    left.axvline(1.0, color="0.6", lw=1, ls=":", label="middle of the ranges")
    if floor is not None:
        left.axvline(floor.value, color="0.3", lw=1, ls="--", label=f"floor: {ORACLE}")
    for name, style in zip(FLOORS, (":", "--", "-."), strict=True):
        one = gaps.get(name)
        if one is not None:
            right.axvline(one.value, color="0.4", lw=1, ls=style, label=f"floor: {name}")
    left.set_yticks(range(len(own)), own)
    left.set_ylim(-0.6, len(own) - 0.4)
    left.set(xlabel="Error [-]", xlim=(0.0, None))
    left.legend(fontsize=8)
    right.set(xlabel="RG [mm²]", xscale="log")
    if right.get_legend_handles_labels()[1]:
        right.legend(fontsize=8)
    canvas.suptitle(f"Level A, gap: {gap}, contexts: {manner}; bars: 90 % intervals over splits")
    return canvas


def levels(result: ContextsResult) -> Canvas:
    """Error on drifted rows by level, a panel for each drift."""
    drifts = result.setting.drifts
    columns = min(3, len(drifts))
    rows = -(-len(drifts) // columns)
    canvas = Canvas(figsize=(4.4 * columns, 3.4 * rows + 1.2), layout="constrained")
    panels = canvas.subplots(rows, columns, sharex=True, sharey=True, squeeze=False).ravel()
    played = [one.row for one in result.outcomes if one.played and one.row not in FLOORS]
    streamed = list(dict.fromkeys(played))
    for axes, drift in zip(panels, drifts, strict=False):
        for number, row in enumerate(streamed):
            found = [
                mean(
                    over_drifts(
                        at_level(result.outcomes, row, [drift], level),
                        lambda played: played.drifted.error,
                    )
                )
                for level in LEVELS
            ]
            # Beside each other, so that none hides another.
            axes.errorbar(
                np.arange(len(LEVELS)) + 0.03 * (number - len(streamed) / 2.0),
                [np.nan if one is None else one.value for one in found],
                [0.0 if one is None else one.reach or 0.0 for one in found],
                fmt="osD^v"[number // 10 % 5] + "-",
                color=f"C{number % 10}",
                label=row,
                ms=4,
                lw=1,
                capsize=2,
            )
        title = "nothing comes (null twin)" if drift == NULL else drift
        axes.set(title=title, xticks=range(len(LEVELS)), xticklabels=LEVELS)
        axes.grid(alpha=0.25)
    for axes in panels[len(drifts) :]:
        axes.set_visible(False)
    # Panels share it.
    panels[0].set_ylim(0.0, None)
    for axes in panels[::columns]:
        axes.set_ylabel("Error on drifted rows [-]")
    for axes in panels[max(0, len(drifts) - columns) : len(drifts)]:
        axes.set_xlabel("level of integration")
    canvas.suptitle("Error on rows under each drift, by level; bars: 90 % intervals over splits")
    handles, labels = panels[0].get_legend_handles_labels()
    canvas.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8)
    return canvas
