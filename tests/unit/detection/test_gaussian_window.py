"""The Gaussian window: exact decisions, and the same ones however the stream is cut."""

import math
import pickle
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exact_window import Rows, exact_alarms, hard_streams
from rga.detection import GaussianWindow
from rga.errors import InputError

MISSING = float("nan")


def test_last_digit_decides() -> None:
    """Values on the bound do not exceed it, above a level that leaves no digits to squares."""
    rows = 1e4 + np.array([[0.0], [2.0], [0.0], [2.0]]) * 2.0**-30
    bound = 1e4 + 4 * 2.0**-30
    window = GaussianWindow(1, 4, 3.0)
    window.update_many(rows)
    assert window.bound == bound
    assert not pickle.loads(pickle.dumps(window)).update([bound])
    assert window.update([np.nextafter(bound, np.inf)])


settings_of_a_window = st.fixed_dictionaries(
    {
        "window": st.integers(2, 7),
        "z": st.sampled_from([0.0, 0.5, 1.0, 2.0, 3.0]),
        "inclusive": st.booleans(),
        "persistence": st.sampled_from([(1, 1), (1, 3), (2, 3), (3, 3)]),
        "frozen": st.booleans(),
    }
)
# Of few digits: values that lie on the bound are judged too, and must not exceed it.
values = st.integers(-6, 6).map(float) | st.sampled_from([MISSING, 0.5, 2.0**16])
streams = st.lists(st.lists(values, min_size=2, max_size=2), max_size=60).map(
    lambda rows: np.array(rows, dtype=float).reshape(-1, 2)
)


@given(rows=streams, settings=settings_of_a_window)
def test_rule_holds(rows: Rows, settings: dict[str, Any]) -> None:
    window = GaussianWindow(2, **settings)
    assert np.array_equal(window.update_many(rows), exact_alarms(rows, **settings))
    assert window.rows == len(rows)


@given(
    rows=st.lists(st.floats(-1e3, 1e3), min_size=5, max_size=40),
    level=st.floats(-1e5, 1e5),
    z=st.floats(0, 6),
)
def test_bound_is_numpys(rows: list[float], level: float, z: float) -> None:
    stream = level + np.array(rows)
    window = GaussianWindow(1, 5, z)
    window.update_many(stream[:, None])
    last = stream[-5:]
    assert window.bound == pytest.approx(last.mean() + z * last.std(), rel=1e-12, abs=1e-6)


@given(rows=streams, settings=settings_of_a_window, cuts=st.sets(st.integers(0, 60), max_size=4))
def test_cuts_and_restarts_leave_the_same_bits(
    rows: Rows, settings: dict[str, Any], cuts: set[int]
) -> None:
    one_by_one = GaussianWindow(2, **settings)
    alarms = [one_by_one.update(row) for row in rows]
    in_parts, stored = GaussianWindow(2, **settings), GaussianWindow(2, **settings)
    edges = [0, *sorted(cut for cut in cuts if cut <= len(rows)), len(rows)]
    for start, end in pairwise(edges):
        in_parts = pickle.loads(pickle.dumps(in_parts))
        stored = GaussianWindow.from_bytes(stored.to_bytes())
        for window in (in_parts, stored):
            found = window.update_many(rows[start:end])
            assert np.array_equal(found, np.array(alarms[start:end]).reshape(-1, 2))
    assert in_parts.to_bytes() == stored.to_bytes() == one_by_one.to_bytes()
    assert in_parts.bound.tobytes() == one_by_one.bound.tobytes()


def test_hard_streams_restart_with_the_same_bits() -> None:
    rows = hard_streams()
    whole, first = GaussianWindow(3, 30), GaussianWindow(3, 30)
    alarms = whole.update_many(rows)
    found = [first.update_many(rows[:611])]
    second = pickle.loads(pickle.dumps(first))
    found += [second.update(row)[None] for row in rows[611:]]
    assert np.array_equal(np.concatenate(found), alarms)
    assert second.to_bytes() == whole.to_bytes()


