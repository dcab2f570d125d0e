"""Cells of samples: their mean and spread, whatever order the samples came in."""

from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rga.operation.rows.cells import Cell, SensorSamples, cell_of, cells_of

NAMES = ("D1", "D2")
EVERY = 60


def samples(
    times: list[int], values: list[list[float]], names: tuple[str, ...] = NAMES
) -> SensorSamples:
    return SensorSamples(names, np.array(times, np.int64), np.array(values, float))


def assert_same(one: list[Cell], other: list[Cell]) -> None:
    assert [cell.begin for cell in one] == [cell.begin for cell in other]
    for a, b in zip(one, other, strict=True):
        for name in ("count", "mean", "deviation", "least", "most", "conflicts"):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name), strict=True)


def test_the_mean_of_a_cell() -> None:
    cells = cells_of(
        [samples([0, 59, 60, 61], [[1, 5], [3, np.nan], [7, 8], [9, np.nan]])], NAMES, EVERY
    )
    assert [cell.begin for cell in cells] == [0, 60]
    np.testing.assert_array_equal(cells[0].count, [2, 1])
    np.testing.assert_array_equal(cells[0].mean, [2, 5])
    np.testing.assert_array_equal(cells[0].deviation, [2**0.5, np.nan])
    np.testing.assert_array_equal(cells[1].least, [7, 8])
    np.testing.assert_array_equal(cells[1].most, [9, 8])


def test_a_cell_without_a_sample_is_none() -> None:
    cells = cells_of([samples([0, 600], [[1, 1], [2, 2]])], NAMES, EVERY)
    assert [cell.begin for cell in cells] == [0, 600]
    assert cells_of([], NAMES, EVERY) == []


def test_channels_of_several_loggers_meet_in_a_cell() -> None:
    parts = [samples([5], [[1]], ("D2",)), samples([5], [[2, 9]], ("D1", "other"))]
    cell = cells_of(parts, NAMES, EVERY)[0]
    np.testing.assert_array_equal(cell.mean, [2, 1])
    np.testing.assert_array_equal(cell.conflicts, [0, 0])


def test_the_first_of_two_values_counts_and_the_other_is_told() -> None:
    parts = [samples([5], [[1, np.nan]]), samples([5], [[4, 2]]), samples([5], [[1, 2]])]
    cell = cells_of(parts, NAMES, EVERY)[0]
    np.testing.assert_array_equal(cell.mean, [1, 2])
    np.testing.assert_array_equal(cell.count, [1, 1])
    np.testing.assert_array_equal(cell.conflicts, [1, 0])


@pytest.mark.parametrize("value", [0.1, 1e30, -5e-324, 0.30000000000000004])
def test_the_mean_of_equal_samples_is_that_sample(value: float) -> None:
    cell = cells_of([samples([0, 1, 2], [[value, value]] * 3)], NAMES, EVERY)[0]
    np.testing.assert_array_equal(cell.mean, [value, value])
    np.testing.assert_array_equal(cell.deviation, [0, 0])


@given(
    st.lists(
        st.tuples(st.integers(-200, 200), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6) | st.none()),
        unique_by=lambda one: one[0],
        max_size=12,
    ),
    st.randoms(use_true_random=False),
)
def test_cells_do_not_hang_on_the_order_of_arrival(
    rows: list[tuple[int, float, float | None]], draw: Random
) -> None:
    def packets(order: list[tuple[int, float, float | None]]) -> list[SensorSamples]:
        return [samples([time], [[a, np.nan if b is None else b]]) for time, a, b in order]

    mixed = list(rows)
    draw.shuffle(mixed)
    cells = cells_of(packets(rows), NAMES, EVERY)
    assert_same(cells, cells_of(packets(mixed), NAMES, EVERY))
    # Each as the plain formulas have it.
    for cell in cells:
        within = [a for time, a, _ in sorted(rows) if cell_of(time, EVERY) == cell.begin]
        assert cell.count[0] == len(within)
        np.testing.assert_allclose(cell.mean[0], np.mean(within), rtol=1e-12, atol=1e-9)
        if len(within) > 1:
            spread = np.std(within, ddof=1)
            np.testing.assert_allclose(cell.deviation[0], spread, rtol=1e-9, atol=1e-9)
    assert sum(int(cell.count[0]) for cell in cells) == len(rows)
