"""What an alarm is about: which sensors, since when, and what it looks like."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit, logsumexp, softmax

from rga.arrays import FloatArray

Kind = Literal["step", "drift", "variance"]

#: parts of the sensors that may have changed, equally likely
PARTS = (0.02, 0.1, 0.5, 0.95)
#: standard deviation of a step before it is known, in those of a score
STEP = 1.0
#: the same of a drift by the last row
DRIFT = 2.0
#: rows that a drift takes to become so large, at least
SLOW = 50.0
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
            on the standard deviation. Scores are cut where a baseline says no more, so
            that a change beyond some three standard deviations is reported as that large.
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

    @property
    def looks(self) -> str:
        """The kind in words."""
        return "a change of variance" if self.kind == "variance" else f"a {self.kind}"

    def sentence(self, names: tuple[str, ...] | None = None) -> str:
        """The same in words.

        Args:
            names: of the sensors; their columns if left out.
        """
        labels = [names[one] if names else f"sensor {one}" for one in self.sensors]
        more = f" and {len(labels) - SHOWN} more" if len(labels) > SHOWN else ""
        first, last = self.since_ci90
        where = f"{', '.join(labels[:SHOWN])}{more}"
        alone = "; one bad sensor would look like this" if self.single else ""
        return f"{self.looks} in {where} since row {self.since} ({first} to {last}){alone}"


def explain(
    scores: FloatArray,
    first: int,
    row: int,
    raised_by: str,
    sizes: FloatArray,
    signature: FloatArray,
) -> Alarm:
    """Explain an alarm.

    A change of each kind from each row on has a likelihood ratio for each sensor, averaged over
    sizes that are as likely as not; a mixture over which sensors have changed (Xie and Siegmund,
    Annals of Statistics 41, 2013) puts them together, or all have changed alike. All kinds and
    onsets are equally likely, and the interval of the onset holds for all kinds together.

    Args:
        scores: of the latest rows, float[rows, sensors], NaN where missing.
        first: number of the first of these rows in the stream.
        row: that raised the alarm.
        raised_by: statistic that did.
        sizes: readings per score, float[sensors].
        signature: how scores change, with norm 1, when all readings rise alike, float[sensors].
    """
    missing = ~np.isfinite(scores)
    known = np.where(missing, 0.0, scores)
    there = (~missing).astype(float)
    rising = known @ signature[:, None], there @ signature[:, None] ** 2
    onsets = min(len(scores), row - first + 1)
    ratios: dict[Kind, FloatArray] = {
        "step": step_ratio(known, there)[:onsets],
        "drift": drift_ratio(known, there)[:onsets],
        "variance": spread_ratio(known, there)[:onsets],
    }
    mixtures = {kind: mixture(ratio) for kind, ratio in ratios.items()}
    alike: dict[Kind, FloatArray] = {"step": step_ratio(*rising), "drift": drift_ratio(*rising)}
    for kind, ratio in alike.items():
        mixtures[kind] = np.vstack([mixtures[kind], ratio[:onsets].T])
    by_onset = {kind: logsumexp(of_kind, axis=0) for kind, of_kind in mixtures.items()}
    kind = max(by_onset, key=lambda one: float(logsumexp(by_onset[one])))
    onset = int(np.argmax(by_onset[kind]))
    share = np.cumsum(softmax(logsumexp(list(by_onset.values()), axis=0)))
    low, high = np.searchsorted(share, (0.05, 0.95))
    chance = probability(ratios[kind][onset], mixtures[kind][:, onset])
    chance = chance * there[onset:].any(axis=0)
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
        (first + min(int(low), onset), first + min(max(int(high), onset), onsets - 1)),
    )


def since(values: FloatArray) -> FloatArray:
    """Sums of rows from each row to the last."""
    return np.asarray(np.cumsum(values[::-1], axis=0)[::-1])


def step_ratio(scores: FloatArray, there: FloatArray) -> FloatArray:
    """Log-likelihood ratio of a step from each row on, float[rows, sensors]."""
    count, total = since(there), since(scores)
    return normal_ratio(total, count, STEP)


def drift_ratio(scores: FloatArray, there: FloatArray) -> FloatArray:
    """The same of a ramp from 0 at the onset."""
    rows = len(scores)
    number = np.arange(1.0, rows + 1.0)[:, None]
    before = number - 1.0
    # Sums over t of (t - onset + 1) score and (t - onset + 1)^2, from moments about row 0.
    total = since(number * scores) - before * since(scores)
    energy = (
        since(number**2 * there) - 2.0 * before * since(number * there) + before**2 * since(there)
    )
    return normal_ratio(total, energy, DRIFT / np.maximum(rows - before, SLOW))


def normal_ratio(total: FloatArray, energy: FloatArray, size: FloatArray | float) -> FloatArray:
    """Log-likelihood ratio of a shape whose factor is normal with mean 0.

    Args:
        total: sum of the products of shape and scores.
        energy: sum of the squares of the shape.
        size: standard deviation of the factor.
    """
    gained = 1.0 + energy * size**2
    return np.asarray(total**2 * size**2 / (2.0 * gained) - np.log(gained) / 2.0)


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
        mixtures: of an onset, float[parts], and that of all alike if there is one.
    """
    weights = np.exp(mixtures - logsumexp(mixtures))
    chances = expit([np.log(part / (1.0 - part)) + ratios for part in PARTS])
    found = weights[: len(PARTS)] @ chances + weights[len(PARTS) :].sum()
    return np.asarray(np.minimum(found, 1.0))


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
