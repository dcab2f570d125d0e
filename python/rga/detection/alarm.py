"""What an alarm is about: which sensors, since when, and what it looks like."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from rga.model.parameter import FloatArray

Kind = Literal["step", "drift", "variance"]

#: parts of the sensors that may have changed, equally likely
PARTS = (0.02, 0.1, 0.5, 0.95)
#: standard deviation of a step before it is known, in standard deviations of a score
STEP = 1.0
#: standard deviations of a drift over the rows since its onset, likewise
DRIFT = 2.0
#: factors on the standard deviation, equally likely
SPREADS = (0.25, 0.5, 0.7, 1.4, 2.0, 4.0)
#: named in a sentence
SHOWN = 4


@dataclass(frozen=True)
class Alarm:
    """An alarm, as the rows since the onset explain it so far.

    Attributes:
        row: of the stream that raised it, from 0 on.
        raised_by: statistic that reached its threshold: the scale of the change, and where.
        kind: what the change looks like.
        sensors: that have changed, the clearest first; their columns.
        probability: that each of them has changed.
        change: of their readings by now, in the unit of the readings; of a variance the factor
            on the standard deviation.
        since: row of the likeliest onset.
        since_ci90: rows between which it lies, nine times in ten.
    """

    row: int
    raised_by: str
    kind: Kind
    sensors: tuple[int, ...]
    probability: tuple[float, ...]
    change: tuple[float, ...]
    since: int
    since_ci90: tuple[int, int]

    @property
    def single(self) -> bool:
        """Whether it looks like one bad sensor: no other has changed."""
        return len(self.sensors) == 1

    def sentence(self, names: tuple[str, ...] | None = None) -> str:
        """The same in words.

        Args:
            names: of the sensors; their columns if left out.
        """
        told = [names[one] if names else f"sensor {one}" for one in self.sensors]
        more = f" and {len(told) - SHOWN} more" if len(told) > SHOWN else ""
        first, last = self.since_ci90
        where = f"{', '.join(told[:SHOWN])}{more}"
        alone = "; one bad sensor would look like this" if self.single else ""
        what = "a change of variance" if self.kind == "variance" else f"a {self.kind}"
        return f"{what} in {where} since row {self.since} ({first} to {last}){alone}"


def explain(scores: FloatArray, first: int, row: int, raised_by: str, sizes: FloatArray) -> Alarm:
    """Explain an alarm.

    A change of each kind from each row on has a likelihood ratio for each sensor, averaged over
    sizes that are as likely as not; a mixture over which sensors have changed (Xie and Siegmund,
    Annals of Statistics 41, 2013) puts them together. All kinds and onsets are equally likely.

    Args:
        scores: of the latest rows, float[rows, sensors], NaN where missing.
        first: number of the first of these rows in the stream.
        row: that raised the alarm.
        raised_by: statistic that did.
        sizes: readings per score, float[sensors].
    """
    missing = ~np.isfinite(scores)
    known = np.where(missing, 0.0, scores)
    there = (~missing).astype(float)
    ratios: dict[Kind, FloatArray] = {
        "step": step_ratio(known, there),
        "drift": drift_ratio(known, there),
        "variance": spread_ratio(known, there),
    }
    onsets = min(len(scores), row - first + 1)
    mixtures = {kind: mixture(ratio[:onsets]) for kind, ratio in ratios.items()}
    weight = {kind: float(logsumexp(of_kind)) for kind, of_kind in mixtures.items()}
    kind = max(weight, key=lambda one: weight[one])
    by_onset = logsumexp(mixtures[kind], axis=0)
    share = np.exp(by_onset - logsumexp(by_onset))
    low, high = np.searchsorted(np.cumsum(share), (0.05, 0.95))
    onset = int(np.argmax(share))
    chance = probability(ratios[kind][onset], mixtures[kind][:, onset])
    found = np.flatnonzero(chance > 0.5)
    if not len(found):
        found = np.array([int(np.argmax(chance))])
    found = found[np.argsort(-ratios[kind][onset][found], kind="stable")]
    change = changes(kind, known[onset:, found], there[onset:, found])
    if kind != "variance":
        change = change * sizes[found]
    return Alarm(
        row,
        raised_by,
        kind,
        tuple(found.tolist()),
        tuple(chance[found].tolist()),
        tuple(change.tolist()),
        first + onset,
        (first + int(low), first + min(int(high), onsets - 1)),
    )


def since(values: FloatArray) -> FloatArray:
    """Sums of rows from each row to the last."""
    return np.asarray(np.cumsum(values[::-1], axis=0)[::-1])


def step_ratio(scores: FloatArray, there: FloatArray) -> FloatArray:
    """Log-likelihood ratio of a normal step from each row on, float[rows, sensors]."""
    count, total = since(there), since(scores)
    gained = 1.0 + count * STEP**2
    return np.asarray(total**2 * STEP**2 / (2.0 * gained) - np.log(gained) / 2.0)


def drift_ratio(scores: FloatArray, there: FloatArray) -> FloatArray:
    """The same of a ramp from 0 at the onset; its rate is normal, about `DRIFT` over all rows."""
    rows = len(scores)
    number = np.arange(1.0, rows + 1.0)[:, None]
    before = number - 1.0
    # Sums over t of (t - onset + 1) score and (t - onset + 1)^2, from moments about row 0.
    total = since(number * scores) - before * since(scores)
    energy = (
        since(number**2 * there) - 2.0 * before * since(number * there) + before**2 * since(there)
    )
    rate = DRIFT / (rows - before)
    gained = 1.0 + energy * rate**2
    return np.asarray(total**2 * rate**2 / (2.0 * gained) - np.log(gained) / 2.0)


def spread_ratio(scores: FloatArray, there: FloatArray) -> FloatArray:
    """The same of another standard deviation from each row on."""
    count, squares = since(there), since(scores**2)
    ratios = [squares * (1.0 - factor**-2) / 2.0 - count * np.log(factor) for factor in SPREADS]
    return np.asarray(logsumexp(ratios, axis=0) - np.log(len(SPREADS)))


def mixture(ratios: FloatArray) -> FloatArray:
    """Log-likelihood ratio over all sensors, for each part that may have changed.

    Args:
        ratios: logs, float[onsets, sensors].

    Returns:
        float[parts, onsets].
    """
    return np.stack(
        [np.logaddexp(np.log1p(-part), np.log(part) + ratios).sum(axis=1) for part in PARTS]
    )


def probability(ratios: FloatArray, mixtures: FloatArray) -> FloatArray:
    """That each sensor has changed, float[sensors].

    Args:
        ratios: logs, float[sensors].
        mixtures: of an onset, float[parts].
    """
    weights = np.exp(mixtures - logsumexp(mixtures))
    odds = np.array([np.log(part / (1.0 - part)) + ratios for part in PARTS])
    return np.asarray(weights @ (1.0 / (1.0 + np.exp(-np.clip(odds, -700, 700)))))


def changes(kind: Kind, scores: FloatArray, there: NDArray[np.float64]) -> FloatArray:
    """The change by the last row: of the mean [scores], or the factor on the spread."""
    count = np.maximum(there.sum(axis=0), 1.0)
    if kind == "variance":
        return np.asarray(np.sqrt((scores**2).sum(axis=0) / count))
    if kind == "step":
        return np.asarray(scores.sum(axis=0) / count)
    ramp = np.arange(1.0, len(scores) + 1.0)[:, None]
    energy = (ramp**2 * there).sum(axis=0)
    return np.asarray((ramp * scores).sum(axis=0) / np.maximum(energy, 1.0) * len(scores))
