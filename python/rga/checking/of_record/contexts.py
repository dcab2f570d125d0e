"""Measured contexts outside their ranges, at a limit, or that stand still."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.measured import Measured
from rga.diagnosis.preparation.bad_contexts import without_limits
from rga.diagnosis.preparation.suspicious import suspicious_contexts
from rga.records.load import CHANCE


def contexts(measured: Measured) -> Iterator[Finding]:
    """Rows in which a context leaves its range by more than its noise; what else is odd of one."""
    model, record = measured.model, measured.record
    for name, column in record.contexts.items():
        variable = model.context[name]
        low, high = variable.range
        margin = CHANCE * (variable.noise or 0.0)
        outside = np.flatnonzero((column < low - margin) | (column > high + margin))
        if len(outside) and len(outside) < len(column):
            yield Finding(
                "warning",
                parts("context", [name]),
                f"it lies outside its range {low:g} to {high:g} {variable.unit} in "
                f"{measured.rows_in_words(outside)}; it runs from {np.nanmin(column):g} to "
                f"{np.nanmax(column):g}",
                "check its unit and its zero, or widen the range where it is right",
            )
    _, limits = without_limits(record, measured.criteria.record)
    for words in [*suspicious_contexts(model, measured.data, record), *limits]:
        yield Finding("warning", "contexts of the record", words, "look into how it was measured")
