"""The tare: which rows were taken off which channel, and what their mean is."""

import numpy as np
import pytest

from rga.diagnosis.data.tare import MOST_ROWS, Tare
from rga.records import Record


def record(rows: int) -> Record:
    time = np.arange(float(rows))
    readings = np.column_stack([time, 10 * time])
    return Record(time, 0.0, "seconds", ("A", "B"), readings, {})


def tare(rows: int, *zeros: tuple[float, float] | None) -> Tare:
    one = record(rows)
    return Tare.of(one, {"time": one.time, "load": 2 * one.time}, [0, 1], list(zeros))


def test_nothing_is_taken_off() -> None:
    none = tare(20, None, None)
    assert len(none) == 0
    assert none.mean(np.zeros((0, 2)), [0, 1]).tolist() == [0.0, 0.0]


def test_each_channel_has_the_mean_of_its_own_rows() -> None:
    found = tare(20, (0.0, 3.0), (2.0, 7.0))
    assert found.rows == 8
    assert found.counts.tolist() == [4, 6]
    values = np.column_stack([found.time, 10 * found.time])
    assert found.mean(values, [0, 1]) == pytest.approx([1.5, 45.0])
    assert found.mean(values[:, [1]], [1]) == pytest.approx([45.0])
    np.testing.assert_array_equal(found.contexts["load"], 2 * found.time)


def test_a_channel_that_was_not_zeroed_keeps_all() -> None:
    found = tare(20, (0.0, 3.0), None)
    assert found.counts.tolist() == [4, 0]
    assert found.mean(np.ones((len(found), 2)), [0, 1]) == pytest.approx([1.0, 0.0])
    # What is shared by the channels that were zeroed.
    assert found.mean_weight(np.array([[1.0, 1.0, 0.0, 0.0]])) == pytest.approx([0.5])


def test_many_rows_are_put_together() -> None:
    found = tare(400, (0.0, 299.0), (0.0, 299.0))
    assert len(found) == MOST_ROWS
    assert found.rows == 300
    assert found.mean(np.column_stack([found.time] * 2), [0, 1]) == pytest.approx(
        [149.5] * 2, rel=1e-2
    )


def test_missing_readings_have_no_share() -> None:
    one = record(10)
    one.readings[:2, 0] = np.nan
    found = Tare.of(one, {"time": one.time}, [0, 1], [(0.0, 3.0), (0.0, 3.0)])
    assert found.counts.tolist() == [2, 4]
    assert found.mean(np.column_stack([found.time] * 2), [0, 1]) == pytest.approx([2.5, 1.5])
