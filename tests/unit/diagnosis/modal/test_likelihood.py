"""The likelihood of measured modes is that of a dense covariance."""

from dataclasses import replace

import numpy as np
import pytest

from independent.modal_bridge import Hidden, Parked, measured
from rga.diagnosis.modal.fit import fitted
from rga.diagnosis.modal.likelihood import (
    CHANGE_ERROR,
    LEVELS,
    MODEL_ERROR,
    USUALLY,
    ModalLikelihood,
    standing_errors,
)
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.model.effects.members.elastic_modulus import ElasticModulus
from rga.simulation.modal.mixed_shapes import apart


@pytest.fixture(scope="module")
def likelihood() -> ModalLikelihood:
    model, record = measured(3, Hidden(), modes=4, windows=25)
    return ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))


def dense(likelihood: ModalLikelihood, mode: int, change: float) -> np.ndarray:
    """Covariance of the windows in which a mode was found."""
    readings = likelihood.readings
    seen = np.flatnonzero(np.isfinite(readings.log_f[:, mode]))
    steps = np.abs(seen[:, None] - seen)
    noise = readings.scatter[mode] ** 2 * readings.memory[mode] ** steps
    return np.asarray(noise + likelihood.level**2 + (CHANGE_ERROR * change) ** 2)


def shape(
    likelihood: ModalLikelihood, mode: int, prediction: Prediction
) -> tuple[np.ndarray, np.ndarray]:
    """What of a measured shape is not along the predicted one, and its covariance."""
    look = likelihood.readings.looks[mode]
    own = likelihood.trials.at_points(prediction.shapes[[mode]])[0, look.at]
    off, parts = apart(look.shape, own, prediction.parts[mode])
    spread = likelihood.shape_spread(mode) ** 2 * np.eye(len(off))
    return off, spread + parts.T @ parts


def at_points(
    likelihood: ModalLikelihood, mode: int, prediction: Prediction
) -> tuple[np.ndarray, np.ndarray]:
    """A measured shape, and the covariance of what mixtures of modes and sensors make of it."""
    errors, look = likelihood.trials.point_errors, likelihood.readings.looks[mode]
    parts = prediction.mixing[mode][:, None] * prediction.recorded[:, look.at]
    return look.shape, parts.T @ parts + errors.spread**2 * np.eye(len(look.at))


