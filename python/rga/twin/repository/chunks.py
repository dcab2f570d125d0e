"""Rows of arrays as chunks of little-endian float64 bytes."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from rga.arrays import FloatArray

# Reading a few rows of a long series then loads little else.
LONGEST = 1024


def chunks(**arrays: ArrayLike) -> Iterator[tuple[int, dict[str, Any]]]:
    """Cut float[n] or float[n, width] arrays into chunks of LONGEST rows at most.

    Returns:
        For each chunk its first row and its columns: `length` in rows, and bytes for each array.

    Raises:
        ValueError: the arrays differ in their number of rows, or have none or more than two axes.

    >>> [(start, chunk["length"]) for start, chunk in chunks(time=np.arange(1500.0))]
    [(0, 1024), (1024, 476)]
    """
    columns = {name: np.asarray(array, dtype="<f8") for name, array in arrays.items()}
    shapes = {name: column.shape for name, column in columns.items()}
    if any(len(shape) not in (1, 2) for shape in shapes.values()):
        raise ValueError(f"arrays of rows have one or two axes, not {shapes}")
    if len({shape[0] for shape in shapes.values()}) > 1:
        raise ValueError(f"arrays of the same rows differ in length: {shapes}")
    (rows,) = {shape[0] for shape in shapes.values()}
    for start in range(0, rows, LONGEST):
        parts = {name: column[start : start + LONGEST] for name, column in columns.items()}
        count = min(LONGEST, rows - start)
        yield start, {"length": count} | {name: part.tobytes() for name, part in parts.items()}


def unpack(packed: bytes, count: int) -> FloatArray:
    """The array of a chunk, float[count, width].

    >>> [(_, chunk)] = chunks(readings=[[1.0, np.nan], [2.0, 3.0]])
    >>> unpack(chunk["readings"], chunk["length"])
    array([[ 1., nan],
           [ 2.,  3.]])
    """
    values = np.frombuffer(packed, dtype="<f8").astype(np.float64)
    return values.reshape(count, len(values) // count)


def one_after_another(parts: Sequence[FloatArray]) -> FloatArray:
    """The rows of several arrays, float[n, width]; NaN where one has rows and no columns.

    >>> one_after_another([np.ones((1, 2)), np.zeros((1, 0))])
    array([[ 1.,  1.],
           [nan, nan]])
    """
    width = max((part.shape[1] for part in parts), default=0)
    missing = [np.full((len(part), width - part.shape[1]), np.nan) for part in parts]
    return np.concatenate(
        [np.zeros((0, width)), *(np.hstack(both) for both in zip(parts, missing, strict=True))]
    )
