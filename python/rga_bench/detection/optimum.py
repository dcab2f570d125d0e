"""The optimum of a test that knows a change and in how many sensors it is, but not in which.

The likelihood ratio of a change from row nu on, averaged over all subsets of that many sensors, is
summed over the onsets nu: R_n, the statistic of Shiryaev and Roberts (Pollak, Annals of Statistics
13, 1985; mixtures over subsets: Xie and Siegmund, Annals of Statistics 41, 2013). Its alarm at
R_n >= A has the least delay, up to terms that vanish with the rate of false alarms.
"""

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from rga.arrays import FloatArray
from rga_bench.detection.charts import Method
from rga_bench.detection.faults import Drift, Spread, Step, StreamChange
from rga_bench.detection.watch import Course

OPTIMUM = "optimum"
#: onsets that are kept lie within this many expected delays; what is older has alarmed
REACH = 3.0
#: onsets within an expected delay, at most
FINENESS = 40
#: rows that are worked on at once
BLOCK = 32
#: the limit hardly moves the overshoot, so that few are needed
ROUNDS = 20


def has_optimum(fault: StreamChange) -> bool:
    """Whether the optimum for a fault is known."""
    return isinstance(fault, Step | Drift | Spread)


def expected_delay(fault: StreamChange, sensors: int, arl0: float) -> float:
    """Rows in which the likelihood of the true change grows by all that an alarm needs, roughly."""
    needed = math.log(arl0) + math.log(math.comb(sensors, fault.count))
    if isinstance(fault, Drift):
        return float((6.0 * needed / (fault.count * fault.size**2)) ** (1.0 / 3.0))
    if isinstance(fault, Step):
        return needed / (fault.count * fault.size**2 / 2.0)
    return needed / (fault.count * ((fault.size**2 - 1.0) / 2.0 - math.log(fault.size)))


def _joint(fault: StreamChange, sensors: int) -> bool:
    """Whether all sensors change alike, so that their sum is sufficient."""
    return fault.count == sensors and not fault.signed


