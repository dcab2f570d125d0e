"""The bridge with what each sensor measures against what was simulated, before and after."""

import numpy as np
from markupsafe import Markup
from matplotlib.colors import LinearSegmentedColormap, Normalize

from rga.arrays import FloatArray
from rga.findings import Findings
from rga.quantities import DASH, percent, short
from rga.report.drawing.bridge_drawing import Shades, draw_at_sensors
from rga.report.drawing.places import named_parts
from rga.report.figures.deviation import percent_off, squares

#: below the reference, at it, above it
EITHER_WAY = LinearSegmentedColormap.from_list(
    "off", ["#08519c", "#4a90c9", "#c4c9ce", "#e8853a", "#a63603"]
)
ONE_WAY = LinearSegmentedColormap.from_list(
    "noise", ["#c4c9ce", "#eda566", "#d55e00", "#8f2d04", "#3d0f00"]
)


def draw_bridge(findings: Findings) -> Markup:
    """Measured over simulated at every sensor, as percent off."""
    account = findings.account
    off = {
        "before": percent_off(account, account.before),
        "after": percent_off(account, account.after),
    }
    most = _range(off, (5.0, 10.0, 20.0, 30.0, 50.0, 100.0))
    shades = Shades(
        norm=Normalize(-most, most),
        colours=EITHER_WAY,
        text=percent,
        longest="+100 %",
        words="measured over simulated, percent off  (grey: they agree)",
    )
    return _before_and_after(findings, off, shades, "bridge", _words(off))


def draw_residuals(findings: Findings) -> Markup:
    """The residual at every sensor: its root mean square over that of the noise."""
    account = findings.account
    left = {
        "before": _residual(squares(account, account.before)),
        "after": _residual(squares(account, account.after)),
    }
    shades = Shades(
        norm=Normalize(1.0, _range(left, (3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 1000.0))),
        colours=ONE_WAY,
        text=lambda value: short(value, 2) if np.isfinite(value) else DASH,
        longest="0.88",
        words="measured less simulated over noise, root mean square  (1: noise alone)",
    )
    said = [
        f"{short(float(np.median(values[np.isfinite(values)])), 2)} {when} the extension"
        for when, values in left.items()
        if np.isfinite(values).any()
    ]
    words = f"The residual over the noise, at the median sensor: {' and '.join(said) or DASH}."
    return _before_and_after(findings, left, shades, "residuals", words)


def _before_and_after(
    findings: Findings, values: dict[str, FloatArray], shades: Shades, name: str, words: str
) -> Markup:
    marked = named_parts((cause.effect for cause in findings.causes), findings.account.model)
    # Without a cause nothing was extended, and there is no after.
    whens = values if findings.causes else {"before": values["before"]}
    panels = [(when.capitalize() if findings.causes else "", values[when]) for when in whens]
    return draw_at_sensors(findings.account, marked, panels, shades, name, words)


def _residual(square: FloatArray) -> FloatArray:
    seen = np.isfinite(square)
    total, count = np.where(seen, square, 0.0).sum(0), seen.sum(0)
    return np.where(count > 0, np.sqrt(total / np.maximum(count, 1)), np.nan)


def _range(shown: dict[str, FloatArray], steps: tuple[float, ...]) -> float:
    values = np.abs(np.concatenate(list(shown.values())))
    values = values[np.isfinite(values)]
    most = float(np.quantile(values, 0.95)) if len(values) else steps[1]
    return next((step for step in steps if most <= step), steps[-1])


def _words(off: dict[str, FloatArray]) -> str:
    parts = []
    for when, values in off.items():
        seen = np.abs(values[np.isfinite(values)])
        if len(seen):
            parts.append(f"{when} the extension by {percent(float(np.median(seen)), sign=False)}")
    said = " and ".join(parts) or "by an amount that cannot be determined"
    return f"The structure with its sensors; the median sensor is off {said}."
