"""Files that are spoiled in one to three ways, through every command that reads them."""

import os
import shutil
from collections import Counter
from collections.abc import Callable
from typing import Any

import pytest

Drawn = Callable[..., Any]
#: cases of a test, and how many tests there are at full length
CASES, TESTS = 60, 80


def run(numbers: range, drawn: Drawn, judged: Callable[[Any], Any]) -> None:
    """Draw cases, and tell of those of which something comes that may not."""
    codes: Counter[int | None] = Counter()
    wrong = []
    for number in numbers:
        case = drawn(number)
        came = judged(case)
        codes[came.code] += 1
        wrong += [f"case {number}, rga {' '.join(case.words)}: {one}" for one in came.faults]
        if not came.faults or "RGA_KEEP_CASES" not in os.environ:
            shutil.rmtree(case.folder)
    assert not wrong, "\n".join(wrong)
    # Some are good all the same, and most are refused.
    assert codes[0] > 0 < codes[2]


def test_some_spoiled_files(drawn: Drawn, judged: Callable[[Any], Any]) -> None:
    run(range(CASES), drawn, judged)


@pytest.mark.thorough
@pytest.mark.parametrize("place", range(1, TESTS + 1))
def test_spoiled_files(place: int, drawn: Drawn, judged: Callable[[Any], Any]) -> None:
    run(range(CASES * place, CASES * (place + 1)), drawn, judged)
