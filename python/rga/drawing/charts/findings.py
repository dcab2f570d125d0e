"""The gap of every sensor before and after the extension."""

from matplotlib.axes import Axes

from rga.drawing.charts.pairs import plot_pairs
from rga.drawing.figure_style import INK
from rga.findings import Findings


def plot_findings(findings: Findings, ax: Axes | None = None) -> Axes:
    """The gap by sensor, before and after the extension; at one there is noise alone.

    Args:
        findings: of a diagnosis.
        ax: axes; None: those of a new figure.
    """
    gaps = findings.gap.by_sensor
    # What was worst comes first.
    names = sorted(gaps, key=lambda name: -gaps[name].before)
    ax = plot_pairs(
        names,
        [gaps[name].before for name in names],
        [gaps[name].after for name in names],
        ("model as given", "with the causes"),
        f"gap: {findings.gap.unit}",
        ax,
        log=True,
    )
    ax.axvline(findings.gap.noise_floor, color=INK, lw=0.8, dashes=(4, 2))
    return ax
