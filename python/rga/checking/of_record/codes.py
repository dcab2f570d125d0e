"""Numbers that stand for missing values, such as -9999."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rga.checking.finding import Finding
from rga.checking.measured import Measured
from rga.diagnosis.preparation.missing_codes import missing_codes


def codes(measured: Measured) -> Iterator[Finding]:
    """Codes of loggers among the readings, and among the contexts."""
    record, ranges = measured.record, measured.model.context
    names = tuple(name for name in record.contexts if name in ranges)
    said = missing_codes(record.channels(measured.data.sensors), measured.simulated)
    if names:
        columns = np.column_stack([record.contexts[name] for name in names])
        contexts = replace(record, sensors=names, readings=columns)
        said += missing_codes(contexts, np.array([ranges[name].range for name in names]).T)
    for words in said:
        what, _, remedy = words.rpartition(": ")
        yield Finding("warning", "record", what, remedy)
