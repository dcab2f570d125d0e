"""Blocks of a long past say what its rows say."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from rga.operation.reading.overview import BLOCK, Overview, as_trace

VALUES = arrays(
    float,
    st.tuples(st.integers(1, 5 * BLOCK), st.just(2)),
    elements=st.one_of(st.just(np.nan), st.floats(-1e6, 1e6, width=32)),
)


def reduced(values: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean, least and most of rows, by column; NaN where nothing is."""
    columns = [column[np.isfinite(column)] for column in values.T]
    parts = [(one.mean(), one.min(), one.max()) if len(one) else (np.nan,) * 3 for one in columns]
    mean, least, most = np.array(parts).T
    return mean, least, most


@given(VALUES, st.lists(st.integers(0, 40), max_size=12), st.integers(1, 300))
def test_blocks_are_those_of_the_rows(values: np.ndarray, lengths: list[int], points: int) -> None:
    time, overview, first = np.arange(len(values)) * 60.0, Overview(2), 0
    for length in [*lengths, len(values)]:
        overview.append(time[first : first + length], values[first : first + length])
        # Whoever looks in between changes nothing.
        overview.between(0.0, np.inf)
        first = min(len(values), first + length)
    assert overview.rows == len(values)
    found = overview.between(0.0, np.inf)
    edges = [*range(0, len(values) // BLOCK * BLOCK, BLOCK)]
    edges += [*range(len(values) // BLOCK * BLOCK, len(values))]
    np.testing.assert_array_equal(found.time, time[edges])
    for k, (begin, end) in enumerate(zip(edges, [*edges[1:], len(values)], strict=True)):
        mean, least, most = reduced(values[begin:end])
        np.testing.assert_allclose(found.mean[k], mean, rtol=1e-6, atol=1e-2)
        np.testing.assert_array_equal(found.least[k], least)
        np.testing.assert_array_equal(found.most[k], most)
    fewer = found.at_most(points)
    assert len(fewer) == min(points, len(found))
    whole = reduced(values)
    if np.isfinite(whole[1]).all():
        np.testing.assert_array_equal(np.nanmin(fewer.least, axis=0), whole[1])
        np.testing.assert_array_equal(np.nanmax(fewer.most, axis=0), whole[2])


@given(VALUES, st.floats(-100, 3e4), st.floats(0, 2e4))
def test_what_lies_within_a_time_is_there(values: np.ndarray, begin: float, length: float) -> None:
    time, overview = np.arange(len(values)) * 60.0, Overview(2)
    overview.append(time, values)
    inside = values[(time >= begin) & (time < begin + length)]
    found = overview.between(begin, begin + length)
    for k in range(2):
        column = inside[:, k][np.isfinite(inside[:, k])]
        if len(column):
            assert np.nanmin(found.least[:, k]) <= column.min()
            assert np.nanmax(found.most[:, k]) >= column.max()
    # Nothing is there that is farther away than a block.
    assert (found.time < begin + length).all()
    assert (found.time > min(begin, time[-1]) - 60.0 * BLOCK).all()


def test_a_mean_of_a_mean_weighs_rows_alike() -> None:
    values = np.array([[1.0], [np.nan], [np.nan], [4.0], [6.0]])
    found = as_trace(np.arange(5.0), values).at_most(1)
    assert found.mean.tolist() == [[11 / 3]]
