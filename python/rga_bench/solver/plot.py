"""The ratios to the peers, drawn."""

from pathlib import Path

from matplotlib.figure import Figure as Canvas

from rga_bench.measurement import digits
from rga_bench.solver.result import SolverResult


def plot(result: SolverResult, path: Path) -> None:
    """Write bars of the ratios, and their targets, to a PNG file."""
    shown = [(one, one.ratio) for one in result.figures if one.ratio is not None]
    cases = list(dict.fromkeys(one.case for one, _ in shown))
    canvas = Canvas(figsize=(11, 1.4 + 0.34 * len(shown)), layout="constrained")
    axes = canvas.subplots()
    axes.axvline(1.0, color="0.6", lw=1)
    for place, (one, ratio) in enumerate(shown):
        # From as good as the peer to what it is: a bar begins at 1.
        axes.barh(place, ratio - 1.0, left=1.0, color=f"C{cases.index(one.case)}")
        axes.annotate(
            digits(ratio),
            (max(ratio, 1.0, one.least or 0.0), place),
            (4, 0),
            textcoords="offset points",
            va="center",
            size=8,
        )
        if one.least is not None:
            axes.plot([one.least] * 2, [place - 0.45, place + 0.45], color="black", lw=2)
    if any(one.least is not None for one, _ in shown):
        axes.plot([], [], color="black", lw=2, label="asked at least")
        axes.legend(loc="lower right")
    axes.set(
        xscale="log",
        xlabel="times as good as the peer",
        yticks=range(len(shown)),
        yticklabels=[f"{one.case}: {one.name} vs {one.peer}" for one, _ in shown],
        title=f"{result.machine['processor']}, {result.day}",
    )
    axes.invert_yaxis()
    lowest = min([1.0, *(ratio for _, ratio in shown), *(one.least or 1.0 for one, _ in shown)])
    axes.set_xlim(0.7 * lowest, 3.0 * max([1.0, *(ratio for _, ratio in shown)]))
    canvas.savefig(path, format="png", dpi=110)
