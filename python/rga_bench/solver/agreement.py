"""What must hold before anything is timed: all compute the same."""

import numpy as np

from rga.arrays import FloatArray

#: relative to the largest output
AGREEMENT = 1e-9


def agree(name: str, found: FloatArray, expected: FloatArray, within: float = AGREEMENT) -> float:
    """How far two results are apart, relative to the largest that is expected.

    Raises:
        ArithmeticError: that is more than `within`, or not a number.
    """
    off = float(np.abs(found - expected).max() / np.abs(expected).max())
    if not off <= within:
        raise ArithmeticError(f"{name} is off by {off:.1e} of the largest output")
    return off
