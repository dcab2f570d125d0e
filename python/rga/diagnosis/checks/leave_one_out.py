"""What the findings rest on: the tests that a sceptic would put to a cause.

All of it follows from the end of the search, and is worked out when a report asks for it.
"""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.checks.explanations import (
    hiding,
    left_open,
    sensor_groups,
    unseen_variance,
)
from rga.diagnosis.search.laplace import Fit, fit, refit
from rga.diagnosis.search.stepwise import Found, without_cause
from rga.model.parameter import listed

#: channels that are left out one by one, at most: those that the cause changes most
MOST_LEFT_OUT = 12


@dataclass(frozen=True)
class Contrast:
    """A cause against its nearest alternative, on the channels where the two differ most.

    Attributes:
        against: the alternative's effect as fitted: kind and parameters.
        lead: log-odds of the cause over it, all channels counted.
        channels: names, the one that separates them best first.
        time: of the rows [s], float[rows].
        measured: readings less what the alternative predicts, float[rows, channels]; NaN where
            missing.
        predicted: prediction of the cause less that of the alternative, float[rows, channels].
        size: root mean square of `predicted` over the channel's noise [-], float[channels].
    """

    against: Fit
    lead: float
    channels: list[str]
    time: FloatArray
    measured: FloatArray
    predicted: FloatArray
    size: FloatArray


@dataclass(frozen=True)
class Unseen:
    """A group of channels predicted by what was fitted to all the others.

    Attributes:
        group: its name.
        channels: names.
        measured, without, with_causes: readings, and their prediction by the model as it was
            given and by the causes, float[rows, channels]; NaN where nothing was measured.
        left_open: standard deviation of the prediction by the causes, from what the other
            channels do not know of them, float[rows, channels].
        gap_without, gap_with: mean squared residual over the variance of the prediction [-].
    """

    group: str
    channels: list[str]
    measured: FloatArray
    without: FloatArray
    with_causes: FloatArray
    left_open: FloatArray
    gap_without: float
    gap_with: float


@dataclass(frozen=True)
class Hold:
    """What a cause's lead hangs on.

    Attributes:
        channel: the one whose loss costs the cause most.
        left: log-odds that are left to the cause without that channel.
        alone: True where they are against leaving the cause out, False against its nearest
            alternative.
    """

    channel: str
    left: float
    alone: bool


def contrast(found: Found, number: int, most: int = 3) -> Contrast | None:
    """A cause against its nearest alternative; None where it has none."""
    if not found.alternatives[number]:
        return None
    nearest = found.alternatives[number][0]
    problem = found.problem
    seen = problem.data.observed
    apart = np.where(seen, found.fit.simulated - nearest.fit.simulated, np.nan)
    size = _root_mean_square(apart) / problem.noise.sigma
    columns = np.argsort(-size, kind="stable")[:most]
    measured = np.where(seen, problem.whole_residual(nearest.fit.simulated), np.nan)
    return Contrast(
        against=nearest.fit,
        lead=found.fit.log_evidence - nearest.fit.log_evidence,
        channels=[problem.data.sensors[k] for k in columns],
        time=problem.data.time,
        measured=measured[:, columns],
        predicted=apart[:, columns],
        size=size[columns],
    )


def unseen_groups(found: Found) -> list[Unseen]:
    """Every group of like channels, predicted without it; none where there is one group only."""
    problem, base, causes = found.problem, found.base, found.fit
    groups = sensor_groups(base.model, problem.data.sensors)
    if len(groups) < 2 or not causes.hypotheses:
        return []
    nothing = fit(problem, base, [], [])
    words = []
    for word, names in groups.items():
        part = hiding(problem, names)
        (blind,) = refit(part, base, [causes])
        columns = [problem.data.sensors.index(name) for name in names]
        seen = problem.data.observed[:, columns]
        if not seen.any():
            continue
        readings = problem.data.readings[:, columns]
        spread = unseen_variance(problem, part, columns)
        predicted = [
            problem.with_contexts(one.simulated, part)[:, columns] for one in (nothing, blind)
        ]
        gaps = [
            (readings - shown) ** 2 / (spread + left_open(one, columns))
            for one, shown in zip((nothing, blind), predicted, strict=True)
        ]
        words.append(
            Unseen(
                group=word,
                channels=list(names),
                measured=np.where(seen, readings, np.nan),
                without=predicted[0],
                with_causes=predicted[1],
                left_open=np.sqrt(left_open(blind, columns)),
                gap_without=float(gaps[0][seen].mean()),
                gap_with=float(gaps[1][seen].mean()),
            )
        )
    return words


def hold(found: Found, number: int) -> Hold | None:
    """The one channel that a cause hangs on most; None where there is no other than its own.

    Channels are left out in turn, and the cause is weighed again: against leaving it out and
    against its nearest alternative.
    """
    problem, base, causes = found.problem, found.base, found.fit
    nothing = without_cause(problem, base, causes, number)
    nearest = found.alternatives[number][0].fit if found.alternatives[number] else nothing
    apart = [
        np.abs(causes.simulated - other.simulated).max(0) / problem.noise.sigma
        for other in (nothing, nearest)
    ]
    worth = np.argsort(-np.max([one / max(one.max(), 1e-300) for one in apart], axis=0))
    own = _own_channels(found, number)
    holds = []
    for sensor in (problem.data.sensors[k] for k in worth[:MOST_LEFT_OUT]):
        if sensor in own:
            continue
        part = hiding(problem, [sensor])
        others = [nothing] if nearest is nothing else [nothing, nearest]
        again, *against = refit(part, base, [causes, *others])
        for other, one in zip(others, against, strict=True):
            left = again.log_evidence - one.log_evidence
            holds.append(Hold(sensor, left, other is nothing))
    return min(holds, key=lambda one: one.left, default=None)


def _own_channels(found: Found, number: int) -> set[str]:
    """Channels that a cause is about: without them nothing is left to weigh."""
    one = found.fit.hypotheses[number]
    if not one.kind.at_sensors():
        return set()
    return {name for place in one.place.values() for name in listed(place)}


def _root_mean_square(values: FloatArray) -> FloatArray:
    """By column, of what is there; zero where nothing is."""
    seen = np.isfinite(values)
    return np.asarray(
        np.sqrt((np.where(seen, values, 0.0) ** 2).sum(0) / np.maximum(seen.sum(0), 1))
    )
