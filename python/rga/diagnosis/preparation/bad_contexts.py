"""Contexts that are not what acted: an instrument at its limit, rows that many channels deny."""

from dataclasses import replace

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.findings.criteria.records import RecordCriteria
from rga.model.schema import Model
from rga.records import Record

#: share of neighbours that read the same, below which an instrument shows every change
_CONTINUOUS = 0.02


def at_limit(values: FloatArray, criteria: RecordCriteria) -> BoolArray:
    """Rows in which a context stands at its own largest or smallest value, as a full scale does.

    An instrument whose readings else never repeat repeats its limit. Zero is no limit: a load that
    is not there reads nothing.

    Args:
        values: float[rows], NaN where missing.
        criteria: rows that may stand at a limit.

    >>> wind = np.array([3.1, 9.7, 40.0, 40.0, 12.2, 5.6, 1.0, 7.3])
    >>> np.flatnonzero(at_limit(wind, RecordCriteria(limit_share=0.3)))
    array([2, 3])
    """
    found = np.zeros(len(values), dtype=bool)
    known = values[np.isfinite(values)]
    if len(known) < 3:
        return found
    for limit in (known.min(), known.max()):
        at = known == limit
        repeated = np.diff(known) == 0
        between = ~(at[1:] & at[:-1])
        coarse = repeated[between].mean() > _CONTINUOUS if between.any() else True
        if limit == 0 or coarse or not (repeated & ~between).any():
            continue
        if at.sum() <= criteria.limit_share * len(known):
            found |= values == limit
    return found


def without_limits(record: Record, criteria: RecordCriteria) -> tuple[Record, list[str]]:
    """The record without contexts that stand at the limit of their instrument, and warnings.

    Args:
        record: as it was measured.
        criteria: rows that may stand at a limit.
    """
    contexts, warnings = {}, []
    for name, values in record.contexts.items():
        at = at_limit(values, criteria)
        contexts[name] = np.where(at, np.nan, values)
        if at.any():
            warnings.append(
                f"{name} stands at exactly {values[at][0]:g} in {int(at.sum())} rows, as an "
                "instrument at its limit does: these rows were left aside"
            )
    return (replace(record, contexts=contexts), warnings) if warnings else (record, [])


def without_impossible(
    model: Model, record: Record, criteria: RecordCriteria
) -> tuple[Record, dict[str, float]]:
    """The record without contexts that lie far outside their ranges in a part of the rows.

    Args:
        model: states the ranges.
        record: as it was measured.
        criteria: how far is far.

    Returns:
        The record, and what there is of this in words, with the share of rows.
    """
    contexts, faults = dict(record.contexts), {}
    for name, values in record.contexts.items():
        if name not in model.context:
            continue
        low, high = model.context[name].range
        reach = criteria.far_outside * (high - low)
        far = (values < low - reach) | (values > high + reach)
        if high > low and far.any() and not far[np.isfinite(values)].all():
            contexts[name] = np.where(far, np.nan, values)
            words = (
                f"{name} lies far outside its range {low:g}..{high:g} in {far.sum()} of "
                f"{len(far)} rows: these were left aside; check its unit and its zero"
            )
            faults[words] = float(far.mean())
    return (replace(record, contexts=contexts), faults) if faults else (record, faults)


def denied_rows(spikes: BoolArray, observed: BoolArray, criteria: RecordCriteria) -> BoolArray:
    """Rows in which many channels jump at once: what acted is not what their contexts say.

    Args:
        spikes: lone readings far away from what the loads allow, bool[rows, sensors].
        observed: bool[rows, sensors].
        criteria: how many channels deny a row.

    Returns:
        bool[rows].
    """
    many = spikes.sum(axis=1)
    share = criteria.denied_share * observed.sum(axis=1)
    return np.asarray(many >= np.maximum(share, criteria.denied_channels))
