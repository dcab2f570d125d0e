"""Rows in blocks of one size, so that packets of any size give the same bits."""

import numpy as np
from numpy.typing import NDArray

#: rows of a block
BLOCK = 32


def block(number: int, rows: int) -> NDArray[np.int64]:
    """Rows of a block; behind the last row it stands again, int[BLOCK].

    >>> block(1, 34)[:4]
    array([32, 33, 33, 33])
    """
    return np.minimum(np.arange(number * BLOCK, (number + 1) * BLOCK), rows - 1)


def blocks(first: int, rows: int) -> range:
    """Numbers of the blocks that hold the rows from one on."""
    return range(first // BLOCK, -(-rows // BLOCK))
