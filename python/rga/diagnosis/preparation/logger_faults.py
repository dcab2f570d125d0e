"""What a logger does to many channels at once: rows that it writes again, channels that end."""

from dataclasses import replace

import numpy as np
import polars as pl

from rga.arrays import BoolArray, FloatArray
from rga.findings.criteria.records import RecordCriteria
from rga.records import Record

#: channels that a comparison of rows needs
FEWEST = 4
#: share of readings that repeat the one before by themselves, above which rows may do so as well
COARSE = 0.1
#: channels that a sentence names; it counts the others
MOST_NAMED = 5


def repeated_rows(readings: FloatArray, criteria: RecordCriteria) -> BoolArray:
    """Rows on end in which all channels read exactly what they had read in earlier ones.

    Args:
        readings: float[rows, channels], NaN where missing.
        criteria: in how many rows on end.

    Returns:
        bool[rows]; the rows that are repeated are not among them.

    >>> readings = np.random.default_rng(0).normal(size=(60, 6))
    >>> readings[40:55] = readings[10:25]
    >>> np.flatnonzero(repeated_rows(readings, RecordCriteria())).tolist() == list(range(40, 55))
    True
    """
    found = np.zeros(len(readings), dtype=bool)
    values = [np.unique(column[np.isfinite(column)]) for column in readings.T]
    moves = np.array([len(one) > criteria.repeated_rows for one in values], dtype=bool)
    table = np.nan_to_num(readings[:, moves], nan=np.inf)
    if moves.sum() < FEWEST or _coarse(table):
        return found
    read = np.isfinite(table).sum(axis=1) >= FEWEST
    first = pl.from_numpy(table[read]).select(pl.struct(pl.all()).is_first_distinct())
    again = np.zeros(len(table), dtype=bool)
    again[read] = ~first.to_series().to_numpy()
    edges = np.flatnonzero(np.diff(again.astype(int), prepend=0, append=0)).reshape(-1, 2)
    for first, end in edges:
        if end - first >= criteria.repeated_rows:
            found[first:end] = True
    return found


def _coarse(table: FloatArray) -> bool:
    """Whether channels repeat single readings, as those of coarse steps do."""
    same = table[1:] == table[:-1]
    alone = same[~same.all(axis=1)]
    return bool(len(alone) and alone.mean() > COARSE)


def without_repeated(record: Record, criteria: RecordCriteria) -> tuple[Record, dict[str, float]]:
    """The record without readings of rows that repeat earlier ones.

    Args:
        record: as it was measured.
        criteria: in how many rows on end.

    Returns:
        The record, and what there is of this in words, with the share of rows.
    """
    again = repeated_rows(record.readings, criteria)
    if not again.any():
        return record, {}
    words = (
        f"in {again.sum()} rows, the first of them row {np.argmax(again)}, all channels read to "
        "the last digit what they had read before, as a logger that stands still or sends its "
        "memory again does: these rows were left aside"
    )
    readings = np.where(again[:, None], np.nan, record.readings)
    return replace(record, readings=readings), {words: float(again.mean())}


def without_silent(record: Record, criteria: RecordCriteria) -> tuple[Record, dict[str, float]]:
    """The record without readings of channels that have hardly any.

    Args:
        record: as it was measured.
        criteria: fewer than the rows of the shortest record are hardly any.

    Returns:
        The record, and what there is of this in words, with the share of channels.
    """
    silent = np.isfinite(record.readings).sum(axis=0) < criteria.least_rows
    if not silent.any():
        return record, {}
    names = _listed([name for name, one in zip(record.sensors, silent, strict=True) if one])
    words = (
        f"{silent.sum()} of {len(silent)} channels have no reading, or hardly any: {names}; what "
        "shows in these alone is not seen"
    )
    readings = np.where(silent, np.nan, record.readings)
    return replace(record, readings=readings), {words: float(silent.mean())}


def ended_channels(record: Record, criteria: RecordCriteria) -> dict[str, float]:
    """Channels without a reading in the last rows, where others have some.

    Args:
        record: as it was measured.
        criteria: in how many rows.

    Returns:
        What there is of this in words, with the share of channels.
    """
    rows = np.arange(1, len(record) + 1)[:, None]
    ends = np.where(np.isfinite(record.readings), rows, 0).max(axis=0, initial=0)
    early = (ends > 0) & (ends <= ends.max(initial=0) - criteria.repeated_rows)
    if not early.any():
        return {}
    ended = [name for name, one in zip(record.sensors, early, strict=True) if one]
    words = (
        f"{len(ended)} of {len(early)} channels have no reading from some row on, the first from "
        f"row {ends[early].min()}: {_listed(ended)}; what has happened since may have shown in "
        "these alone"
    )
    return {words: float(early.mean())}


def _listed(names: list[str]) -> str:
    more = len(names) - MOST_NAMED
    return ", ".join(names[:MOST_NAMED]) + f" and {more} more" * (more > 0)