def test_a_missing_value_takes_no_place() -> None:
    window = GaussianWindow(2, 3)
    window.update_many([[1.0, 1.0], [2.0, MISSING], [3.0, 3.0]])
    assert window.bound[0] == pytest.approx(2 + 3 * math.sqrt(2 / 3))
    assert np.isnan(window.bound[1])
    assert window.update([100, 100]).tolist() == [True, False]
    before = window.bound
    assert window.update([MISSING, MISSING]).tolist() == [False, False]
    assert np.array_equal(window.bound, before)
    assert window.update([1e6, 1e6]).tolist() == [True, True]
    assert window.rows == 6


def test_a_confidence_is_a_quantile() -> None:
    """Of the standard normal distribution, whose 0.975 quantile every table has."""
    rows = np.random.default_rng(8).normal(size=(30, 2))
    bounds = []
    for stated in (
        {"confidence": 0.975},
        {"z": 1.959963984540054},
        {"confidence": 0.5},
        {"z": 0.0},
    ):
        window = GaussianWindow(2, 30, **stated)
        window.update_many(rows)
        assert np.array_equal(pickle.loads(pickle.dumps(window)).bound, window.bound)
        bounds.append(window.bound)
    assert bounds[0] == pytest.approx(bounds[1], rel=1e-14)
    assert np.array_equal(bounds[2], bounds[3])


def test_alarms_persist() -> None:
    quiet = [[0.0], [1.0]] * 4
    stream = np.array([*quiet, [9.0], [0.5], [9.0], [MISSING], [9.0], [0.5], [0.5]])
    window = GaussianWindow(1, 8, persistence=(2, 3), frozen=True)
    alarms = window.update_many(stream)[:, 0]
    assert np.flatnonzero(alarms).tolist() == [10, 12, 13]


def test_window_that_holds_the_value_limits_it() -> None:
    """No value lies more than sqrt(W - 1) population deviations above a mean of W that holds it."""
    rows = np.array([[0.0]] * 9 + [[1e6]])
    assert GaussianWindow(1, 10, 2.999, inclusive=True).update_many(rows)[-1]
    at_the_limit = GaussianWindow(1, 10, 3.0, inclusive=True)
    assert not at_the_limit.update_many(rows).any()
    assert at_the_limit.bound == np.inf
    assert GaussianWindow(1, 9, 1e6).update_many(rows)[-1]


def test_inclusive_bound_is_what_must_be_exceeded() -> None:
    rows = np.random.default_rng(3).normal(size=(50, 4))
    window = GaussianWindow(4, 20, 2.0, inclusive=True)
    window.update_many(rows)
    bound = window.bound
    for sensor, limit in enumerate(bound):
        judged = np.append(rows[-19:, sensor], limit)
        assert judged.mean() + 2.0 * judged.std() == pytest.approx(limit)
    again = GaussianWindow.from_bytes(window.to_bytes())
    assert not window.update(bound - 1e-9).any()
    assert again.update(bound + 1e-9).all()


def test_a_frozen_window_does_not_absorb_a_change() -> None:
    noise = np.random.default_rng(5).normal(size=(200, 1))
    noise[100:] += 20.0
    open_window, frozen = GaussianWindow(1, 20), GaussianWindow(1, 20, frozen=True)
    assert not open_window.update_many(noise)[150:].all()
    assert frozen.update_many(noise)[100:].all()
    assert frozen.bound < 10.0


