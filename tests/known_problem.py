"""Records whose noise is white and known, so that evidence has a closed form."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Belief
from rga.diagnosis.noise.covariance import Covariance, RandomEffects
from rga.diagnosis.noise.random_effects import Scatter
from rga.diagnosis.noise.row_covariance import Noise, RowCovariance
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses
from rga.diagnosis.search.laplace import Fit, fit
from rga.diagnosis.search.linearised import Problem, resimulated
from rga.diagnosis.search.stepwise import Alternative, Found


def with_white_noise(posed: Problem, off: FloatArray, sigma: FloatArray | None = None) -> Problem:
    """A record with exact contexts, no scatter and white noise, off the simulation by so much.

    Args:
        posed: about the same rows and sensors.
        off: readings less simulation, float[rows, sensors]; NaN where missing.
        sigma: standard deviation of the noise, float[sensors]; None: as the model states it.
    """
    data, model = posed.data, posed.simulator.model
    if sigma is None:
        sigma = np.array([model.sensors[name].noise for name in data.sensors], dtype=float)
    rows, sensors = off.shape
    none: frozenset[str] = frozenset()
    exact = Belief(data.belief.table, {}, {}, none, none, {})
    seen = np.isfinite(off)
    simulated = data.predict(posed.simulator)
    readings = np.where(seen, simulated + np.nan_to_num(off), 0.0)
    noise = Noise(sigma, np.zeros(sensors), np.zeros(0), sigma)
    of_rows = RowCovariance(noise, data.time, seen, np.zeros((rows, sensors, 0)))
    # One effect that does nothing stands for none.
    nothing = RandomEffects(np.ones((rows, 1)), np.zeros((1, sensors, 1)))
    alone = np.array([-1])
    return replace(
        posed,
        data=replace(data, belief=exact, readings=readings, observed=seen),
        simulated=simulated,
        shift=np.zeros_like(off),
        tails=np.zeros_like(off),
        covariance=Covariance(of_rows, nothing, np.ones(1)),
        noise=noise,
        zero_variance=np.zeros(sensors),
        scatter=Scatter(nothing, alone, alone, np.ones(1)),
        factors=np.zeros((sensors, 0)),
    )


def candidates(problem: Problem, *kinds: str) -> list[Hypothesis]:
    """Hypotheses of some kinds on the model of a problem."""
    everything = hypotheses(problem.simulator.model, problem.data.sensors, ())
    return [one for one in everything if one.name in kinds]


def candidate(problem: Problem, kind: str, **place: Any) -> Hypothesis:
    """The hypothesis of a kind at a place."""
    (found,) = (one for one in candidates(problem, kind) if _at(one.place, place))
    return found


def _at(named: Mapping[str, Any], place: Mapping[str, Any]) -> bool:
    return all(named.get(key) == value for key, value in place.items())


def change_of(problem: Problem, hypothesis: Hypothesis, *z: float) -> FloatArray:
    """What a hypothesis changes of the readings, float[rows, sensors]."""
    simulator = problem.simulator.extended({"hidden": hypothesis.effect(z)})
    return np.asarray(problem.data.predict(simulator) - problem.simulated)


def found_with(
    problem: Problem, causes: Sequence[Hypothesis], rivals: Sequence[Hypothesis] = ()
) -> Found:
    """The end of a search: causes fitted together, rivals in the place of the last of them."""
    base = problem.simulator
    together = _fitted(problem, causes)
    alternatives = []
    for rival in rivals:
        other = _fitted(problem, [*causes[:-1], rival])
        alternatives.append(Alternative(rival, other, together.log_evidence - other.log_evidence))
    without = [_fitted(problem, [o for o in causes if o is not one]) for one in causes]
    odds = tuple(together.log_evidence - one.log_evidence for one in without)
    ranked = tuple(sorted(alternatives, key=lambda one: one.behind))
    none: tuple[Alternative, ...] = ()
    about = resimulated(problem, together.simulator(base), problem.data)
    others = (none,) * (len(causes) - 1)
    return Found(about, together, base, (*others, ranked) if causes else (), odds)


def _fitted(problem: Problem, causes: Sequence[Hypothesis]) -> Fit:
    start = [0.1] * sum(len(one.priors) for one in causes)
    return fit(problem, problem.simulator, causes, start)
