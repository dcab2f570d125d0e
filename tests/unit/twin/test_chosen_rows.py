"""Rows of a long past that stand for all: how many, where, and what is told of them."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from rga.twin.past.chosen_rows import ON_END, ChosenRows, chosen_rows

ROWS, MOST, MARK = 30_011, 400, 28_503
DRAW = np.random.default_rng(3)
RARE = slice(9004, 9016)
WARMTH = DRAW.uniform(-5.0, 25.0, ROWS)
WARMTH[RARE] = 38.0
CONTEXTS = np.column_stack([WARMTH, DRAW.uniform(0.0, 100.0, ROWS)])
CONTEXTS[::7] = np.nan
RANGES = np.array([[-20.0, 40.0], [0.0, 100.0]])


def choice(
    *marks: int, most: int = MOST, seed: int = 0, on_end: int = ON_END, zero: slice | None = None
) -> ChosenRows:
    taken_off = None if zero is None else np.arange(ROWS)[zero]
    return chosen_rows(
        ROWS, CONTEXTS, RANGES, marks, 200, most, seed, zero=taken_off, on_end=on_end
    )


@pytest.mark.parametrize("on_end", [1, 2, ON_END, 50])
@pytest.mark.parametrize("most", [12, 57, MOST, 3001, ROWS - 1])
def test_at_most_so_many_from_the_first_to_the_last(most: int, on_end: int) -> None:
    rows = choice(200, MARK, most=most, on_end=on_end).rows
    assert most - 2 * on_end < len(rows) <= most
    assert np.all(np.diff(rows) > 0)
    assert rows[0] == 0
    if most >= 57:
        assert rows[-1] == ROWS - 1 or on_end == 50


def test_a_short_past_is_all_there() -> None:
    all_of_it = choice(200, MARK, most=ROWS)
    assert_array_equal(all_of_it.rows, np.arange(ROWS))
    assert all_of_it.words == ""


def test_rows_are_there_the_more_the_nearer_to_a_mark() -> None:
    rows = choice(200, MARK).rows
    away = np.abs(rows - MARK)
    assert set(range(MARK - 8, MARK + 8)) <= set(rows.tolist())
    edges = np.array([0, 12, 120, 1200, 12_000])
    density = np.histogram(away, edges)[0] / np.diff(edges)
    assert np.all(density[1:] < density[:-1] / 2)


def test_rare_conditions_are_there_and_evenly_chosen_rows_miss_them() -> None:
    assert np.any(WARMTH[choice(200, MARK).rows] == 38.0)
    assert not np.any(WARMTH[:: ROWS // MOST] == 38.0)


def test_the_calibration_the_latest_rows_and_both_sides_of_the_mark_are_there() -> None:
    rows = choice(200, MARK).rows
    assert np.sum(rows < 200) >= 0.1 * MOST
    assert set(range(ROWS - 56, ROWS)) <= set(rows.tolist())
    assert min(np.sum(rows < MARK), np.sum(rows >= MARK)) > 0.3 * MOST


def test_the_latest_of_many_marks_are_dated() -> None:
    marks = list(range(1000, 29_000, 1000))
    found = choice(*marks)
    assert {27_999, 28_000} <= set(found.rows.tolist())
    assert "about rows 26 000, 27 000, 28 000," in found.words


def test_rows_of_a_zero_are_there_up_to_a_share() -> None:
    assert set(range(400, 440)) <= set(choice(200, MARK, zero=slice(400, 440)).rows.tolist())
    found = choice(200, MARK, zero=slice(400, 8000))
    inside = (found.rows >= 400) & (found.rows < 8000)
    assert 0.2 * MOST <= np.sum(inside) < 0.5 * MOST
    assert "80 of the zero" in found.words


@pytest.mark.parametrize("marks", [(), (0,), (ROWS,), (1,), (ROWS - 1,)])
def test_marks_at_the_ends_and_none(marks: tuple[int, ...]) -> None:
    assert MOST - 2 * ON_END < len(choice(*marks).rows) <= MOST


def test_a_seed_gives_the_same_rows_and_another_others() -> None:
    assert_array_equal(choice(200, MARK).rows, choice(200, MARK).rows)
    assert not np.array_equal(choice(200, MARK).rows, choice(200, MARK, seed=1).rows)


def test_without_contexts_none_are_told_of() -> None:
    found = chosen_rows(ROWS, np.zeros((ROWS, 0)), np.zeros((0, 2)), [MARK], 200, MOST, 0)
    assert len(found.rows) > MOST - 2 * ON_END
    assert "contexts" not in found.words
    assert " of 30 011 rows, 4 on end: " in found.words
