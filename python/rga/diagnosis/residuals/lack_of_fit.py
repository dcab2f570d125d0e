"""Lack of fit: what a model misses beyond noise, contexts' errors and a plausible scatter.

A record that a model explains leaves residuals of the size of the noise on rows that no step saw,
and no channel, nor group of like channels, answers more or less than simulated by more than
members and gauges of a sound structure scatter. That scatter is bounded by a stated one: what is
estimated from the record alone would take up any defect.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.noise.random_effects import MEDIANS, lines
from rga.diagnosis.search.linearised import Problem

#: percents beyond which nobody reads them as such
TIMES = 1000.0


@dataclass(frozen=True)
class Misfit:
    """Channels that answer more or less than a model says.

    Attributes:
        group: name of the group, or of the channel.
        channels: names.
        percent: how much more they read than simulated [%].
        deviations: the same over what noise, contexts and plausible scatter make of it [-].
    """

    group: str
    channels: tuple[str, ...]
    percent: float
    deviations: float

    @property
    def alone(self) -> bool:
        """True of a single channel."""
        return self.channels == (self.group,)

    @property
    def words(self) -> str:
        """What is off and by how much."""
        what = "channel" if self.alone else "group"
        off = f"{self.percent:+.0f} % against the model"
        if self.percent > TIMES:
            off = f"{1 + self.percent / 100:.0f} times what the model says"
        return (
            f"{what} {self.group} reads {off}, "
            f"{abs(self.deviations):.1f} times what noise and a plausible scatter of members and "
            "gauges allow"
        )


def misfits(
    problem: Problem, simulated: FloatArray, groups: Mapping[str, Sequence[str]]
) -> list[Misfit]:
    """Channels and groups of like channels that a model misses, the worst first.

    Args:
        problem: gives the residual, the noise and how members and gauges act.
        simulated: by the model, float[rows, sensors].
        groups: names of like channels by the name of the group.
    """
    sensors = problem.data.sensors
    single = {name: (name,) for name in sensors}
    several = {word: tuple(names) for word, names in groups.items() if len(names) > 1}
    residual = problem.residual(simulated)
    found = []
    for word, names in {**single, **several}.items():
        columns = [sensors.index(name) for name in names]
        weight = _weight(problem, simulated, columns)
        if weight is None:
            continue
        off = float((weight * residual[:, columns]).sum())
        spread = float(np.sqrt(_variance(problem, weight, columns)))
        if abs(off) > problem.criteria.fit.deviations * spread:
            found.append(Misfit(word, names, 100 * off, off / spread))
    return sorted(found, key=lambda one: -abs(one.deviations))


def _weight(problem: Problem, simulated: FloatArray, columns: list[int]) -> FloatArray | None:
    """What a residual is multiplied by to give the share by which channels read too much.

    float[rows, columns]; None where nothing is simulated.
    """
    seen = problem.data.observed[:, columns]
    shown = np.where(seen, simulated[:, columns], 0.0) / problem.noise.sigma[columns] ** 2
    power = float((shown * simulated[:, columns]).sum())
    return shown / power if power > 0 else None


def _variance(problem: Problem, weight: FloatArray, columns: list[int]) -> float:
    """Variance of the weighted sum of a sound record's residual."""
    noise, rows = problem.noise, problem.covariance.rows
    long_run = noise.sigma**2 * (1 + noise.phi) / (1 - noise.phi)
    own = float((weight**2).sum(0) @ long_run[columns])
    measured = [
        number
        for number, name in enumerate(problem.data.belief.spread)
        if name not in problem.data.belief.latent
    ]
    derivatives = rows.context_jacobian[:, columns][:, :, measured]
    of_rows = np.einsum("tc,tcj->tj", weight, derivatives)
    of_contexts = float(((of_rows * noise.context_sigma[measured]) ** 2).sum())
    effects, plausible = problem.covariance.scatter, problem.criteria.fit.plausible
    spread = problem.scatter.spread(np.clip(problem.levels, MEDIANS, plausible))
    # Where a train stands was fitted with the rest: its prior is no uncertainty any more.
    spread[len(spread) - len(lines(problem.data)) :] = 0.0
    along = weight.T @ effects.courses
    shares = np.tensordot(effects.shares[:, columns], along, 2)
    return own + of_contexts + float(((shares * spread) ** 2).sum())