@pytest.mark.parametrize("factor", [1.0, 0.8])
def test_squares_and_freedom_are_those_of_the_dense_covariance(
    likelihood: ModalLikelihood, factor: float
) -> None:
    softer = {"e": ElasticModulus(material="steel", factor=factor)} if factor != 1.0 else {}
    prediction, nothing = (likelihood.trials.predict(one) for one in (softer, {}))
    square, freedom = 0.0, 0.0
    for mode in range(len(likelihood.readings.modes)):
        off = likelihood.readings.log_f[:, mode] - prediction.log_f[:, mode]
        off = off[np.isfinite(off)]
        change = float((prediction.log_f - nothing.log_f)[0, mode])
        own, without = dense(likelihood, mode, change), dense(likelihood, mode, 0.0)
        square += float(off @ np.linalg.solve(own, off))
        freedom += 0.5 * float(np.linalg.slogdet(own)[1] - np.linalg.slogdet(without)[1])
        (off, own), (_, without) = (shape(likelihood, mode, one) for one in (prediction, nothing))
        square += float(off @ np.linalg.solve(own, off))
        freedom += 0.5 * float(np.linalg.slogdet(own)[1] - np.linalg.slogdet(without)[1])
        off, own = at_points(likelihood, mode, prediction)
        square += float(off @ np.linalg.solve(own, off))
    residual = likelihood.residual(prediction)
    np.testing.assert_allclose(residual @ residual, square, rtol=1e-9)
    np.testing.assert_allclose(likelihood.freedom(prediction), freedom, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("error", [0.0, 0.015, 0.04])
def test_the_level_is_the_likeliest_of_a_dense_covariance(
    likelihood: ModalLikelihood, error: float
) -> None:
    readings = likelihood.readings
    exact = likelihood.trials.predict({})
    signs = np.resize([1.0, -1.0], len(readings.modes))
    off = readings.log_f + error * signs
    there = ModalLikelihood(ModalTrials(likelihood.trials.model, replace(readings, log_f=off)))
    costs = []
    for level in LEVELS:
        cost = 0.5 * (np.log(level / MODEL_ERROR) / np.log(USUALLY)) ** 2
        for mode in range(len(readings.modes)):
            own = dense(there.with_level(level), mode, 0.0)
            left = (off - exact.log_f)[:, mode]
            left = left[np.isfinite(left)]
            cost += 0.5 * float(left @ np.linalg.solve(own, left) + np.linalg.slogdet(own)[1])
        costs.append(cost)
    level = there.likeliest_level(exact)
    assert level == LEVELS[int(np.argmin(costs))]
    assert level == MODEL_ERROR if error == 0.0 else 0.6 * error < level < 1.4 * error


@pytest.fixture(scope="module")
def with_truck() -> ModalLikelihood:
    truck = Parked({"b3n": 1000.0, "b3s": 1000.0}, (10, 25))
    model, record = measured(3, Hidden(), modes=4, windows=25, parked=truck)
    return ModalLikelihood(ModalTrials(model, ModalReadings.of(model, record)))


def test_where_a_truck_stands_is_no_weather(with_truck: ModalLikelihood) -> None:
    readings, trials = with_truck.readings, with_truck.trials
    assert list(readings.contexts) == ["truck"]
    assert readings.weather == {}
    np.testing.assert_allclose(trials.by_standing[:10], 0.0, atol=1e-12)
    assert (trials.by_standing[10:] < 0.0).all()
    # The bridge without it is the one in which it does not stand.
    prediction = trials.predict({})
    moved = prediction.log_f[-1] - prediction.log_f[0]
    np.testing.assert_allclose(trials.by_standing[-1], moved, atol=1e-12)


def test_what_a_truck_changes_is_known_to_a_share_of_it(with_truck: ModalLikelihood) -> None:
    prediction = with_truck.trials.predict({})
    errors = standing_errors(with_truck.trials.by_standing)
    square = 0.0
    for mode in range(4):
        off = with_truck.readings.log_f[:, mode] - prediction.log_f[:, mode]
        seen = np.isfinite(off)
        own = dense(with_truck, mode, 0.0) + np.outer(errors[seen, mode], errors[seen, mode])
        square += float(off[seen] @ np.linalg.solve(own, off[seen]))
        square += float((with_truck.shape_off(mode, prediction) ** 2).sum())
        off, own = at_points(with_truck, mode, prediction)
        square += float(off @ np.linalg.solve(own, off))
    residual = with_truck.residual(prediction)
    np.testing.assert_allclose(residual @ residual, square, rtol=1e-9)


def test_shape_error_is_what_mac_lacks(likelihood: ModalLikelihood) -> None:
    prediction = likelihood.trials.predict({})
    alone = replace(prediction, parts=tuple(one[:0] for one in prediction.parts))
    for mode in range(len(likelihood.readings.modes)):
        off = likelihood.shape_off(mode, alone) * likelihood.shape_spread(mode)
        np.testing.assert_allclose(off @ off, 1.0 - prediction.mac[mode], atol=1e-12)


def test_a_hidden_mode_counts_for_nothing(likelihood: ModalLikelihood) -> None:
    prediction = likelihood.trials.predict({})
    whole = likelihood.residual(prediction)
    parts = [likelihood.hiding(mode).residual(prediction) for mode in range(4)]
    total = sum(float(part @ part) for part in parts)
    np.testing.assert_allclose(total, 3.0 * float(whole @ whole), rtol=1e-12)


def test_nothing_has_no_evidence(likelihood: ModalLikelihood) -> None:
    assert fitted(likelihood, [], []).log_evidence == 0.0
