"""Units, signs and orders of magnitude of the channels, beside the simulation."""

from collections.abc import Iterator

import numpy as np

from rga.arrays import FloatArray
from rga.checking.finding import Finding, parts
from rga.checking.measured import Measured
from rga.diagnosis.preparation.suspicious import of_a_unit, unit_factors, unit_slips
from rga.findings.phrases import few_digits

#: how many times as much as over all ranges a channel may vary
BEYOND = 30.0


def units(measured: Measured) -> Iterator[Finding]:
    """Channels that go with the simulation but for a factor or the sign, or vary far too much."""
    data, simulated = measured.data, measured.simulated
    told: set[str] = set()
    for slip in unit_slips(measured.model, data, simulated):
        told |= set(slip.units)
        what, _, remedy = slip.words.partition(": ")
        yield Finding("warning", f"channels in {' and '.join(slip.units)}", what, remedy)
    factors = unit_factors(data, simulated)
    spans, most = _spans(measured)
    for number, name in enumerate(data.sensors):
        unit, factor = measured.model.sensors[name].unit, factors[number]
        where = parts("channel", [name])
        if unit in told:
            continue
        if of_a_unit(abs(factor), measured.criteria.record):
            yield Finding(
                "warning",
                where,
                f"it goes with the simulation and is about {few_digits(abs(factor))} times as "
                "large",
                f"check its unit, {unit} by the model; give it in import.toml where it differs",
            )
        elif most[number] > 0 and spans[number] > BEYOND * most[number]:
            yield Finding(
                "warning",
                where,
                f"it varies by {spans[number]:.3g} {unit}, and the model over all ranges of its "
                f"contexts by {most[number]:.3g}",
                "check its unit, its place in the model, and its cable",
            )
        if factor < 0:
            yield Finding(
                "warning",
                where,
                "it goes against the simulation",
                "check its sign; give sign = -1 in import.toml where the logger counts otherwise",
            )


def _spans(measured: Measured) -> tuple[FloatArray, FloatArray]:
    """What each channel spans but for its extremes, and the model over all ranges at most."""
    data = measured.data
    spans = np.zeros(len(data.sensors))
    for number, (column, seen) in enumerate(zip(data.readings.T, data.observed.T, strict=True)):
        if seen.any():
            low, high = np.quantile(column[seen], [0.05, 0.95])
            spans[number] = high - low
    shown = measured.over.readings
    if shown.trouble is not None:
        return spans, np.zeros(len(spans))
    noise = np.array([measured.model.sensors[name].noise or 0.0 for name in data.sensors])
    return spans, np.ptp(np.nan_to_num(shown.values), axis=0)[data.columns] + 4 * noise
