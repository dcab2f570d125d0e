"""Every row of the table learns, and looks at no label that is not its own."""

from dataclasses import replace

import numpy as np
import pytest

from context_methods import NEEDS, UNLABELLED
from rga.inference.rows import Rows
from rga_bench.contexts.data import CalibrationData, calibration_of
from rga_bench.contexts.evaluation import Evaluation
from rga_bench.contexts.methods import networks
from rga_bench.contexts.methods.networks import NETWORKS
from rga_bench.contexts.methods.refined_network import refined_network
from rga_bench.contexts.rows import METHODS
from rga_bench.contexts.setting import ContextsTask, Sizes

#: methods whose tests are in test_networks, test_model_based, test_joint and the peers
ELSEWHERE = {*(getattr(networks, name) for name in NETWORKS), *UNLABELLED, *NEEDS, refined_network}
#: rows of all other methods
HERE = [name for name, row in METHODS.items() if row.learn not in ELSEWHERE]


def test_no_row_is_without_a_test() -> None:
    """Methods with tests of their own stand in the table without a label, and others are here."""
    others = [row for name, row in METHODS.items() if name not in HERE]
    assert {row.learn for row in others} == ELSEWHERE
    assert len(others) == len(ELSEWHERE)
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
@pytest.mark.parametrize("name", HERE)
def test_a_row_learns_and_looks_at_no_label_but_its_own(name: str, easy: CalibrationData) -> None:
    row, tests = METHODS[name], easy.problem.load_tests
    calibrated = row.calibrated(easy)
    found = Evaluation(easy.test, easy.problem.ranges, 30).score(calibrated)
    assert found.error is not None
    assert found.error < 0.3

    # The rest of the load tests, and what test rows are measured under, as they are not.
    own = np.arange(len(tests)) < row.load_tests
    wrong = np.where(own[:, None], tests.contexts, tests.contexts[::-1])
    test = replace(easy.test, contexts=easy.test.contexts[::-1])
    if not own.all():
        problem = replace(easy.problem, load_tests=Rows(wrong, tests.readings))
        calibrated = row.calibrated(replace(easy, problem=problem, test=test))
    again = Evaluation(test, easy.problem.ranges, 30).score(calibrated)
    assert again.rg == found.rg
    assert again.error != found.error
