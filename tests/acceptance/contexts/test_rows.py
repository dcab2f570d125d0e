"""Every row of the table learns, and looks at no label that is not its own."""

from collections.abc import Callable
from dataclasses import replace
from inspect import unwrap

import numpy as np
import pytest

from context_methods import NEEDS, UNLABELLED
from context_problems import error
from rga_bench.contexts.data import CalibrationData, calibration_of
from rga_bench.contexts.method import Estimate, LearningProblem
from rga_bench.contexts.methods.networks import NETWORKS
from rga_bench.contexts.methods.refined_network import refined_network
from rga_bench.contexts.rows import METHODS, Row, amortised
from rga_bench.contexts.setting import ContextsTask, Sizes

#: methods whose tests are in test_model_based, test_joint and the peers; networks have theirs
ELSEWHERE = {*UNLABELLED, *NEEDS, refined_network, amortised}


def method(row: Row) -> Callable[..., object]:
    """What stands behind a row."""
    return unwrap(row.learn)


#: rows of all other methods
HERE = [
    name for name, row in METHODS.items() if name not in NETWORKS and method(row) not in ELSEWHERE
]


def test_no_row_is_without_a_test() -> None:
    """Methods with tests of their own stand in the table without a label, and others are here."""
    others = [row for name, row in METHODS.items() if name not in HERE]
    assert set(NETWORKS) < set(METHODS)
    assert {method(row) for row in others} > ELSEWHERE
    assert len(others) == len(ELSEWHERE) + len(NETWORKS)
    assert not any(row.oracle or row.load_tests for row in others)
    assert HERE


@pytest.fixture(scope="module")
def easy() -> CalibrationData:
    sizes = Sizes(source=128, unlabelled=10, test=30)
    return calibration_of(ContextsTask(5, 0, "noise only", "same", "", (), sizes))


@pytest.fixture
def few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is asked is which labels a row looks at, and the model is right to begin with."""
    monkeypatch.setattr("rga.inference.joint.infer.ROUNDS", 1)
    monkeypatch.setattr("rga.inference.joint.infer.STEPS", 2)
    monkeypatch.setattr("rga_bench.contexts.methods.updated_model.MOST", 2)


@pytest.mark.usefixtures("few_steps")
@pytest.mark.parametrize(
    "name",
    [
        # What twenty load tests are to a method sixty are as well.
        pytest.param(name, marks=[pytest.mark.thorough] if METHODS[name].load_tests > 20 else [])
        for name in HERE
    ],
)
def test_a_row_learns_and_looks_at_no_label_but_its_own(name: str, easy: CalibrationData) -> None:
    row, tests = METHODS[name], easy.lesson.load_tests
    assert tests is not None
    problem, readings = LearningProblem.of(easy.lesson), easy.test.readings
    learned = row.calibrated(easy)
    assert error(problem, learned, easy.test) < 0.3
    found = Estimate.by(learned, readings, problem.model)

    # The rest of the load tests, and what test rows are measured under, as they are not.
    own = np.arange(len(tests)) < row.load_tests
    wrong = np.where(own[:, None], tests.contexts, tests.contexts[::-1])
    test = replace(easy.test, contexts=easy.test.contexts[::-1])
    lesson = replace(easy.lesson, load_tests=replace(tests, contexts=wrong))
    if not own.all():
        learned = row.calibrated(replace(easy, lesson=lesson, test=test))
    again = Estimate.by(learned, readings, problem.model)
    np.testing.assert_array_equal(again.value, found.value)
    np.testing.assert_array_equal(again.spread, found.spread)
    assert error(problem, learned, test) != error(problem, learned, easy.test)
