"""Rows of another logger, matched to those of a record."""

from collections.abc import Collection
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.channels import quoted
from rga.records.logger_data import LoggerData, check_alike, later, since
from rga.records.mapping import Beside
from rga.records.means import GAP, means_about


def side_by_side(
    record: LoggerData, other: LoggerData, how: Beside, noises: Collection[str] = ()
) -> LoggerData:
    """A record with the channels of another logger.

    Args:
        record: whose rows are kept, unless means are taken on the rows of a slower logger.
        other: the other logger.
        how: rows are matched.
        noises: channels whose noise the model states.

    Raises:
        InputError: both have a channel, their times cannot be compared, or no row matches.
    """
    check_alike(record, other, "[time] and [beside.time]")
    if both := record.values.keys() & other.values.keys():
        name = sorted(both)[0]
        raise InputError(
            f"{record.where} and {other.where} both give {name!r}",
            other.where,
            "list it under [unused] of one of them",
        )
    if not other.values:
        said = f"{Path(other.where).name} gives no channel: all that it has is unused"
        return replace(
            record, unused={**record.unused, **other.unused}, notes=(*record.notes, said)
        )
    times = since(record.clock, other.clock) + other.clock.seconds + how.shift_s
    rows = record.clock.seconds
    name = Path(other.where).name
    slower = max(_step(rows), _step(times))
    clock, own = record.clock, record.values
    if how.match == "mean":
        width = how.tolerance_s * 2 if how.tolerance_s else slower
        if _step(times) > _step(rows):
            own, counts = _means(rows, own, times, width)
            present = np.any([np.isfinite(values) for values in own.values()], axis=0)
            if not present.any():
                raise _no_match(record, other)
            own = {key: values[present] for key, values in own.items()}
            taken = {key: values[present] for key, values in other.values.items()}
            clock = later(record.clock, times[present])
            said = f"the record has {present.sum()} rows of {name}, with means over {width:g} s"
            averaged = own.keys()
        else:
            taken, counts = _means(times, other.values, rows, width)
            said = f"{name} is taken as means over {width:g} s about each row"
            averaged = taken.keys()
        said += _readings(counts)
        if stated := [key for key in averaged if key in noises]:
            said += f"; the noise that the model states of {quoted(stated)} is that of one reading"
        matched = np.any([np.isfinite(values) for values in taken.values()], axis=0)
    else:
        if how.match == "nearest":
            within = how.tolerance_s or slower / 2 * (1 + 1e-9)
            taken, apart = _nearest(times, other.values, rows, within)
        else:
            within = how.tolerance_s or GAP * _step(times)
            taken, apart = _between(times, other.values, rows, within)
        matched = apart <= within
        furthest = apart[matched].max() if matched.any() else 0.0
        way = "by the row nearest in time" if how.match == "nearest" else "between rows"
        said = f"{name} is matched {way}, in {matched.sum()} of {len(rows)} rows"
        said += f", at most {furthest:g} s away"
    if not matched.any():
        raise _no_match(record, other)
    return LoggerData(
        where=record.where,
        clock=clock,
        values={**own, **taken},
        unused={**record.unused, **other.unused},
        notes=(*record.notes, *(f"{name}: {note}" for note in other.notes), said),
        warnings=(*record.warnings, *(f"{name}: {text}" for text in other.warnings)),
        sha256=sha256((record.sha256 + other.sha256).encode()).hexdigest(),
    )


def _means(
    times: FloatArray, values: dict[str, FloatArray], rows: FloatArray, width: float
) -> tuple[dict[str, FloatArray], NDArray[np.int64]]:
    """Means about each row by channel, and how many readings those have that are there."""
    found = {name: means_about(times, column, rows, width) for name, column in values.items()}
    counts = np.concatenate([number for _, number in found.values()])
    return {name: means for name, (means, _) in found.items()}, counts[counts > 0]


def _readings(counts: NDArray[np.int64]) -> str:
    """In words, of how many readings means are.

    >>> _readings(np.array([7, 7])), _readings(np.array([5, 7, 7]))
    (', of 7 readings each', ', of 5 to 7 readings each')
    """
    if not len(counts):
        return ""
    least, most = int(counts.min()), int(counts.max())
    return f", of {least if least == most else f'{least} to {most}'} readings each"


def _step(times: FloatArray) -> float:
    return float(np.median(np.diff(times))) if len(times) > 1 else 0.0


def _neighbours(times: FloatArray, rows: FloatArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    after = np.searchsorted(times, rows).clip(0, len(times) - 1)
    before = np.where(times[after] <= rows, after, after - 1).clip(0, len(times) - 1)
    return before, after


def _nearest(
    times: FloatArray, values: dict[str, FloatArray], rows: FloatArray, within: float
) -> tuple[dict[str, FloatArray], FloatArray]:
    """Values of the nearest rows, and how far away these are [s]."""
    before, after = _neighbours(times, rows)
    closer = np.abs(times[after] - rows) < np.abs(rows - times[before])
    chosen = np.where(closer, after, before)
    apart = np.abs(times[chosen] - rows)
    taken = {
        name: np.where(apart <= within, column[chosen], np.nan) for name, column in values.items()
    }
    return taken, apart


def _between(
    times: FloatArray, values: dict[str, FloatArray], rows: FloatArray, within: float
) -> tuple[dict[str, FloatArray], FloatArray]:
    """Values between the rows before and after, and how far the further of these is [s]."""
    before, after = _neighbours(times, rows)
    span = times[after] - times[before]
    weight = np.divide(rows - times[before], span, out=np.zeros(len(rows)), where=span > 0)
    apart = np.maximum(np.abs(rows - times[before]), np.abs(times[after] - rows))
    taken = {}
    for name, column in values.items():
        mixed = np.where(
            weight == 0, column[before], (1 - weight) * column[before] + weight * column[after]
        )
        taken[name] = np.where(apart <= within, mixed, np.nan)
    return taken, apart


def _no_match(record: LoggerData, other: LoggerData) -> InputError:
    begins, ends = since(record.clock, other.clock), other.clock.seconds[-1]
    return InputError(
        f"no row of {other.where} lies near one of {record.where}: it begins {begins:g} s after "
        f"it and lasts {ends:g} s",
        other.where,
        "check the times and zones, or give shift_s or tolerance_s",
    )
