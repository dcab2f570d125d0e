"""Rows of another logger, matched to those of a record."""

from hashlib import sha256
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.logger_data import LoggerData, check_alike, later, since
from rga.records.mapping import Beside

#: usual steps between two rows, beyond which nothing is put between them
GAP = 1.5


def side_by_side(record: LoggerData, other: LoggerData, how: Beside) -> LoggerData:
    """A record with the channels of another logger.

    Args:
        record: whose rows are kept, unless means are taken on the rows of a slower logger.
        other: the other logger.
        how: rows are matched.

    Raises:
        InputError: both have a channel, their times cannot be compared, or no row matches.
    """
    check_alike(record, other)
    if both := record.values.keys() & other.values.keys():
        name = sorted(both)[0]
        raise InputError(
            f"{record.where} and {other.where} both give {name!r}",
            other.where,
            "list it under [unused] of one of them",
        )
    times = since(record.clock, other.clock) + other.clock.seconds + how.shift_s
    rows = record.clock.seconds
    slower = max(_step(rows), _step(times))
    name = Path(other.where).name
    clock, own = record.clock, record.values
    if how.match == "mean":
        width = how.tolerance_s * 2 if how.tolerance_s else slower
        if _step(times) > _step(rows):
            inside = (times >= rows[0] - width / 2) & (times <= rows[-1] + width / 2)
            if not inside.any():
                raise _no_match(record, other)
            grid = times[inside]
            own = {key: _means(rows, values, grid, width) for key, values in own.items()}
            taken = {key: values[inside] for key, values in other.values.items()}
            clock = later(record.clock, grid)
            said = f"the record has the {len(grid)} rows of {name}, with means over {width:g} s"
        else:
            taken = {
                key: _means(times, values, rows, width) for key, values in other.values.items()
            }
            said = f"{name} is taken as means over {width:g} s about each row"
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


def _means(times: FloatArray, values: FloatArray, grid: FloatArray, width: float) -> FloatArray:
    """Means of the values there are within half a width of every row of a grid, else NaN.

    >>> _means(np.arange(6.0), np.array([0, 1, 2, np.nan, 4, 5]), np.array([1.0, 3.0, 9.0]), 3.0)
    array([ 1.,  3., nan])
    """
    held = np.isfinite(values)
    # About a middle, sums lose no digits.
    middle = float(np.mean(values[held])) if held.any() else 0.0
    sums = np.concatenate([[0.0], np.cumsum(np.where(held, values - middle, 0.0))])
    counts = np.concatenate([[0], np.cumsum(held)])
    first = np.searchsorted(times, grid - width / 2, side="left")
    last = np.searchsorted(times, grid + width / 2, side="left")
    number = counts[last] - counts[first]
    total = sums[last] - sums[first]
    means = np.divide(total, number, out=np.full(len(grid), np.nan), where=number > 0)
    return np.asarray(means + middle)


def _no_match(record: LoggerData, other: LoggerData) -> InputError:
    begins, ends = since(record.clock, other.clock), other.clock.seconds[-1]
    return InputError(
        f"no row of {other.where} lies near one of {record.where}: it begins {begins:g} s after "
        f"it and lasts {ends:g} s",
        other.where,
        "check the times and zones, or give shift_s or tolerance_s",
    )
