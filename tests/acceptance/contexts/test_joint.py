"""Rows of the table that know more: the joint posterior, the polished network, the true frame."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from rga.inference.rows import Rows
from rga_bench.contexts.data import CalibrationData, calibration_of
from rga_bench.contexts.evaluation import Evaluation
from rga_bench.contexts.method import Calibrated
from rga_bench.contexts.methods.joint import joint_posterior
from rga_bench.contexts.methods.networks import NETWORKS, learn
from rga_bench.contexts.methods.oracle import oracle_posterior
from rga_bench.contexts.methods.posterior_modes import maximum_posterior
from rga_bench.contexts.methods.refined_network import refined_network
from rga_bench.contexts.score import Score
from rga_bench.contexts.setting import ContextsTask, Sizes

LITTLE = Sizes(source=256, unlabelled=30, test=40)


def known(gap: str) -> CalibrationData:
    found = calibration_of(ContextsTask(3, 0, gap, "same", "", (), LITTLE))
    none = Rows(found.problem.load_tests.contexts[:0], found.problem.load_tests.readings[:0])
    return replace(found, problem=replace(found.problem, load_tests=none))


def scored(calibrated: Calibrated, data: CalibrationData) -> Score:
    return Evaluation(data.test, data.problem.ranges, 30).score(calibrated)


@pytest.fixture(scope="module")
def full() -> CalibrationData:
    return known("all")


def test_the_joint_posterior_comes_near_the_floor(full: CalibrationData) -> None:
    floor = scored(oracle_posterior(full.problem, full.usual.twin), full)
    blind = scored(maximum_posterior(full.problem), full)
    joint = joint_posterior(full.problem)
    found = scored(joint, full)
    assert floor.error is not None
    assert found.error is not None
    assert blind.error is not None
    assert floor.error < found.error < 0.5 * blind.error
    assert found.coverage is not None
    assert np.mean(found.coverage) > 0.65

    # What it has seen again it still knows, and a sensor that lies weighs less.
    recent = full.problem.real[:30].copy()
    recent[:, 5] += 8.0
    again = joint.recalibrated(recent)
    assert (scored(again, full).error or 1.0) < 1.2 * found.error


def test_the_polished_network_leaves_hardly_more_than_the_noise() -> None:
    data = known("noise only")
    found = scored(refined_network(data.problem), data)
    noise = float((data.test.noise**2).mean())
    assert found.rg is not None
    assert found.rg < 1.2 * noise
    assert (found.error or 1.0) < 0.3


def test_nothing_but_load_tests_is_labelled(full: CalibrationData) -> None:
    """The problem holds no context of a measured row; load tests are taken where they are given."""
    fields = set(full.problem.__dataclass_fields__)
    assert fields == {"model", "simulator", "noise", "source", "real", "load_tests", "seed"}
    tests = calibration_of(ContextsTask(3, 0, "all", "same", "", (), LITTLE)).problem.load_tests
    with_tests = replace(full.problem, load_tests=Rows(tests.contexts[:10], tests.readings[:10]))
    few = {"steps": 40, "fine_steps": 10, "reduced_steps": 20, "width": 16}
    short = partial(learn, NETWORKS["source_only"].model_copy(update=few))
    alone, beside = (
        refined_network(problem, short).infer(full.test.readings[:5]).value
        for problem in (full.problem, with_tests)
    )
    np.testing.assert_array_equal(alone, beside)
