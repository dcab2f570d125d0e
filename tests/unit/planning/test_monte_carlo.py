"""Drawn readings: how often the true explanation wins, beside what the separation promises."""

import numpy as np
import pytest

from planned_bridge import explained
from rga.experiments.measurement_model import Errors, MeasurementModel
from rga.experiments.separation import Pair, covariance, success
from rga.model import Model
from rga.planning.monte_carlo import Judge, checked
from rga.planning.selection import Chooser


@pytest.fixture(scope="module")
def present(bridge: MeasurementModel, pair: Pair) -> np.ndarray:
    """The first test, read by all sensors that work."""
    mask = np.zeros_like(pair.difference)
    mask[bridge.operating + 1, : bridge.standing] = 1.0
    return mask


def test_the_true_explanation_wins_as_often_as_promised(
    bridge: MeasurementModel, errors: Errors, pair: Pair, present: np.ndarray
) -> None:
    (separation,) = Chooser(bridge, errors, [pair], 5.5).separation([], [1])
    found = checked(bridge, pair.cause, pair.rival, present, 4.6, 0)
    assert found.draws == 100
    assert found.won == pytest.approx(success(float(separation), 0.0), abs=0.15)
    assert found.clearly == pytest.approx(success(float(separation), 4.6), abs=0.2)
    assert found.clearly <= found.won


def test_alike_explanations_win_by_chance(
    bridge: MeasurementModel, pair: Pair, present: np.ndarray
) -> None:
    found = checked(bridge, pair.cause, pair.cause, present, 4.6, 0)
    assert found.clearly == 0.0


def test_the_same_seed_draws_the_same_and_nothing_measured_draws_nothing(
    bridge: MeasurementModel, pair: Pair, present: np.ndarray
) -> None:
    one, again = (checked(bridge, pair.cause, pair.rival, present, 4.6, 3) for _ in range(2))
    assert one == again
    none = checked(bridge, pair.cause, pair.rival, np.zeros_like(present), 4.6, 0)
    assert (none.draws, none.won, none.clearly) == (0, 0.0, 0.0)


def test_evidence_of_an_unknown_that_acts_linearly_is_that_of_the_textbook(
    bridge: MeasurementModel, errors: Errors, pair: Pair, present: np.ndarray
) -> None:
    """-1/2 (r' (C + s s')^-1 r + log det(I + s' C^-1 s)) with s the derivative by the unknown."""
    whole = covariance(errors, present)
    judge = Judge(bridge, pair.rival, present, np.linalg.cholesky(whole))
    predicted = judge.predicted(np.zeros(1))
    slope = judge.predicted(np.array([1e-3])) - predicted
    slope = slope / 1e-3
    residual = 0.4 * slope + np.sqrt(np.diag(whole)) * np.resize([1.0, -1.0, 0.5], len(slope))
    square = residual @ np.linalg.solve(whole + np.outer(slope, slope), residual)
    freedom = np.log1p(slope @ np.linalg.solve(whole, slope))
    assert judge.log_evidence(predicted + residual) == pytest.approx(
        -0.5 * (square + freedom), rel=1e-3
    )


def test_unknowns_that_trade_against_each_other_cost_as_much_as_their_width(
    model: Model, bridge: MeasurementModel, errors: Errors, present: np.ndarray
) -> None:
    """Several unknowns of one effect may go twice as far as their intervals: with S their
    derivatives, -1/2 (r' (C + 4 S S')^-1 r + log det(I + 4 S' C^-1 S)).
    """
    colder = {"kind": "stiffness_temperature", "group": "bottom chord"}
    two = explained(model, colder, rate=(-0.01, 0.002), kink=(-5.0, 2.0))
    whole = covariance(errors, present)
    judge = Judge(bridge, two, present, np.linalg.cholesky(whole))
    predicted = judge.predicted(np.zeros(2))
    slopes = np.stack([(judge.predicted(1e-3 * one) - predicted) / 1e-3 for one in np.eye(2)])
    residual = 0.5 * slopes.sum(0) + 0.1 * np.sqrt(np.diag(whole))
    square = residual @ np.linalg.solve(whole + 4 * slopes.T @ slopes, residual)
    _, freedom = np.linalg.slogdet(np.eye(2) + 4 * slopes @ np.linalg.solve(whole, slopes.T))
    assert judge.log_evidence(predicted + residual) == pytest.approx(
        -0.5 * (square + freedom), rel=1e-3
    )
