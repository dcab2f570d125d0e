"""The smallest effect that would still have been named.

The record is thought without the effect, and its covariance is taken there: what scatter a large
effect brings with it does not hide a small one.
"""

from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.noise.covariance import Covariance, Reduced
from rga.diagnosis.search.laplace import FARTHEST, extended
from rga.diagnosis.search.linearised import pose
from rga.diagnosis.search.stepwise import Found
from rga.errors import InputError

#: halvings of the range of a parameter, and the step of derivatives by its coordinate
HALVINGS, STEP = 16, 1e-3


@dataclass(frozen=True)
class Least:
    """The smallest effect of a kind at a place that would have been named in these data.

    Attributes:
        share: of the effect that was found, in d' [-].
        value: of its parameter there; None of a cause with several, or one that has no value at
            which it does nothing.
    """

    share: float
    value: float | None


def least_seen(found: Found, number: int) -> Least | None:
    """The smallest effect that would have been named.

    None where even what was found is not larger, and of a cause that has no size.

    Args:
        found: the end of a search.
        number: of the cause.
    """
    try:
        return _least(_Without(found, number))
    except InputError:
        # Without its cause, or with a small one, the structure may be unstable.
        return None


def _least(record: "_Without") -> Least | None:
    if not record.hypothesis.priors:
        # What has no size, such as a swap, is there or not.
        return None
    whole, named = record.odds(record.z), record.named
    if whole.log_odds < named:
        return None
    cost = 0.5 * whole.squared - whole.log_odds
    share = float(np.sqrt(2 * (named + cost) / whole.squared))
    low = record.nothing_at
    if low is None:
        return Least(share, None)
    high = float(record.z[0])
    if record.odds(np.array([low])).log_odds >= named:
        return Least(share, None)
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        seen = record.odds(np.array([middle])).log_odds >= named
        low, high = (low, middle) if seen else (middle, high)
    at_least = record.odds(np.array([high]))
    (prior,) = record.hypothesis.priors.values()
    return Least(float(np.sqrt(at_least.squared / whole.squared)), prior.value(high))


@dataclass(frozen=True)
class _Odds:
    """Log-odds that an effect would have, and its d'^2 beyond what other causes can imitate."""

    log_odds: float
    squared: float


class _Without:
    """A record from which one effect is taken out."""

    def __init__(self, found: Found, number: int) -> None:
        one, self._where = found.fit, found.fit.slices()[number]
        self._found, self.named = found, found.problem.criteria.naming.log_odds
        self.hypothesis, self.z = one.hypotheses[number], one.z[self._where]
        others = [other for k, other in enumerate(one.hypotheses) if k != number]
        simulator = extended(found.base, others, np.delete(one.z, self._where))
        data = found.problem.data
        self._bare = data.predict(simulator)
        readings = data.readings - np.where(data.observed, one.simulated - self._bare, 0.0)
        thought = replace(data, readings=readings)
        self._covariance: Covariance = pose(simulator, thought, found.problem).covariance
        self._others = np.delete(one.signatures, self._where, axis=0)

    @property
    def nothing_at(self) -> float | None:
        """The coordinate at which the effect does nothing; None where no single one says so."""
        marks = self.hypothesis.kind.parameters()
        neutral = [marks[name].neutral for name in self.hypothesis.priors]
        if len(neutral) != 1 or neutral[0] is None:
            return None
        (prior,) = self.hypothesis.priors.values()
        with np.errstate(divide="ignore"):
            return float(np.clip(prior.z(neutral[0]), -FARTHEST, FARTHEST))

    def odds(self, z: FloatArray) -> _Odds:
        """What the effect would earn with its parameters at coordinates z."""
        change = self._change(z)
        own = self._reduced(change[None])
        slopes = [(self._change(z + STEP * along) - change) / STEP for along in np.eye(len(z))]
        each = self._reduced(np.array(slopes))
        information = np.eye(len(z)) + self._covariance.product(each, each)
        squared = float(self._covariance.squares(own)[0])
        if len(self._others):
            beside = self._reduced(self._others.transpose(0, 2, 1))
            across = self._covariance.product(beside, own)[:, 0]
            free = np.eye(len(across)) + self._covariance.product(beside, beside)
            squared -= float(across @ np.linalg.solve(free, across))
        cost = 0.5 * float(z @ z + np.linalg.slogdet(information)[1]) - self.hypothesis.log_prior
        return _Odds(0.5 * squared - cost, squared)

    def _change(self, z: FloatArray) -> FloatArray:
        """What the effect changes of the readings, float[rows, sensors]."""
        one = self._found.fit
        whole = one.z.copy()
        whole[self._where] = z
        simulator = extended(self._found.base, one.hypotheses, whole)
        return np.asarray(self._found.problem.data.predict(simulator) - self._bare)

    def _reduced(self, changes: FloatArray) -> Reduced:
        return self._covariance.reduce(changes.transpose(0, 2, 1))
