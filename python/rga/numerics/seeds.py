"""Seeds of what is random, as callers give them."""

from typing import Any

import numpy as np

from rga.errors import InputError

#: a repository keeps whole numbers below it
BEYOND = 2**63


def as_seed(given: Any) -> int:
    """A seed that can be drawn by, and kept.

    Raises:
        InputError: this is none.

    >>> as_seed(np.int32(7))
    7
    >>> as_seed(-1)
    Traceback (most recent call last):
    rga.errors.InputError: -1 is no seed (seed): give a whole number from 0 to 2^63 - 1
    """
    whole = isinstance(given, int | np.integer) and not isinstance(given, bool)
    if not (whole and 0 <= given < BEYOND):
        remedy = "give a whole number from 0 to 2^63 - 1"
        raise InputError(f"{given!r} is no seed", "seed", remedy)
    return int(given)