class Optimum:
    """log R_n of a stream in white normal noise of variance 1.

    Without a change R_n - n is a martingale, so that an alarm comes after E[R_T] rows on average.

    Args:
        fault: the change: a step, a drift or other noise.
        sensors: in a row.
        arl0: rows between false alarms that a limit is wanted for; sets the reach of the onsets.

    Raises:
        TypeError: there is no optimum for that fault.
    """

    def __init__(self, fault: StreamChange, sensors: int, arl0: float) -> None:
        if not has_optimum(fault):
            raise TypeError(f"no optimum is known for a fault: {fault.name}")
        self._fault, self._sensors = fault, sensors
        self._subsets = math.log(math.comb(sensors, fault.count))
        expected = expected_delay(fault, sensors, arl0)
        self._stride = max(1, int(expected / FINENESS))
        self._kept = 4 + math.ceil(REACH * expected / self._stride)
        #: the likelihood ratio of all sensors depends on their sum only
        self._joint = _joint(fault, sensors)
        width = 1 if self._joint else sensors
        self._rows = 0
        #: sums of the rows before each onset that is kept, and of the rows times their number
        self._onsets = np.zeros(0)
        self._sums = np.zeros((0, 2, width))
        self._sum = np.zeros((2, width))

    def values(self, rows: FloatArray) -> FloatArray:
        """log R_n after each row, float[n].

        Args:
            rows: float[n, sensors].
        """
        blocks = [self._block(rows[at : at + BLOCK]) for at in range(0, len(rows), BLOCK)]
        return np.concatenate([np.zeros(0), *blocks])

    def _block(self, rows: FloatArray) -> FloatArray:
        numbers = self._rows + 1.0 + np.arange(len(rows))
        plain = rows**2 if isinstance(self._fault, Spread) else rows
        if self._joint:
            plain = plain.sum(axis=1, keepdims=True)
        moments = np.stack([plain, plain * numbers[:, None]], axis=1)
        sums = self._sum + np.cumsum(moments, axis=0)
        before = np.concatenate([self._sum[None], sums[:-1]])
        new = (numbers - 1.0) % self._stride == 0.0
        self._onsets = np.concatenate([self._onsets, numbers[new]])
        self._sums = np.concatenate([self._sums, before[new]])
        age = numbers[:, None] - self._onsets + 1.0
        gathered = sums[:, None] - self._sums
        logs = self._mixed(self._single(age[..., None], gathered, self._onsets[:, None]))
        current = (age > 0.0) & (age <= self._kept * self._stride)
        found = np.logaddexp.reduce(np.where(current, logs, -np.inf), axis=1)
        self._rows, self._sum = self._rows + len(rows), sums[-1]
        self._onsets, self._sums = self._onsets[-self._kept :], self._sums[-self._kept :]
        return np.asarray(found + math.log(self._stride))

    def _single(self, age: FloatArray, sums: FloatArray, onsets: FloatArray) -> FloatArray:
        """Log-likelihood ratio of a change in one sensor, or in all: float[n, onsets, width]."""
        fault, plain = self._fault, sums[..., 0, :]
        members = fault.count if self._joint else 1
        if isinstance(fault, Spread):
            return plain * (1.0 - fault.size**-2) / 2.0 - members * age * math.log(fault.size)
        if isinstance(fault, Drift):
            # A ramp of 1, 2, ... from the onset on.
            product = fault.size * (sums[..., 1, :] - (onsets - 1.0) * plain)
            energy = fault.size**2 * age * (age + 1.0) * (2.0 * age + 1.0) / 6.0
        else:
            product, energy = fault.size * plain, fault.size**2 * age
        if fault.signed:
            product = np.logaddexp(product, -product) - math.log(2.0)
        return product - members * energy / 2.0

    def _mixed(self, logs: FloatArray) -> FloatArray:
        """Log of the mean over all subsets, float[n, onsets].

        That is the elementary symmetric polynomial of the ratios over the number of subsets.
        """
        count = self._fault.count
        if count == self._sensors:  # one subset
            return np.asarray(logs.sum(axis=-1))
        largest = logs.max(axis=-1)
        ratios = np.exp(logs - largest[..., None])
        polynomial = np.zeros((count + 1, *largest.shape))
        polynomial[0] = 1.0
        for sensor in range(self._sensors):
            polynomial[1:] += ratios[..., sensor] * polynomial[:-1]
        with np.errstate(divide="ignore"):
            return np.asarray(np.log(polynomial[-1]) + count * largest - self._subsets)


def optimal_limit(courses: Sequence[Course], arl0: float) -> float:
    """The log A at which `Optimum` alarms once in so many rows without a change.

    That takes E[R_T] rows on average, A times the mean of R_T / A. Weighting paths by R_T turns it
    round: the mean of R_T / A without the change is one over the mean of A / R_T with it, which
    needs no false alarms to be waited for. Where one row suffices, A / R_T is too wild for its mean
    to be known: use it where `expected_delay` is more than a few rows, else `limit_for`.

    Args:
        courses: of `Optimum` under its change, watched up to log(arl0).
        arl0: rows between false alarms.

    Raises:
        ArithmeticError: all streams alarm before the change.
    """
    limit = math.log(arl0)
    for _ in range(ROUNDS):
        counted = [course for course in courses if course.before <= limit]
        found = [(course, course.exceeds(limit)) for course in counted]
        over = [course.values[at] - limit for course, at in found if at is not None]
        if not over:
            raise ArithmeticError("every stream has a false alarm before the change")
        limit = math.log(arl0) + math.log(float(np.exp(-np.array(over)).mean()))
    return limit


def optimal(fault: StreamChange, sensors: int, arl0: float) -> Method:
    """The optimum for a fault as a method, without a limit."""
    return Method(OPTIMUM, partial(_made, fault, sensors, arl0), math.log(arl0))


def _made(
    fault: StreamChange, sensors: int, arl0: float, baseline: FloatArray | None, seed: int
) -> Optimum:
    """It knows the noise."""
    return Optimum(fault, sensors, arl0)
