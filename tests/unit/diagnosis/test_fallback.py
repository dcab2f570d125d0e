"""Work that findings can do without: given up with a warning where its numbers fail."""

import numpy as np
import pytest

from rga.diagnosis.fallback import spared
from rga.errors import InputError


def test_work_that_succeeds_is_given_without_a_word() -> None:
    warnings: list[str] = []
    assert spared("the sum", lambda: 3, 0, warnings) == 3
    assert warnings == []


@pytest.mark.parametrize(
    "error", [np.linalg.LinAlgError("singular"), ZeroDivisionError("by zero"), ValueError("nan")]
)
def test_numbers_that_fail_leave_a_warning(error: Exception) -> None:
    def fail() -> int:
        raise error

    warnings = ["before"]
    assert spared("the sum", fail, -1, warnings) == -1
    assert warnings[0] == "before"
    assert warnings[1].startswith("the sum could not be worked out")
    assert str(error) in warnings[1]


def test_a_structure_that_cannot_be_simulated_is_no_fault() -> None:
    def fail() -> int:
        raise InputError("it moves", "the model", "hold it")

    warnings: list[str] = []
    assert spared("the sum", fail, -1, warnings) == -1
    assert "it moves" in warnings[0]


def test_a_fault_of_the_program_is_not_hidden() -> None:
    def fail() -> int:
        raise TypeError

    with pytest.raises(TypeError):
        spared("the sum", fail, 0, [])
