"""Rows as users give them."""

import numpy as np
from numpy.typing import ArrayLike

from rga.arrays import FloatArray
from rga.errors import InputError

#: numbers beyond this are taken for faults of their source
LARGEST = 1e60


def table(values: ArrayLike, name: str) -> FloatArray:
    """Rows as float[n, sensors] in C order.

    Raises:
        InputError: no numbers, or another shape.
    """
    found = numbers(values, name)
    if found.ndim != 2 or found.shape[1] == 0:
        what = f"the array has shape {list(found.shape)}"
        raise InputError(what, name, "its shape must be [n, sensors]")
    return found


def row(values: ArrayLike, sensors: int) -> FloatArray:
    """A row of so many sensors as float[1, sensors].

    Raises:
        InputError: no numbers, or another shape.
    """
    found = numbers(values, "row")
    if found.shape != (sensors,):
        what = f"the array has shape {list(found.shape)}"
        raise InputError(what, "row", f"its shape must be [{sensors}]")
    return found[None]


def within(rows: FloatArray, first: int, whole: str) -> None:
    """Refuse numbers that are none of a sensor's.

    Args:
        rows: float[n, sensors].
        first: number of the first.
        whole: what they are part of.

    Raises:
        InputError: a number beyond 1e60 in size.
    """
    beyond = np.argwhere(np.abs(rows) > LARGEST)
    if len(beyond):
        at, sensor = beyond[0]
        raise InputError(
            f"the value is {rows[at, sensor]:g}",
            f"row {first + at} of {whole}, sensor {sensor}",
            f"give numbers within {LARGEST:g} in size, and NaN for a missing reading",
        )


def numbers(values: ArrayLike, name: str) -> FloatArray:
    """An array of numbers in C order.

    Raises:
        InputError: no numbers.
    """
    try:
        if isinstance(values, np.ma.MaskedArray):
            values = np.ma.asarray(values, dtype=float).filled(np.nan)
        given = np.asarray(values)
        if given.dtype.kind not in "biufO":
            raise TypeError(f"the values are of type {given.dtype}")
        # Rows of one number stay of that shape.
        return np.asarray(given, dtype=float, order="C")
    except (TypeError, ValueError) as error:
        remedy = "give an array of numbers, with NaN for a missing reading"
        raise InputError(str(error), name, remedy) from None
