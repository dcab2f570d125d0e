"""Rates of false alarms and delays, with 90 % intervals, from courses."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import binomtest, chi2, kstest, t

from rga_bench.detection.watch import Course

#: of all intervals
LEVEL = 0.9
#: of baselines
RESAMPLES = 2000
#: run lengths that cannot be distinguished from the steps between whole numbers
SHORT = 20


@dataclass(frozen=True)
class Arl0:
    """Rows between false alarms.

    Attributes:
        rows: the average; None where nothing alarmed.
        low, high: its interval, exact for exponential run lengths (Epstein and Sobel, Annals of
            Mathematical Statistics 25, 1954); where several streams have one baseline, by a
            bootstrap of baselines. None: there is no such bound.
        alarms: that were counted.
        watched: rows that were watched.
        exponential: chance of run lengths as unlike an exponential as these, were they one
            (Kolmogorov and Smirnov; too large, as the mean is fitted); None of fewer than five, of
            short ones, which are whole numbers, and where streams have a baseline in common.
    """

    rows: float | None
    low: float | None
    high: float | None
    alarms: int
    watched: int
    exponential: float | None


@dataclass(frozen=True)
class Share:
    """Streams without an alarm.

    Attributes:
        share: of all.
        low, high: Wilson's interval; where several streams have one baseline, that of as many
            independent streams as they are worth (Korn and Graubard, Survey Methodology 24, 1998).
        streams: how many.
    """

    share: float
    low: float
    high: float
    streams: int


@dataclass(frozen=True)
class Delay:
    """Rows from the onset to the alarm, the row of the onset counted.

    Attributes:
        mean: over runs without an alarm before the onset; None where there was none.
        low, high: interval of the mean: Student's t, or a bootstrap of baselines where several
            streams have one; None of a single run.
        median: of the same.
        runs: that were counted.
        left_out: runs with an alarm before the onset.
        capped: runs that ended without an alarm; they count as what was watched, so that mean and
            interval are lower bounds.
    """

    mean: float | None
    low: float | None
    high: float | None
    median: float | None
    runs: int
    left_out: int
    capped: int


def arl0(courses: Sequence[Course], limit: float, each: int = 1) -> Arl0:
    """Of streams without a change; `each` in turn have a baseline in common."""
    lengths, alarmed = _lengths(courses, limit)
    rows, alarms = int(lengths.sum()), int(alarmed.sum())
    rest = (1.0 - LEVEL) / 2.0
    if each > 1:
        low, high = _resampled(lengths.reshape(-1, each).sum(1), alarmed.reshape(-1, each).sum(1))
    else:
        low = float(2.0 * rows / chi2.ppf(1.0 - rest, 2 * alarms + 2))
        high = float(2.0 * rows / chi2.ppf(rest, 2 * alarms)) if alarms else None
    return Arl0(
        rows=rows / alarms if alarms else None,
        low=low,
        high=high,
        alarms=alarms,
        watched=rows,
        exponential=None if each > 1 else _exponential(lengths[alarmed], lengths.max(), rows),
    )


def share(courses: Sequence[Course], limit: float, rows: int, each: int = 1) -> Share:
    """Streams without an alarm in so many rows; `each` in turn have a baseline in common."""
    lengths, alarmed = _lengths(courses, limit)
    quiet = ~alarmed | (lengths > rows)
    found, worth = float(quiet.mean()), float(len(quiet))
    if each > 1:
        own = quiet.reshape(-1, each).mean(axis=1)
        variance = own.var(ddof=1) / len(own) if len(own) > 1 else 0.0
        worth = max(found * (1.0 - found) / variance, len(own)) if variance else len(own)
        worth = min(worth, len(quiet))
    interval = binomtest(round(found * worth), round(worth)).proportion_ci(LEVEL, method="wilson")
    return Share(found, float(interval.low), float(interval.high), len(quiet))


def delay(courses: Sequence[Course], limit: float, each: int = 1) -> Delay:
    """Of streams with a change at the onset; `each` in turn have a baseline in common."""
    counted = np.array([course.before <= limit for course in courses])
    left_out = int((~counted).sum())
    if not counted.any():
        return Delay(None, None, None, None, 0, left_out, 0)
    lengths, alarmed = _lengths(courses, limit)
    own = lengths[counted]
    if each > 1:
        rows = np.where(counted, lengths, 0.0).reshape(-1, each).sum(axis=1)
        low, high = _resampled(rows, counted.reshape(-1, each).sum(axis=1))
    else:
        low, high = _mean_interval(own)
    return Delay(
        float(own.mean()), low, high, float(np.median(own)),
        len(own), left_out, int((~alarmed[counted]).sum()),
    )  # fmt: skip


def limit_for(courses: Sequence[Course], rows: float) -> float:
    """The least limit at which streams without a change alarm once in so many rows, or less often.

    Args:
        courses: watched without a ceiling.
        rows: between alarms.

    Raises:
        ArithmeticError: the streams are too short for it.
    """
    limits = np.unique(np.concatenate([course.values for course in courses]))
    low, high = 0, len(limits) - 1
    while low < high:
        middle = (low + high) // 2
        found = arl0(courses, float(limits[middle])).rows
        if found is not None and found < rows:
            low = middle + 1
        else:
            high = middle
    if arl0(courses, float(limits[low])).rows is None:
        raise ArithmeticError(f"no alarm in {sum(one.watched for one in courses)} rows")
    return float(limits[low])


def _lengths(courses: Sequence[Course], limit: float) -> tuple[np.ndarray, np.ndarray]:
    found = [course.length(limit) for course in courses]
    return np.array([rows for rows, _ in found], float), np.array([alarm for _, alarm in found])


def _mean_interval(values: np.ndarray) -> tuple[float | None, float | None]:
    """Of rows, of which there is one at least."""
    mean, count = float(values.mean()), len(values)
    if count < 2:
        return None, None
    reach = float(t.ppf((1.0 + LEVEL) / 2.0, count - 1) * values.std(ddof=1) / np.sqrt(count))
    return max(mean - reach, 1.0), mean + reach


def _resampled(rows: np.ndarray, counts: np.ndarray) -> tuple[float | None, float | None]:
    """Interval of rows over a count, by a bootstrap of baselines; no bound where that is none."""
    generator = np.random.default_rng(0)
    drawn = generator.integers(len(rows), size=(RESAMPLES, len(rows)))
    with np.errstate(divide="ignore", invalid="ignore"):
        found = rows[drawn].sum(axis=1) / counts[drawn].sum(axis=1)
    found[np.isnan(found)] = np.inf
    rest = (1.0 - LEVEL) / 2.0
    low, high = np.quantile(found, [rest, 1.0 - rest], method="inverted_cdf")
    return _finite(low), _finite(high)


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _exponential(lengths: np.ndarray, end: float, rows: int) -> float | None:
    """Of the run lengths that ended before the end, as a truncated exponential."""
    if len(lengths) < 5 or rows < SHORT * len(lengths):
        return None
    rate = len(lengths) / rows
    return float(kstest(np.expm1(-rate * lengths) / np.expm1(-rate * end), "uniform").pvalue)
