"""What modes that were left out say of causes, and all modes together of a model."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from rga.diagnosis.modal.checks import LeftOutModes, gain_interval, modes_off


@pytest.mark.parametrize(
    ("after", "worse"),
    [
        ([9.0, 8.0, 7.5, 9.5], True),
        ([2.2, 1.2, 1.7, 2.2], False),
        ([0.5, 9.0, 0.2, 1.0], False),
        ([0.1, 0.2, 0.1, 0.3], False),
    ],
)
def test_causes_are_refuted_where_all_modes_are_predicted_worse(
    after: list[float], worse: bool
) -> None:
    left_out = LeftOutModes(np.array([2.0, 1.0, 1.5, 2.0]), np.array(after))
    assert left_out.surely_worse == worse


def test_what_is_hardly_off_at_all_refutes_nothing() -> None:
    left_out = LeftOutModes(np.full(3, 0.02), np.array([0.1, 0.11, 0.12]))
    assert gain_interval(left_out.before - left_out.after)[1] < 0.0
    assert not left_out.surely_worse


def test_the_gain_of_one_mode_has_no_interval() -> None:
    assert gain_interval(np.array([2.0])) == (2.0, 2.0)


@pytest.mark.parametrize(("off", "told"), [(0.022, True), (0.005, False)])
def test_all_modes_together_may_be_off_where_none_is_by_itself(off: float, told: bool) -> None:
    likelihood: Any = SimpleNamespace(
        mean_off=lambda prediction: np.array([off, -off, off, off]),
        mean_spread=lambda prediction: np.full(4, 0.01),
        shape_off=lambda mode, prediction: np.zeros(3),
        readings=SimpleNamespace(modes=("a", "b", "c", "d")),
    )
    words = modes_off(likelihood, SimpleNamespace(mac=np.ones(4)))  # type: ignore[arg-type]
    assert [one.startswith("all modes together lie 2.2% off") for one in words] == [True] * told
