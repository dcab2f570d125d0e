"""The section of a report about modes, made ready for the template."""

from typing import Any

import numpy as np

from rga.findings.modal_arrays import ModalArrays, ModeReading
from rga.model.mass_budget import mass_budget
from rga.quantities import DASH, counted, percent
from rga.report.figures.modes import draw_frequencies, draw_over_weather, draw_shapes

SHAPES = (
    "Modes on the structure: computed lines, and nodes as they were measured, to the same scale; "
    "left as given, right with the causes."
)
FREQUENCIES = "Natural frequencies in the windows, measured and simulated."
OVER_WEATHER = "The same over {}: what of them follows it, and whether the model does."


def modes_section(account: ModalArrays) -> dict[str, Any]:
    """The table of the modes, and their figures."""
    figures = [{"svg": draw_shapes(account), "words": SHAPES}]
    over_time = draw_frequencies(account)
    if over_time is not None:
        figures.append({"svg": over_time, "words": FREQUENCIES})
    for name, over in draw_over_weather(account).items():
        figures.append({"svg": over, "words": OVER_WEATHER.format(name)})
    windows = f"{counted(len(account.modes), 'mode')} in {counted(len(account.time), 'window')}"
    lines = [_line(one) for one in account.modes]
    budget = [
        (one.of, _tonnes(one.members), _tonnes(one.beside), _tonnes(one.total))
        for one in mass_budget(account.model)
    ]
    return {"windows": windows, "lines": lines, "figures": figures, "budget": budget}


def _tonnes(mass: float) -> str:
    """A mass [kg] in tonnes."""
    return f"{mass / 1000:.3g}"


def _line(mode: ModeReading) -> dict[str, str]:
    off = [100 * float(np.expm1(np.nanmean(mode.log_f - one))) for one in (mode.before, mode.after)]
    return {
        "name": mode.name,
        "found": f"{100 * mode.found:.0f}",
        "frequency": f"{mode.frequency:.4g}",
        "scatter": f"{100 * mode.scatter:.2g}",
        "number": f"{mode.number[0]} → {mode.number[1]}",
        "off": " → ".join(percent(one) for one in off),
        "mac": " → ".join(f"{one:.2f}" if np.isfinite(one) else DASH for one in mode.mac),
    }
