"""Sensors that nothing moves, and contexts that no sensor sees."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges

#: share of what sensors of a unit show at most, below which a motion is rounding
NOTHING = 1e-9


def sensors(over: OverRanges) -> Iterator[Finding]:
    """Sensors that no context moves, or by less than their noise; contexts that move none."""
    model, shown = over.model, over.readings
    if not model.sensors:
        if model.modal_sensors:
            return
        yield Finding("note", f"model {model.name!r}", "it has no sensor", "add what is measured")
        return
    if shown.trouble is not None:
        return
    if not model.context:
        what = "it has no context: every row of a record is simulated alike"
        yield Finding("note", f"model {model.name!r}", what, "add what changes: loads, temperature")
        return
    values = np.nan_to_num(shown.values)
    units = np.array([sensor.unit for sensor in model.sensors.values()])
    names = np.array(list(model.sensors), dtype=object)
    noise = np.array([sensor.noise or 0.0 for sensor in model.sensors.values()])
    spread = np.ptp(values, axis=0)
    most = np.array([np.abs(values[:, units == unit]).max() for unit in units])
    idle = spread <= NOTHING * most
    if idle.any():
        yield Finding(
            "warning",
            parts("sensor", names[idle]),
            "no context moves it over its whole range",
            "check its place and direction, and that an effect acts there",
        )
    faint = ~idle & (spread < noise)
    if faint.any():
        worst = int(np.argmin(np.where(faint, spread / np.maximum(noise, 1e-300), np.inf)))
        yield Finding(
            "note",
            parts("sensor", names[faint]),
            f"all contexts together move it by less than its noise: {names[worst]!r} by "
            f"{spread[worst]:.3g} of {noise[worst]:g} {units[worst]}",
            "it shows nothing but noise unless something is wrong; check units of both",
        )
    yield from _unseen(over, np.maximum(noise, NOTHING * most))


def _unseen(over: OverRanges, least: np.ndarray) -> Iterator[Finding]:
    """Contexts that move no sensor by as much as its noise."""
    driven = over.simulator.needed
    values = np.nan_to_num(over.readings.values)
    for name in over.model.context:
        if name not in driven:
            continue
        along = np.ptp(values[over.rows_along(name)], axis=0)
        if (along <= least).all():
            yield Finding(
                "warning",
                parts("context", [name]),
                "over its whole range it moves no sensor by more than its noise: where it is not "
                "measured it cannot be inferred",
                "measure it, or add a sensor that it moves",
            )
