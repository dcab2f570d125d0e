"""Few of many parameters that have changed are found by the evidence of new rows."""

import numpy as np
import pytest

from rga.arrays import FloatArray, IntArray
from rga.inference.joint.sparse_changes import sparse_changes

PARAMETERS, ROWS = 60, 400
KINDS = np.repeat([0, 1], 30)


def evidence(
    seed: int, changed: dict[int, float]
) -> tuple[FloatArray, FloatArray, FloatArray, IntArray]:
    """Information of rows, its pull, and what was left open of parameters that some change of."""
    draw = np.random.default_rng(seed)
    slopes = draw.standard_normal((ROWS, PARAMETERS)) @ draw.standard_normal((PARAMETERS,) * 2)
    root = np.eye(PARAMETERS) + 0.05 * draw.standard_normal((PARAMETERS, PARAMETERS))
    off = root @ draw.standard_normal(PARAMETERS)
    for number, size in changed.items():
        off[number] += size
    seen = slopes @ off + draw.standard_normal(ROWS)
    return slopes.T @ slopes, slopes.T @ seen, root @ root.T, KINDS


@pytest.mark.parametrize("seed", range(8))
def test_nothing_has_changed(seed: int) -> None:
    assert not sparse_changes(*evidence(seed, {})).any()


@pytest.mark.parametrize("seed", range(8))
def test_those_that_have_changed_are_found(seed: int) -> None:
    size = {3: 30.0, 17: -25.0, 44: 40.0}
    found = sparse_changes(*evidence(seed, size))
    assert np.flatnonzero(found).tolist() == list(size)
    np.testing.assert_allclose(np.sqrt(found[list(size)]), np.abs(list(size.values())), rtol=0.3)


def test_an_error_of_the_model_is_no_change() -> None:
    information, pull, left_open, _ = evidence(0, {})
    # Rows that are wrong in common: all parameters differ by more than was left open of them.
    assert not sparse_changes(information, 3.0 * pull, left_open, KINDS).any()
    assert sparse_changes(*evidence(0, {3: 30.0}))[3] > 0


def test_what_the_rows_do_not_see_has_not_changed() -> None:
    information, pull, left_open, _ = evidence(1, {3: 30.0})
    information[3] = information[:, 3] = pull[3] = 0.0
    assert sparse_changes(information, pull, left_open, KINDS)[3] == 0.0


def test_channels_that_say_nothing_do_not_disarm_the_guard() -> None:
    draw, found = np.random.default_rng(3), 0
    for _ in range(50):
        information = np.diag(np.where(np.arange(22) % 11 < 6, 0.0, 400.0))
        off = 3.0 * draw.standard_normal(22)  # all by more than was left open
        pull = information @ off
        found += sparse_changes(information, pull, np.eye(22), np.repeat([0, 1], 11)).any()
    assert found < 15
