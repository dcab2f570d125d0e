"""Cost against gap, drawn."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure as Canvas

from rga.benchmark.policies.play import Played
from rga.benchmark.policies.run import means

MARKS = {"event": "o", "time": "s", "hybrid": "D", "adaptive": "^"}


def plot(played: Sequence[Played], path: Path) -> None:
    """Write a panel for each sort of stream, a mark for each policy, to a PNG file."""
    known = means(played)
    streams = list(dict.fromkeys(stream for stream, _ in known))
    policies = list(dict.fromkeys(policy for _, policy in known))
    canvas = Canvas(figsize=(4.2 * len(streams), 4.6), layout="constrained")
    panels = canvas.subplots(1, len(streams), squeeze=False)[0]
    for axes, stream in zip(panels, streams, strict=True):
        for number, policy in enumerate(policies):
            mean = known[stream, policy]
            look = {"marker": MARKS[policy.partition(",")[0]], "color": f"C{number}", "ls": ""}
            single = [one for one in played if (one.stream, one.policy) == (stream, policy)]
            if len(single) > 1:
                cost, gap = [one.steps for one in single], [one.gap for one in single]
                axes.plot(cost, gap, **look, ms=4, alpha=0.3)
            axes.plot([mean["steps"]], [mean["gap"]], **look, ms=9, mec="black", label=policy)
        axes.set(title=stream, xlabel="optimiser steps after the first calibration")
        axes.set_yscale("log")
        axes.grid(which="both", alpha=0.2)
    panels[0].set_ylabel("mean squared gap over noise variance")
    handles, labels = panels[0].get_legend_handles_labels()
    canvas.legend(handles, labels, loc="outside lower center", ncols=3)
    canvas.savefig(path, format="png", dpi=110)
