"""Delays against sizes, and what a delay costs in false alarms."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Canvas

from rga_bench.detection.detectors import WINDOW_RULE, Z
from rga_bench.detection.optimum import OPTIMUM
from rga_bench.detection.result import DetectionResult
from rga_bench.measurement import digits

#: as published: samples from a change to the alarm
PUBLISHED = (49.0, 70.0)


def plot(result: DetectionResult, folder: Path) -> None:
    """Write `delays.png` and `limits.png` to a folder."""
    for name, drawn in (("delays.png", delays(result)), ("limits.png", limits(result))):
        drawn.savefig(folder / name, format="png", dpi=110)


def delays(result: DetectionResult) -> Canvas:
    """Delay against the size of a step, for one sensor, some and all."""
    steps = [one for one in result.delays if one.kind == "step" and one.known]
    steps = [one for one in steps if one.size in result.setting.sizes and "sign" not in one.fault]
    counts = result.setting.counts
    canvas = Canvas(figsize=(4.0 * len(counts), 4.4), layout="constrained")
    row = canvas.subplots(1, len(counts), sharey=True, squeeze=False)[0]
    for axes, count in zip(row, counts, strict=True):
        for detector, style in _styles(result).items():
            own = [one for one in steps if (one.count, one.detector) == (count, detector)]
            mean = [(one.size, one.delay.mean) for one in own if one.delay.mean]
            axes.plot(*np.array(mean).reshape(-1, 2).T, label=detector, **style)
            for one in own:
                if one.delay.low and one.delay.high:
                    ends = [one.delay.low, one.delay.high]
                    axes.plot([one.size] * 2, ends, color=style["color"], lw=1.2)
        axes.axhline(result.setting.arl0, color="0.6", lw=1, ls=":")
        of = f"{count} of {result.setting.sensors} sensors"
        axes.set(
            xscale="log", yscale="log", xlabel="size of the step [sd]",
            title="all sensors" if count == result.setting.sensors else of,
        )  # fmt: skip
        axes.set_xticks(result.setting.sizes, [f"{size:g}" for size in result.setting.sizes])
        axes.minorticks_off()
        axes.grid(alpha=0.3)
    row[0].annotate(
        "rows between false alarms", (result.setting.sizes[0], result.setting.arl0), (0, 4),
        textcoords="offset points", size=8, color="0.4",
    )  # fmt: skip
    row[0].set_ylabel("mean delay [rows]")
    row[-1].legend(fontsize=9)
    canvas.suptitle(f"Delay at {digits(result.setting.arl0)} rows between false alarms")
    return canvas


def limits(result: DetectionResult) -> Canvas:
    """The window rule at any z; and delay against false alarms of all detectors."""
    canvas = Canvas(figsize=(11.5, 4.8), layout="constrained")
    left, right = canvas.subplots(1, 2, sharey=True)
    _any_delay(left, result)
    _costs(right, result)
    return canvas


def _any_delay(axes: Axes, result: DetectionResult) -> None:
    points = [one for one in result.points if one.detector == WINDOW_RULE]
    z = [one.limit for one in points]
    axes.axhspan(*PUBLISHED, color="C1", alpha=0.25, lw=0)
    axes.plot(z, [one.delay for one in points], "o-", ms=3, color="C0", label="delay")
    axes.plot(
        z, [one.arl0 for one in points], "s--", ms=3, color="C3", label="between false alarms"
    )
    axes.axvline(Z, color="0.6", lw=1, ls=":")
    axes.annotate(
        f"z = {Z:g}", (Z, 1.0), (4, -3), textcoords="offset points", size=8, color="0.4", va="top"
    )
    axes.annotate(
        "delays as published", (max(z), PUBLISHED[1]), (0, 3),
        textcoords="offset points", size=8, color="0.3", ha="right",
    )  # fmt: skip
    axes.set(
        yscale="log", xlabel="bound z of the window rule", ylabel="rows",
        title="Any delay can be had, at some rate of false alarms",
    )  # fmt: skip
    axes.grid(alpha=0.3)
    axes.legend(fontsize=9)


def _costs(axes: Axes, result: DetectionResult) -> None:
    highest = result.setting.arl0
    axes.plot([1.0, highest], [1.0, highest], color="0.6", lw=1, ls=":", label="blind")
    for detector, style in _styles(result).items():
        own = [one for one in result.points if one.detector == detector]
        if own:
            line = {**style, "marker": ""}
            axes.plot([one.arl0 for one in own], [one.delay for one in own], label=detector, **line)
            continue
        alarms = [one for one in result.alarms if one.detector == detector and one.known]
        seen = [
            one.delay.mean
            for one in result.delays
            if (one.detector, one.kind, one.size, one.count) == (detector, "step", 1.0, 1)
            and one.known
        ]
        if alarms and alarms[0].arl0.rows and seen and seen[0]:
            axes.plot(alarms[0].arl0.rows, seen[0], label=detector, **{**style, "ms": 9, "ls": ""})
    axes.set(
        xscale="log", yscale="log", xlabel="rows between false alarms", ylabel="delay [rows]",
        title="What a delay costs: step of 1 sd in one sensor",
    )  # fmt: skip
    axes.grid(alpha=0.3)
    axes.legend(fontsize=9)


def _styles(result: DetectionResult) -> dict[str, dict[str, Any]]:
    """Of the detectors, the optimum last and in black."""
    names = list(dict.fromkeys(one.detector for one in result.delays if one.detector != OPTIMUM))
    styles: dict[str, dict[str, Any]] = {
        name: {"color": f"C{number}", "marker": "osDv^P"[number % 6], "ms": 5.0, "ls": "-"}
        for number, name in enumerate(names)
    }
    return {**styles, OPTIMUM: {"color": "black", "marker": "", "ms": 0.0, "ls": "--"}}