def test_any_layout_is_read() -> None:
    rows = np.arange(40).reshape(10, 4) % 7
    expected = GaussianWindow(4, 3, 1.0).update_many(rows.astype(float))
    assert expected.any()
    wide = np.repeat(rows, 2, axis=1).astype(float)
    for same in (
        rows,
        rows.tolist(),
        rows.astype(np.float32),
        np.asfortranarray(rows),
        wide[:, ::2],
    ):
        assert np.array_equal(GaussianWindow(4, 3, 1.0).update_many(same), expected)
    assert GaussianWindow(4, 3).update_many(np.zeros((0, 4))).shape == (0, 4)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"n_sensors": 0}, "0 sensors"),
        ({"n_sensors": -2}, "-2 sensors"),
        ({"window": 1}, "window of 1 value"),
        ({"z": MISSING}, "z is NaN"),
        ({"z": -1.0}, "z is -1"),
        ({"z": math.inf}, "z is inf"),
        ({"confidence": 0.4}, "confidence is 0.4"),
        ({"confidence": 1.0}, "confidence is 1"),
        ({"confidence": MISSING}, "confidence is NaN"),
        ({"confidence": 0.9, "z": 3.0}, "z and a confidence are given"),
        ({"persistence": (2, 1)}, r"persistence is \(2, 1\)"),
        ({"persistence": (0, 1)}, r"persistence is \(0, 1\)"),
        ({"persistence": (1, 65)}, r"persistence is \(1, 65\)"),
        ({"n_sensors": 2**40, "window": 2**40}, "do not fit in memory"),
    ],
)
def test_arguments_are_refused(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        GaussianWindow(**{"n_sensors": 2, "window": 5, **arguments})


@pytest.mark.parametrize("value", [math.inf, -math.inf, 1e61])
def test_infinite_values_are_refused_and_leave_no_trace(value: float) -> None:
    window = GaussianWindow(3, 4)
    window.update_many(np.ones((2, 3)))
    before = window.to_bytes()
    rows = np.ones((5, 3))
    rows[3, 1] = value
    with pytest.raises(InputError, match="row 5 of the stream, sensor 1"):
        window.update_many(rows)
    with pytest.raises(InputError, match="row 2 of the stream, sensor 1"):
        window.update(rows[3])
    assert window.to_bytes() == before


def test_a_long_call_that_is_refused_leaves_no_trace() -> None:
    rows = np.random.default_rng(9).normal(size=(5000, 3))
    window, other = GaussianWindow(3, 4), GaussianWindow(3, 4)
    window.update_many(rows[:100])
    other.update_many(rows[:100])
    bad = rows.copy()
    bad[4711, 2] = math.inf
    with pytest.raises(InputError, match="row 4811 of the stream, sensor 2"):
        window.update_many(bad)
    assert window.to_bytes() == other.to_bytes()
    assert np.array_equal(window.update_many(rows), other.update_many(rows))


@pytest.mark.parametrize("rows", [1.0, [1.0, 2.0], [[1.0, 2.0, 3.0]], np.ones((1, 1, 2))])
def test_other_shapes_are_refused(rows: Any) -> None:
    with pytest.raises(InputError, match=r"its shape must be \[n, 2\]"):
        GaussianWindow(2, 4).update_many(rows)


@pytest.mark.parametrize("row", [1.0, [1.0], [[1.0, 2.0]]])
def test_other_rows_are_refused(row: Any) -> None:
    with pytest.raises(InputError, match=r"its shape must be \[2\]"):
        GaussianWindow(2, 4).update(row)


def test_words_are_no_numbers() -> None:
    with pytest.raises(InputError, match="give an array of numbers"):
        GaussianWindow(2, 4).update(["high", "low"])


def test_foreign_bytes_are_refused() -> None:
    state = GaussianWindow(2, 4).to_bytes()
    outside = bytearray(state)
    outside[9 * 8] = 200
    for other in (b"", b"rga", b"x" * len(state), state[:-8], state + bytes(8), bytes(outside)):
        with pytest.raises(InputError, match="to_bytes"):
            GaussianWindow.from_bytes(other)


def test_masked_values_are_missing() -> None:
    window = GaussianWindow(2, 3)
    window.update_many(np.zeros((3, 2)))
    row = np.ma.masked_array([0.0, 1e9], [False, True])
    assert not window.update(row).any()
    assert window.update([0.0, 1e9]).tolist() == [False, True]
