"""The explanations that were tried: the gap where they were fitted and where they were not."""

import numpy as np
from markupsafe import Markup
from matplotlib.figure import Figure

from rga.drawing.figure_style import INK, STEEL, inline, style
from rga.findings.schema import Explanation, Findings
from rga.model.effects.sensors.sensor_fault import is_fault
from rga.report.drawing.places import place_names
from rga.report.figures.gain import dumbbells


def draw_explanations(findings: Findings) -> Markup | None:
    """Gap of each explanation on fitted and on unseen channels; None where none were left out."""
    tried = [
        (number, one, one.gap_unseen_channels)
        for number, one in enumerate(ranked(findings.explanations), start=1)
        if one.gap_unseen_channels is not None
    ]
    if len(tried) < 2:
        return None
    with style():
        high = 0.2 * len(tried) + 0.85
        figure = Figure(figsize=(10.0, high))
        axes = figure.add_axes((0.07, 0.42 / high, 0.9, (high - 0.75) / high))
        values = np.array([[unseen, one.gap] for _, one, unseen in tried])
        names = [f"No. {number}" for number, *_ in tried]
        dumbbells(axes, values, names, findings.gap.noise_floor, (INK, STEEL))
        axes.plot([], [], "^", color=INK, markersize=4.6, label="on channels left out of the fit")
        axes.plot([], [], "o", color=STEEL, markersize=4.6, label="on the channels fitted")
        axes.legend(loc="lower left", bbox_to_anchor=(0.0, 0.98), ncols=2)
        return inline(figure, "explanations", "Gap of each explanation where fitted and where not.")


def ranked(explanations: list[Explanation]) -> list[Explanation]:
    """The best first."""
    return sorted(explanations, key=lambda one: -one.log_odds)


def kept(findings: Findings) -> Explanation | None:
    """The explanation that the causes are, else the one with the largest log-odds."""
    causes = [c.effect for c in findings.causes if not is_fault(c.effect)]
    for one in findings.explanations:
        if causes and _identity(one.effects) == _identity(causes):
            return one
    return max(findings.explanations, key=lambda one: one.log_odds, default=None)


def _identity(effects: list[dict[str, object]]) -> list[str]:
    real = (effect for effect in effects if not is_fault(effect))
    return sorted(f"{effect.get('kind')} {sorted(place_names(effect))}" for effect in real)
