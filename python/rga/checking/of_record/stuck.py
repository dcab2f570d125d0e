"""Channels that stand still."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.measured import Measured
from rga.diagnosis.preparation.sensor_faults.own_readings import silent, stuck_channels


def stuck(measured: Measured) -> Iterator[Finding]:
    """Channels that repeat themselves over most of the record, or from some row on."""
    record, criteria = measured.record, measured.criteria.channels
    observed = np.isfinite(record.readings)
    readings = np.nan_to_num(record.readings)
    faults = stuck_channels(record.sensors, readings, observed, criteria)
    found = {fault.sensor: fault.why for fault in faults}
    for number, name in enumerate(measured.data.sensors):
        seen, column = measured.data.observed[:, number], measured.data.readings[:, number]
        if name in found or seen.sum() < 2:
            continue
        fault = silent(name, column, seen, measured.simulated[:, number], criteria)
        if fault is not None and fault.row is not None:
            row = int(np.searchsorted(record.time, measured.few.time[fault.row]))
            found[name] = f"it stands still from {measured.moment(row)} to the last"
        elif fault is not None:
            found[name] = fault.why
    for name, why in found.items():
        yield Finding(
            "warning",
            parts("sensor", [name]),
            why,
            "check its cable; list it under [unused] in import.toml where it does not work",
        )
