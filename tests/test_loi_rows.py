"""Every row of the table learns, and looks at no label that is not its own."""

from dataclasses import replace

import numpy as np
import pytest

from rga.benchmark.loi.data import Calibration, calibration_of
from rga.benchmark.loi.examination import Examination
from rga.benchmark.loi.rows import METHODS
from rga.benchmark.loi.setting import Sizes, Task
from rga.inference.rows import Rows

#: rows whose tests are in another file
ELSEWHERE = {
    "test_loi_networks": {
        "source only", "residual network", "CORAL", "DANN", "DANN + physics, frozen network",
        "DANN + physics, exact simulator", "physics only",
    },
    "test_loi_model_based": {
        "prior mean", "MAP", "MAP, smooth discrepancy", "MAP, low-rank discrepancy (EM)",
        "iterated Kalman filter", "unscented Kalman filter", "ensemble Kalman filter",
    },
    "test_loi_joint": {"network + polish"},
    "test_loi_peers": {"neural posterior (sbi)", "CORAL (skada)", "DANN (skada)"},
}  # fmt: skip
HERE = (
    "knows the frame",
    "updated model, 20 load tests",
    "updated model, 60 load tests",
    "joint posterior",
    "joint posterior, 20 load tests",
    "joint posterior, 60 load tests",
)


def test_no_row_is_without_a_test() -> None:
    assert set().union(HERE, *ELSEWHERE.values()) == set(METHODS)


@pytest.fixture(scope="module")
def easy() -> Calibration:
    sizes = Sizes(source=256, unlabelled=20, test=40)
    return calibration_of(Task(5, 0, "noise only", "same", "", (), sizes))


@pytest.mark.parametrize("name", HERE)
def test_a_row_learns_and_looks_at_no_label_but_its_own(name: str, easy: Calibration) -> None:
    row, tests = METHODS[name], easy.problem.load_tests
    calibrated = row.calibrated(easy)
    found = Examination(easy.test, easy.problem.ranges, 30).score(calibrated)
    assert found.error is not None
    assert found.error < 0.3

    # The rest of the load tests, and what test rows are measured under, as they are not.
    own = np.arange(len(tests)) < row.load_tests
    wrong = np.where(own[:, None], tests.contexts, tests.contexts[::-1])
    test = replace(easy.test, contexts=easy.test.contexts[::-1])
    if not own.all():
        problem = replace(easy.problem, load_tests=Rows(wrong, tests.readings))
        calibrated = row.calibrated(replace(easy, problem=problem, test=test))
    again = Examination(test, easy.problem.ranges, 30).score(calibrated)
    assert again.rg == found.rg
    assert again.error != found.error
