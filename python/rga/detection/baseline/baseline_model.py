"""What a stream of readings is like while nothing changes, learned from a baseline record."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtr, ndtri

from rga import _core
from rga.arrays import FloatArray
from rga.detection.baseline.autoregression import predictors
from rga.detection.baseline.decorrelation import independence

#: rows that a sensor must have been read in
FEWEST = 30
#: readings beyond this are faults of their source
MOST = 1e60
#: scores between which the distribution of a reading is followed, and knots there
FOLLOWED = 2.5
KNOTS = 9
#: scores at the knots, and the shares of a normal variable below them
SCORES = np.linspace(-FOLLOWED, FOLLOWED, KNOTS)
SHARES = ndtr(SCORES)
#: mean of a normal variable beyond the outer knot, less the knot
BEYOND = float(np.exp(-(FOLLOWED**2) / 2) / np.sqrt(2 * np.pi) / ndtr(-FOLLOWED)) - FOLLOWED
#: readings beyond the outer knots that weigh as much as what all sensors have in common
TAIL = 20.0
#: readings that differ by less are alike
SMALLEST = 1e-280
#: scores are never beyond this
LARGEST = 6.0
#: a normal variable's standard deviation over its median absolute deviation
ROBUST = 1.4826


@dataclass(frozen=True)
class Reference:
    """From readings to scores: standard normal, independent in time and between sensors.

    Attributes:
        level: of the readings, float[sensors].
        weights: of earlier deviations from the level, the latest first, float[order, sensors].
        units: units per reading, float[sensors].
        offset, slope: score of no deviation, and scores per unit, below all knots, float[sensors].
        knots, bends: where the slope changes [units], and by how much, float[knots, sensors].
        mixing: symmetric; independent scores are this times scores, float[sensors, sensors].
        signature: how independent scores change, with norm 1, when all readings rise alike.
        largest: scores beyond this are cut.
    """

    level: FloatArray
    weights: FloatArray
    units: FloatArray
    offset: FloatArray
    slope: FloatArray
    knots: FloatArray
    bends: FloatArray
    mixing: FloatArray
    signature: FloatArray
    largest: float

    @classmethod
    def known(cls, sensors: int) -> "Reference":
        """Of readings that are scores already."""
        zero, one, none = np.zeros(sensors), np.ones(sensors), np.zeros((0, sensors))
        signature = one / np.sqrt(sensors)
        return cls(zero, none, one, zero, one, none, none, np.eye(sensors), signature, LARGEST)

    @classmethod
    def learn(cls, baseline: FloatArray, weights: FloatArray | None = None) -> "Reference":
        """Learn from readings during which nothing changed.

        Level, memory (autoregression), the distribution of what memory leaves, and what sensors
        have in common, in this order. Outliers have no more weight than other readings.

        Args:
            baseline: float[rows, sensors], NaN where missing; none of the sensors `unwatched`.
            weights: of earlier deviations, where they are known, float[order, sensors].
        """
        level = medians(baseline)
        deviations = baseline - level
        if weights is None:
            weights = predictors(deviations)
        innovations = _core.innovations(deviations, weights)
        units, offset, slope, knots, bends, largest = fit_normal_scores(innovations)
        none = np.eye(len(level))
        plain = cls(
            level, weights, units, offset, slope, knots, bends, none, np.ones(len(level)), largest
        )
        mixing = independence(plain.normal_scores(innovations))
        rise = np.nanstd(deviations, axis=0) * (1.0 - weights.sum(axis=0)) * plain.steepness
        signature = mixing @ rise
        length = np.linalg.norm(signature)
        if length > 0:
            signature = signature / length
        return replace(plain, mixing=mixing, signature=signature)

    @property
    def steepness(self) -> FloatArray:
        """Scores per reading at the median, float[sensors]."""
        inner = self.bends[: (len(self.bends) + 1) // 2].sum(axis=0)
        return np.asarray((self.slope + inner) * self.units)

    @property
    def sizes(self) -> FloatArray:
        """A lasting change of a reading over that of its score, float[sensors]."""
        remembered = 1.0 - self.weights.sum(axis=0)
        return np.asarray(1.0 / (self.steepness * remembered * np.diag(self.mixing)))

    def normal_scores(self, innovations: FloatArray) -> FloatArray:
        """Scores before they are mixed, float[rows, sensors]."""
        return normal_scores(
            innovations * self.units,
            self.offset,
            self.slope,
            self.knots,
            self.bends,
            self.largest,
        )

    def statistics(self, thresholds: FloatArray, rows_kept: int) -> _core.ChangeStatistics:
        """Statistics of change over a stream that is like this."""
        arrays = {
            name: np.ascontiguousarray(getattr(self, name))
            for name in (
                "level", "weights", "units", "offset", "slope", "knots", "bends", "mixing",
                "signature",
            )
        }  # fmt: skip
        return _core.ChangeStatistics(arrays, self.largest, thresholds.tolist(), rows_kept)


def medians(readings: FloatArray) -> FloatArray:
    """Of each column, without what is missing: `nanmedian` takes its time."""
    missing = np.isnan(readings).any()
    return np.asarray(np.nanmedian(readings, axis=0) if missing else np.median(readings, axis=0))


def fit_normal_scores(
    innovations: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray, float]:
    """A function of the readings of each sensor, linear between knots, whose values are normal.

    Between the outer knots it follows the quantiles. Beyond, it has the slope that gives the mean
    of what lies there its normal value, drawn to that of all sensors where little lies there.

    Args:
        innovations: float[rows, sensors], NaN where missing.

    Returns:
        Units per reading, offset, slope, knots [units], bends, and the largest score that a
        baseline of this length can show.
    """
    ordered = np.sort(innovations, axis=0)  # NaN last
    count = np.isfinite(innovations).sum(axis=0)
    low, high = at_ranks(ordered, count, np.array([0.25, 0.75]))
    spread = (high - low) / (2.0 * ndtri(0.75))
    spread = np.where(spread > 0, spread, np.nanstd(innovations, axis=0))
    units = 1.0 / spread
    knots = at_ranks(ordered, count, SHARES) * units
    # Readings of few digits repeat: knots stay apart.
    least = 1e-3 * np.arange(KNOTS)[:, None]
    knots = np.maximum.accumulate(knots - least, axis=0) + least
    inner = np.diff(SCORES)[:, None] / np.diff(knots, axis=0)
    below = outer_slope(-innovations * units, -knots[0], count)
    above = outer_slope(innovations * units, knots[-1], count)
    slopes = np.concatenate([below[None], inner, above[None]])
    bends = np.diff(slopes, axis=0)
    # At the first knot the score is the first of the scores; max(units, knot) is the knot below it.
    offset = SCORES[0] - slopes[0] * knots[0] - (bends * knots).sum(axis=0)
    largest = min(LARGEST, float(ndtri(1.0 - 0.5 / np.median(count))))
    found = normal_scores(innovations * units, offset, slopes[0], knots, bends, largest)
    mean, rms = np.nanmean(found, axis=0), np.nanstd(found, axis=0)
    return units, (offset - mean) / rms, slopes[0] / rms, knots, bends / rms, largest


def normal_scores(
    units: FloatArray,
    offset: FloatArray,
    slope: FloatArray,
    knots: FloatArray,
    bends: FloatArray,
    largest: float,
) -> FloatArray:
    """Scores of readings in units, float[rows, sensors]."""
    found = offset + slope * units
    for knot, bend in zip(knots, bends, strict=True):
        found = found + bend * np.maximum(units, knot)
    return np.asarray(np.clip(found, -largest, largest))


def at_ranks(ordered: FloatArray, count: FloatArray, shares: FloatArray) -> FloatArray:
    """Quantiles of each column by linear interpolation of ranks (Hazen), float[shares, sensors]."""
    place = np.clip(count * shares[:, None] - 0.5, 0.0, count - 1.0)
    low = np.floor(place).astype(int)
    high = np.minimum(low + 1, count - 1)
    columns = np.arange(ordered.shape[1])
    left, right = ordered[low, columns], ordered[high, columns]
    return np.asarray(left + (place - low) * (right - left))


def outer_slope(units: FloatArray, knot: FloatArray, count: FloatArray) -> FloatArray:
    """Scores per unit above the last knot, float[sensors]."""
    beyond = np.where(units > knot, units - knot, np.nan)
    number = np.isfinite(beyond).sum(axis=0)
    excess = np.where(number > 0, np.nansum(beyond, axis=0) / np.maximum(number, 1), np.nan)
    own = BEYOND / excess
    common = float(np.nanmedian(own)) if np.isfinite(own).any() else 1.0
    weight = number / (number + TAIL)
    return np.asarray(common + weight * (np.where(np.isfinite(own), own, common) - common))


def unwatched(baseline: FloatArray) -> dict[int, str]:
    """Sensors of which a baseline says too little, and why.

    Args:
        baseline: float[rows, sensors], NaN where missing.
    """
    known = np.isfinite(baseline)
    count = known.sum(axis=0)
    lowest = np.where(known, baseline, np.inf).min(axis=0, initial=np.inf)
    highest = np.where(known, baseline, -np.inf).max(axis=0, initial=-np.inf)
    few = {
        int(sensor): f"it has {count[sensor]} readings in the baseline, fewer than {FEWEST}"
        for sensor in np.flatnonzero(count < FEWEST)
    }
    alike = np.flatnonzero((count >= FEWEST) & ~(highest - lowest > SMALLEST))
    return few | {int(sensor): "its readings in the baseline are all alike" for sensor in alike}
