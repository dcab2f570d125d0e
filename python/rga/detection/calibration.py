"""Thresholds of the statistics, by simulation.

What a reference makes of readings is standard normal whatever the readings were like, so that
streams of normal noise, with as much memory as the readings have, stand for all. Each is watched by
statistics whose reference was learned from a baseline of its own, of the length of the user's: what
a reference does not know well is in the thresholds.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.signal import lfilter
from scipy.stats import gumbel_r

from rga.detection.reference import Reference
from rga.detection.statistic import STATISTICS
from rga.model.parameter import FloatArray

#: streams, and rows of each
STREAMS = 128
ROWS = 10_000
#: rows that are drawn at once
CHUNK = 2_000
#: correlations with the row before for which streams are simulated
MEMORIES = (0.0, 0.3, 0.6, 0.8, 0.9, 0.95)
#: that stand for readings whose memory is larger by so much at most
WITHIN = 0.05


@dataclass(frozen=True)
class Calibration:
    """How large statistics become by chance: the log of the largest has a Gumbel distribution.

    Attributes:
        location, scale: of each statistic in a stream of `rows` rows, float[statistics].
        common: location and scale of all together, in logs of the number of false alarms that a
            value stands for.
        rows: of a stream.
    """

    location: FloatArray
    scale: FloatArray
    common: tuple[float, float]
    rows: int

    def thresholds(self, arl0: float) -> FloatArray:
        """Of the statistics, where a false alarm comes once in so many rows on average."""
        location, scale = self.common
        level = location + scale * np.log(arl0 / self.rows)
        found = np.exp(self.location + self.scale * (level - np.log(SHARES)))
        return np.asarray(np.minimum(found, np.finfo(np.float32).max))

    def chance(self, peaks: FloatArray, rows: int) -> float:
        """Probability that chance alone lifts some statistic so high within so many rows."""
        location, scale = self.common
        height = (joint(peaks[None], self.location, self.scale)[0] - location) / scale
        return float(-np.expm1(-np.exp(-height) * rows / self.rows))


SHARES = np.array([statistic.share for statistic in STATISTICS])


def joint(peaks: FloatArray, location: FloatArray, scale: FloatArray) -> FloatArray:
    """The largest of all statistics on one scale, float[streams]; peaks: float[streams, ...]."""
    heights = (np.log(np.maximum(peaks, 1e-30)) - location) / scale
    return np.asarray((heights + np.log(SHARES)).max(axis=1))


@lru_cache(maxsize=64)
def calibration(
    sensors: int, baseline_rows: int | None, memory: float, arl0: float, seed: int
) -> Calibration:
    """Simulate streams without a change.

    Args:
        sensors: in a row.
        baseline_rows: rows that a reference is learned from; None: it is known.
        memory: correlation of a reading with the one before.
        arl0: rows between false alarms that thresholds will be asked for.
        seed: of the simulation.
    """
    rows = int(np.clip(arl0, CHUNK, ROWS))
    peaks = np.array(
        [
            simulated_peaks(sensors, baseline_rows, memory, rows, np.random.default_rng(sequence))
            for sequence in np.random.SeedSequence(seed).spawn(STREAMS)
        ]
    )
    logs = np.log(np.maximum(peaks, 1e-30))
    # Moments of a Gumbel distribution.
    scale = np.sqrt(6.0) / np.pi * logs.std(axis=0)
    location = logs.mean(axis=0) - np.euler_gamma * scale
    common = gumbel_r.fit(joint(peaks, location, scale))
    return Calibration(location, scale, (float(common[0]), float(common[1])), rows)


def simulated_peaks(
    sensors: int,
    baseline_rows: int | None,
    memory: float,
    rows: int,
    generator: np.random.Generator,
) -> FloatArray:
    """The largest value of each statistic in a stream without a change."""
    draw = Noise(sensors, memory, generator)
    if baseline_rows is None:
        reference = Reference.known(sensors)
    else:
        reference = Reference.learn(draw.rows(baseline_rows))
    statistics = reference.statistics(np.full(len(STATISTICS), np.inf), 0)
    for first in range(0, rows, CHUNK):
        statistics.update_many(draw.rows(min(CHUNK, rows - first)))
    return np.asarray(statistics.take_peaks(), dtype=float)


class Noise:
    """A stream of normal noise in which each reading goes with the one before.

    Args:
        sensors: in a row.
        memory: correlation with the row before.
        generator: of random numbers.
    """

    def __init__(self, sensors: int, memory: float, generator: np.random.Generator) -> None:
        self._memory, self._generator = memory, generator
        self._last = generator.standard_normal((1, sensors)) / np.sqrt(1.0 - memory**2)

    def rows(self, count: int) -> FloatArray:
        """The next rows, float[count, sensors]."""
        steps = self._generator.standard_normal((count, self._last.shape[1]))
        if self._memory == 0.0:
            return steps
        found, self._last = lfilter(
            [1.0], [1.0, -self._memory], steps, axis=0, zi=self._memory * self._last
        )
        self._last = self._last / self._memory
        return np.asarray(found)


def memory_of(weights: FloatArray) -> float:
    """How much a reading goes with the ones before, in most sensors.

    Args:
        weights: that predict a reading from the ones before, float[order, sensors].
    """
    return float(np.quantile(weights.sum(axis=0), 0.9))


def simulated_memory(memory: float) -> float:
    """The memory that streams are simulated with for readings of such memory."""
    return next((one for one in MEMORIES if memory <= one + WITHIN), MEMORIES[-1])
