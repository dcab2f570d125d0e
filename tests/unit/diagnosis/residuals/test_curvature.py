"""Readings that go with the square of a context, beside twins that go in proportion."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rga
from rga.diagnosis.preparation.prepare import prepare
from rga.diagnosis.residuals.curvature import curves
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.stepwise import settled
from rga.numerics.hysteresis import loop, play
from rga.simulation import Simulator
from rga_bench.diagnosis.design import Draw


def loaded(name: str, folder: Path) -> tuple[rga.Model, rga.Record]:
    Draw.parse(name).case().write(str(folder))
    model = rga.load_model(folder / "model.json")
    return model, rga.load_record(folder / "record.csv", model)


@pytest.fixture(scope="module")
def healthy(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    """A footbridge with nothing wrong, its contexts measured with errors."""
    model, record = loaded("46-single-5-null", tmp_path_factory.mktemp("healthy"))
    data = prepare(model, record, lambda done: None).data
    return settled(Simulator(model), data)


def pattern(healthy: Problem) -> np.ndarray:
    """Over the channels, in deviations of their noise, float[sensors]."""
    return np.random.default_rng(1).normal(size=len(healthy.data.sensors))


def with_response(healthy: Problem, power: int) -> Problem:
    """The bridge with a response of no known shape to a power of the air's temperature."""
    air = healthy.data.belief.centre["air"]
    course = ((air - air.mean()) / air.std()) ** power
    added = 0.5 * np.outer(course, pattern(healthy) * healthy.noise.sigma)
    data = replace(healthy.data, readings=healthy.data.readings + added)
    return settled(healthy.simulator, data)


def test_a_square_is_reported_whatever_its_pattern(healthy: Problem) -> None:
    (found,) = curves(with_response(healthy, 2))
    assert found.words.endswith("square of air")
    assert np.corrcoef(found.sizes, pattern(healthy))[0, 1] > 0.8


@pytest.mark.parametrize("power", [0, 1])
def test_what_is_in_proportion_is_no_curve(healthy: Problem, power: int) -> None:
    assert curves(with_response(healthy, power)) == []


@pytest.mark.parametrize("power", [1, 2])
def test_one_channel_that_bends_with_its_own_reading(healthy: Problem, power: int) -> None:
    shown = healthy.simulated[:, 3]
    course = ((shown - shown.mean()) / shown.std()) ** power
    readings = healthy.data.readings.copy()
    readings[:, 3] += 1.5 * healthy.noise.sigma[3] * course
    problem = settled(healthy.simulator, replace(healthy.data, readings=readings))
    found = [curve for curve in curves(problem) if "should be" in curve.words]
    if power == 1:
        assert found == []
    else:
        (own,) = found
        assert np.abs(own.sizes).argmax() == 3


@pytest.mark.parametrize("slips", [True, False])
def test_a_joint_that_slips_lags_behind_its_force(healthy: Problem, slips: bool) -> None:
    shown = healthy.simulated[:, [3]]
    scaled = (shown - shown.mean()) / shown.std()
    pushed = play(scaled, np.array([1.0])) if slips else scaled
    readings = healthy.data.readings.copy()
    readings[:, 3] += 2.5 * healthy.noise.sigma[3] * pushed[:, 0]
    problem = settled(healthy.simulator, replace(healthy.data, readings=readings))
    found = [curve for curve in curves(problem) if "lag" in curve.words]
    assert len(found) == slips
    assert all(np.abs(one.sizes).argmax() == 3 for one in found)


@pytest.mark.parametrize("slips", [True, False])
def test_noise_that_wanders_is_no_loop(healthy: Problem, slips: bool) -> None:
    """Every channel has a slow part beside its quick noise, which no noise of one rate has."""
    draw = np.random.default_rng(7)
    steps = draw.standard_normal(healthy.data.readings.shape)
    slow = np.zeros_like(steps)
    for row in range(1, len(steps)):
        slow[row] = 0.97 * slow[row - 1] + np.sqrt(1 - 0.97**2) * steps[row]
    shown = healthy.simulated[:, [3]]
    pushed = loop((shown - shown.mean()) / shown.std(), np.array([1.0]))
    added = slow + (2.0 * pushed * np.sign(pattern(healthy)) if slips else 0.0)
    data = replace(healthy.data, readings=healthy.data.readings + added * healthy.noise.sigma)
    found = curves(settled(healthy.simulator, data))
    assert any("lag" in one.words for one in found) == slips


def test_errors_of_a_context_are_no_loop() -> None:
    """They are in the driver and in what is left: of a play they take part, of a loop none."""
    draw = np.random.default_rng(5)
    force, error = np.cumsum(draw.standard_normal(4000)), draw.standard_normal(4000)
    driver = (force / force.std() + 0.3 * error)[:, None]
    assert abs(np.corrcoef(loop(driver, np.array([0.4]))[:, 0], error)[0, 1]) < 0.05
    behind = driver - play(driver, np.array([0.4]))
    assert abs(np.corrcoef(behind[:, 0], error)[0, 1]) > 0.2
