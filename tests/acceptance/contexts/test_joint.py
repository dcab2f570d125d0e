"""Rows of the table that know more: the joint posterior, the polished network, the true frame."""

from dataclasses import replace

import numpy as np
import pytest

from context_problems import coverage, error, inferred, with_rows
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.joint_posterior import JointEstimator
from rga_bench.contexts.data import CalibrationData, calibration_of
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.networks import NETWORKS
from rga_bench.contexts.methods.refined_network import refined_network
from rga_bench.contexts.rows import METHODS
from rga_bench.contexts.setting import ContextsTask, Sizes

LITTLE = Sizes(source=256, unlabelled=30, test=40)
FEW = {"steps": 40, "fine_steps": 10, "reduced_steps": 20, "width": 16}


def known(gap: str, sizes: Sizes = LITTLE) -> CalibrationData:
    return calibration_of(ContextsTask(3, 0, gap, "same", "", (), sizes))


def error_of(learned: ContextEstimator, data: CalibrationData) -> float:
    return error(LearningProblem.of(data.lesson), learned, data.test)


@pytest.fixture(scope="module")
def full() -> CalibrationData:
    return known("all")


@pytest.mark.thorough
def test_the_joint_posterior_comes_near_the_floor(full: CalibrationData) -> None:
    floor = error_of(METHODS["knows the frame"].calibrated(full), full)
    blind = error_of(METHODS["MAP"].calibrated(full), full)
    joint = METHODS["joint posterior"].calibrated(full)
    found = error_of(joint, full)
    assert floor < found < 0.5 * blind
    assert coverage(LearningProblem.of(full.lesson), joint, full.test) > 0.65

    # What it has seen again it still knows, and how far a sensor lies is found.
    real, lies = full.lesson.data.real, 8.0 * (np.arange(84) == 5)
    recent = np.concatenate([real, real[:30] + lies])
    again = joint.refined(with_rows(full.lesson, recent, new=len(real)))
    lying = replace(full.test, readings=full.test.readings + lies)
    assert error_of(again, replace(full, test=lying)) < 1.2 * found


@pytest.mark.thorough
def test_networks_on_the_corrected_twin_gain_by_it() -> None:
    data = known("all", replace(LITTLE, source=1000))
    amortised, alone = (METHODS[name].calibrated(data) for name in ("amortised", "source only"))
    assert amortised.found is not None
    problem = LearningProblem.of(data.lesson)
    assert error_of(amortised, data) < error_of(alone, data)
    assert coverage(problem, alone, data.test) < 0.83 < coverage(problem, amortised, data.test)


@pytest.mark.thorough
def test_the_polished_network_leaves_hardly_more_than_the_noise() -> None:
    data = known("noise only")
    polished = refined_network(data.lesson)
    value = inferred(LearningProblem.of(data.lesson), polished, data.test).value
    left = float(((data.test.readings - polished.simulate(value)) ** 2).mean())
    assert left < 1.2 * float((data.test.noise**2).mean())
    assert error_of(polished, data) < 0.3


@pytest.mark.thorough
def test_nothing_but_load_tests_is_labelled(
    full: CalibrationData, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A lesson holds no context of a measured row; load tests are taken where they are given."""
    monkeypatch.setattr("rga.inference.joint.infer.ROUNDS", 1)
    monkeypatch.setattr("rga.inference.joint.infer.STEPS", 2)
    assert full.lesson.data.real_contexts.shape == (30, 0)
    fields = set(LearningProblem.__dataclass_fields__)
    assert fields == {"model", "simulator", "noise", "source", "real", "load_tests", "seed"}
    tests = full.lesson.load_tests
    assert tests is not None
    short = NETWORKS["source only"].model_copy(update=FEW)
    problem = LearningProblem.of(full.lesson)
    alone, beside = (
        inferred(problem, refined_network(lesson, short), full.test).value
        for lesson in (replace(full.lesson, load_tests=None), full.lesson)
    )
    np.testing.assert_array_equal(alone, beside)

    few = replace(full.lesson, training=full.lesson.training.model_copy(update=FEW))
    scrambled = replace(few, load_tests=replace(tests, contexts=tests.contexts[::-1]))
    alone, beside = (
        METHODS["amortised"].calibrated(replace(full, lesson=lesson)).to_bytes()
        for lesson in (few, scrambled)
    )
    assert alone == beside
    taught, mistaught = (JointEstimator.learn(lesson).to_bytes() for lesson in (few, scrambled))
    assert taught != mistaught
