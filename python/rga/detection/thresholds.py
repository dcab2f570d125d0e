"""Thresholds of the statistics, by simulation.

What a reference makes of readings is standard normal whatever the readings were like, so that
streams of normal noise, with as much memory and slow noise as the readings have, stand for all.
Each is watched by statistics whose reference was learned from a baseline of its own, of the length
of the user's: what a reference does not know well is in the thresholds. As many of its readings are
missing as of the user's: then fewer of them tell what is usual, and each row has fewer to judge.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy

from rga.arrays import FloatArray
from rga.detection.baseline.autoregression import predictors
from rga.detection.baseline.baseline_model import Reference, medians
from rga.detection.baseline.slow_noise import SLOW
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
#: variances of sums of scores, over those of independent ones, for which streams are simulated,
#: and the part by which those are larger at most that they stand for
LONG_RUNS = (1.0, 1.25, 1.5, 2.0, 3.0, 5.0)
ABOUT = 0.08
#: shares of missing readings for which streams are simulated; the next larger stands for a share
#: that is larger by so much
GAPS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
BESIDE = 0.05

#: how often a value as large is expected in a stream that hardly has it by chance
HARDLY = 0.05

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

    def beside(self, peaks: FloatArray, rows: int, arl0: float) -> FloatArray:
        """The same, and no lower than what a stream without a change shows and chance does not.

        What sensors miss together, now and then, is in no simulated stream.

        Args:
            peaks: largest values in that stream, float[statistics].
            rows: of it.
            arl0: as above.
        """
        height = (logs(peaks) - self.location) / self.scale
        hardly = height > np.log(rows / self.rows / HARDLY)
        return np.maximum(self.thresholds(arl0), np.where(hardly, peaks, 0.0))

    def chance(self, peaks: FloatArray, rows: int) -> float:
        """Probability that chance alone lifts some statistic so high within so many rows."""
        height = heights(logs(peaks)[None], self.location, self.scale)[0]
        return float(-np.expm1(-np.exp(-height) * rows / self.rows))


class StreamNoise(NamedTuple):
    """What streams without a change are like.

    Attributes:
        sensors: in a row.
        memory: correlation of a reading with the one before.
        long_run: variance that sums have beyond that memory, over that without slow noise.
        missing: share of the readings.
    """

    sensors: int
    memory: float = 0.0
    long_run: float = 1.0
    missing: float = 0.0

    @classmethod
    def like(
        cls, sensors: int, memory: float, long_run: float, missing: float = 0.0
    ) -> "StreamNoise":
        """That which streams are simulated with for readings of such noise."""
        nearest = (one for one in MEMORIES if memory <= one + WITHIN)
        slow = (one for one in LONG_RUNS if long_run <= one * (1.0 + ABOUT))
        gaps = (one for one in GAPS if missing <= one + BESIDE)
        return cls(
            sensors,
            next(nearest, MEMORIES[-1]),
            next(slow, LONG_RUNS[-1]),
            next(gaps, GAPS[-1]),
        )


@lru_cache(maxsize=64)
def calibration(noise: StreamNoise, baseline_rows: int | None, arl0: float, seed: int) -> TailModel:
    """Simulate streams without a change.

    Every statistic has a tail of its own, which gives it a scale of heights: logs of how rare a
    value is. The largest height of all is as rare, but for what statistics have in common. That
    moves it, and is found from streams as a whole, since large values come in clusters.

    Args:
        noise: of the streams.
        baseline_rows: rows that a reference is learned from; None: it is known.
        arl0: rows between false alarms that thresholds will be asked for.
        seed: of the simulation.
    """
    block = int(np.clip(arl0, LEAST_ROWS, MOST_ROWS)) // BLOCKS
    peaks = logs(
        np.concatenate(
            [
                simulated_peaks(noise, baseline_rows, block, np.random.default_rng(sequence))
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
    noise: StreamNoise, baseline_rows: int | None, block: int, generator: np.random.Generator
) -> FloatArray:
    """The largest values of the statistics in the blocks of a stream without a change.

    Args:
        noise, baseline_rows: as above.
        block: rows.
        generator: of random numbers.

    Returns:
        float[BLOCKS, statistics]
    """
    draw = CalibrationNoise(noise, generator)
    if baseline_rows is None:
        reference = Reference.known(noise.sensors)
    else:
        # A memory that had learned of slow noise as well would leave less of it than was found.
        fast, slow = draw.parts(baseline_rows)
        fast = draw.with_gaps(fast)
        reference = Reference.learn(fast + slow, predictors(fast - medians(fast)))
    statistics = reference.statistics(np.full(len(STATISTICS), np.inf), 0)
    peaks = np.empty((BLOCKS, len(STATISTICS)))
    for own in peaks:
        statistics.update_many(draw.rows(block))
        own[:] = statistics.take_peaks()
    return peaks


class CalibrationNoise:
    """A stream of normal noise in which each reading goes with the one before.

    Args:
        noise: what it is like.
        generator: of random numbers.
    """

    def __init__(self, noise: StreamNoise, generator: np.random.Generator) -> None:
        self._noise, self._generator = noise, generator
        # Where sums of slow noise vary as they should, it has this deviation itself.
        self._size = np.sqrt((noise.long_run - 1.0) * (1.0 - SLOW) / (1.0 + SLOW))
        shape = 1, noise.sensors
        self._fast = generator.standard_normal(shape) / np.sqrt(1.0 - noise.memory**2)
        self._steps, self._slow = np.zeros(shape), np.zeros(shape)
        if self._size:
            self._steps = self._size * generator.standard_normal(shape)

    def rows(self, count: int) -> FloatArray:
        """The next rows, float[count, sensors], NaN where missing."""
        fast, slow = self.parts(count)
        return self.with_gaps(fast + slow)

    def with_gaps(self, rows: FloatArray) -> FloatArray:
        """Rows, float[n, sensors], of which readings are missing at random."""
        if not self._noise.missing:
            return rows
        there = self._generator.random(rows.shape) >= self._noise.missing
        return np.where(there, rows, np.nan)

    def parts(self, count: int) -> tuple[FloatArray, FloatArray]:
        """What memory explains of the next rows, and slow noise, float[count, sensors] each."""
        shape, memory = (count, self._noise.sensors), self._noise.memory
        fast, self._fast = remembering(self._generator.standard_normal(shape), memory, self._fast)
        if not self._size:
            return fast, np.zeros(shape)
        steps = self._size * np.sqrt(1.0 - SLOW**2) * self._generator.standard_normal(shape)
        steps, self._steps = remembering(steps, SLOW, self._steps)
        slow, self._slow = remembering(steps, memory, self._slow)
        return fast, slow


def remembering(
    steps: FloatArray, memory: float, before: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Each of steps, float[n, sensors], and so much of what came before; and the last of these.

    Args:
        steps: what is added in each row.
        memory: share of a row that the next one keeps.
        before: the row before them, float[1, sensors].
    """
    if memory == 0.0:
        return steps, before
    found, _ = scipy.signal.lfilter([1.0], [1.0, -memory], steps, axis=0, zi=memory * before)
    return np.asarray(found), np.asarray(found[-1:])


def memory_of(weights: FloatArray) -> float:
    """How much a reading goes with the ones before, in most sensors.

    Args:
        weights: that predict a reading from the ones before, float[order, sensors].
    """
    return float(np.quantile(weights.sum(axis=0), 0.9))
