"""Cost against gap, drawn."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure as Canvas

from rga_bench.policies.mean_results import means
from rga_bench.policies.twin_run import PolicyResult

MARKS = {"event": "o", "time": "s", "hybrid": "D", "adaptive": "^"}


def plot(played: Sequence[PolicyResult], path: Path) -> None:
    """Write a panel for each sort of stream, a mark for each policy, to a PNG file."""
    known = means(played)
    streams = list(dict.fromkeys(stream for stream, _ in known))
    policies = list(dict.fromkeys(policy for _, policy in known))
    canvas = Canvas(figsize=(4.2 * len(streams), 4.6), layout="constrained")
    panels = canvas.subplots(1, len(streams), sharex=True, squeeze=False)[0]
    for axes, stream in zip(panels, streams, strict=True):
        for number, policy in enumerate(policies):
            mean, mark = known[stream, policy], MARKS[policy.partition(",")[0]]
            axes.plot(
                [mean["steps"]], [mean["gap"]], mark, color=f"C{number}", mec="0.2", ms=9,
                alpha=0.8, label=policy, clip_on=False, zorder=3,
            )  # fmt: skip
        axes.set(title=stream, xlabel="optimiser steps after the first calibration")
        axes.set_xlim(0.0, 1.05 * max(one["steps"] for one in known.values()) + 1.0)
        axes.set_ylim(0.0, 1.1 * max(known[stream, policy]["gap"] for policy in policies))
        axes.grid(alpha=0.2)
    panels[0].set_ylabel("mean squared gap over noise variance")
    handles, labels = panels[0].get_legend_handles_labels()
    canvas.legend(handles, labels, loc="outside lower center", ncols=3)
    canvas.savefig(path, format="png", dpi=110)
