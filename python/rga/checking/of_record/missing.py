"""Readings that are missing, channels that end, rows that repeat."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.measured import Measured
from rga.diagnosis.preparation.logger_faults import ended_channels, without_repeated

#: shares of missing values that are told, and that are much
SOME, MUCH = 0.05, 0.3


def missing(measured: Measured) -> Iterator[Finding]:
    """Shares of missing readings and contexts, channels that end early, rows written again."""
    record, criteria = measured.record, measured.criteria.record
    columns = dict(zip(record.sensors, record.readings.T, strict=True))
    for kind, table in (("sensor", columns), ("context", record.contexts)):
        shares = {name: float(np.isnan(column).mean()) for name, column in table.items()}
        for least, most in ((SOME, MUCH), (MUCH, 2.0)):
            some = {name: share for name, share in shares.items() if least < share <= most}
            if some:
                worst = max(some, key=lambda name: some[name])
                rows = "" if kind == "sensor" else "; rows without it are left aside"
                yield Finding(
                    "warning" if least == MUCH else "note",
                    parts(kind, some),
                    f"values are missing: {some[worst]:.0%} of {worst!r}{rows}",
                    "fill the cells where the values are known",
                )
    for words in {**ended_channels(record, criteria), **without_repeated(record, criteria)[1]}:
        yield Finding("warning", "record", words, "look into the logger's log book")
