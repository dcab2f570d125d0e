"""Members that cross: all pairs of them, as by brute force."""

from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray

from rga.checking.of_model import crossings

Array = NDArray[np.float64]


def cross(a: Array, b: Array, c: Array, d: Array) -> bool:
    """Whether lines a-b and c-d meet within both, in a plane."""

    def side(p: Array, q: Array, r: Array) -> float:
        return float((q[0] - p[0]) * (r[2] - p[2]) - (q[2] - p[2]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < 0 and side(c, d, a) * side(c, d, b) < 0


@pytest.mark.parametrize("chunk", [3, 200_000])
def test_pairs_are_those_of_brute_force(chunk: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(crossings, "CHUNK", chunk)
    draw = np.random.default_rng(1)
    points = draw.random((40, 3)) * [20.0, 0.0, 5.0]
    ends = np.array([draw.choice(40, 2, replace=False) for _ in range(60)])
    expected = {
        frozenset((one, other))
        for one, other in combinations(range(60), 2)
        if not set(ends[one]) & set(ends[other]) and cross(*points[ends[one]], *points[ends[other]])
    }
    found = [frozenset(pair) for pair in crossings._crossing(points, ends)]
    assert len(expected) > 50
    assert set(found) == expected
    assert len(found) == len(expected)


def test_lines_that_pass_at_a_distance_do_not_meet() -> None:
    points = np.array([[0, 0, 0], [2, 0, 0], [1, -1, 0.1], [1, 1, 0.1]], dtype=float)
    ends = np.array([[0, 1], [2, 3]])
    assert crossings._crossing(points, ends) == []
    points[2:, 2] = 0.0
    assert crossings._crossing(points, ends) == [(0, 1)]
