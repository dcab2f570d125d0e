"""Thresholds of the statistics, by simulation.

What a reference makes of readings is standard normal whatever the readings were like, so that
streams of normal noise, with as much memory as the readings have, stand for all. Each is watched by
statistics whose reference was learned from a baseline of its own, of the length of the user's: what
a reference does not know well is in the thresholds.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy

from rga.arrays import FloatArray
from rga.detection.baseline.baseline_model import Reference
from rga.detection.statistic import STATISTICS

#: streams, and rows of each at least and at most
STREAMS = 128
LEAST_ROWS, MOST_ROWS = 2_000, 10_000
#: blocks of a stream, whose largest values are looked at
BLOCKS = 20
#: how many of the largest of these values show how a tail falls: a twentieth of all, and a fifth
TAILS = (STREAMS, 4 * STREAMS)
#: a statistic that is as large as it can get has no tail: it raises no alarm
LEAST_SCALE = 0.1
#: correlations with the row before for which streams are simulated
MEMORIES = (0.0, 0.3, 0.6, 0.8, 0.9, 0.95)
#: that stand for readings whose memory is larger by so much at most
WITHIN = 0.05

SHARES = np.array([statistic.share for statistic in STATISTICS])


@dataclass(frozen=True)
class TailModel:
    """How large statistics become by chance: false alarms get rarer with a power of the threshold.

    Where the log of each threshold is location + scale * (height - log(share)), false alarms of all
    statistics together come exp(-height) times in `rows` rows.

    Attributes:
        location, scale: of each statistic, float[statistics].
        rows: of a stream.
    """

    location: FloatArray
    scale: FloatArray
    rows: int

    def thresholds(self, arl0: float) -> FloatArray:
        """Of the statistics, where a false alarm comes once in so many rows on average."""
        found = np.exp(self.location + self.scale * (np.log(arl0 / self.rows) - np.log(SHARES)))
        return np.asarray(np.minimum(found, np.finfo(np.float32).max))

    def chance(self, peaks: FloatArray, rows: int) -> float:
        """Probability that chance alone lifts some statistic so high within so many rows."""
        height = heights(logs(peaks)[None], self.location, self.scale)[0]
        return float(-np.expm1(-np.exp(-height) * rows / self.rows))


@lru_cache(maxsize=64)
def calibration(
    sensors: int, baseline_rows: int | None, memory: float, arl0: float, seed: int
) -> TailModel:
    """Simulate streams without a change.

    Every statistic has a tail of its own, which gives it a scale of heights: logs of how rare a
    value is. The largest height of all is as rare, but for what statistics have in common. That
    moves it, and is found from streams as a whole, since large values come in clusters.

    Args:
        sensors: in a row.
        baseline_rows: rows that a reference is learned from; None: it is known.
        memory: correlation of a reading with the one before.
        arl0: rows between false alarms that thresholds will be asked for.
        seed: of the simulation.
    """
    block = int(np.clip(arl0, LEAST_ROWS, MOST_ROWS)) // BLOCKS
    peaks = logs(
        np.concatenate(
            [
                simulated_peaks(
                    sensors, baseline_rows, memory, block, np.random.default_rng(sequence)
                )
                for sequence in np.random.SeedSequence(seed).spawn(STREAMS)
            ]
        )
    )
    location, scale = tails(peaks)
    largest = heights(peaks, location, scale).reshape(STREAMS, BLOCKS).max(axis=1)
    # Maximum likelihood: the largest of a stream has a Gumbel distribution of scale 1.
    common = -np.log(np.exp(-largest).mean())
    return TailModel(location + scale * common, scale, block * BLOCKS)


def logs(peaks: FloatArray) -> FloatArray:
    """Logarithms of statistics, which are 0 before they are first looked at."""
    return np.asarray(np.log(np.maximum(peaks, 1e-30)))


def tails(peaks: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Location and scale of exponential tails (Hill, Annals of Statistics 3, 1975).

    Scores are cut, and a few baselines are worse than the rest: tails bend. The heavier of two
    looks at a tail is taken.

    Args:
        peaks: logs of the largest values of all blocks, float[STREAMS * BLOCKS, statistics].

    Returns:
        What is exceeded once in a stream, and the mean excess, float[statistics] each.
    """
    ordered = np.sort(peaks, axis=0)
    excess = [(ordered[-count:] - ordered[-count - 1]).mean(axis=0) for count in TAILS]
    return ordered[-STREAMS - 1], np.maximum(np.max(excess, axis=0), LEAST_SCALE)


def heights(peaks: FloatArray, location: FloatArray, scale: FloatArray) -> FloatArray:
    """The largest of all statistics on one scale, float[n]; peaks: logs, float[n, statistics]."""
    return np.asarray(((peaks - location) / scale + np.log(SHARES)).max(axis=1))


def simulated_peaks(
    sensors: int,
    baseline_rows: int | None,
    memory: float,
    block: int,
    generator: np.random.Generator,
) -> FloatArray:
    """The largest values of the statistics in the blocks of a stream without a change.

    Args:
        sensors, baseline_rows, memory: as above.
        block: rows.
        generator: of random numbers.

    Returns:
        float[BLOCKS, statistics]
    """
    draw = CalibrationNoise(sensors, memory, generator)
    if baseline_rows is None:
        reference = Reference.known(sensors)
    else:
        reference = Reference.learn(draw.rows(baseline_rows))
    statistics = reference.statistics(np.full(len(STATISTICS), np.inf), 0)
    peaks = np.empty((BLOCKS, len(STATISTICS)))
    for own in peaks:
        statistics.update_many(draw.rows(block))
        own[:] = statistics.take_peaks()
    return peaks


class CalibrationNoise:
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
        found, self._last = scipy.signal.lfilter(
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
