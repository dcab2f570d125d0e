"""How large an effect is where some contexts were not measured: d' with them marginalised.

The unknowns of a row are its noise and, along the derivatives ``J`` [c, k] of the channels by
the contexts, the contexts themselves, as far as their ranges or their measurement leave them
open: ``R = diag(v) + J diag(spread^2) J.T``. Over all rows stands as-built scatter: a random
factor of 3 % on the share of each context in each channel, ``B``, as in ``score.py``. Then
``d'^2 = s.T (R + 0.03^2 B B.T)^-1 s``, by Woodbury's identity twice.
"""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.hidden.score import SCATTER
from rga_bench.synthetic.physics.frame import Array


class Sight:
    """What the channels can see.

    ``jacobian`` [n, c, k] derivatives by the contexts, ``spread`` [k] what is unknown of them,
    ``shares`` one [n, c] per context, ``variance`` [c] of the noise.
    """

    def __init__(
        self, jacobian: Array, spread: Array, shares: list[Array], variance: Array
    ) -> None:
        rows, channels, _ = jacobian.shape
        self._weighted = jacobian / variance[:, None]
        self._variance = variance
        inner = jacobian.transpose(0, 2, 1) @ self._weighted + np.diag(spread**-2.0)
        self._inner = np.linalg.inv(inner)
        columns = np.zeros((rows, channels, len(shares), channels))
        for k, share in enumerate(shares):
            columns[:, range(channels), k, range(channels)] = SCATTER * share
        self._columns = columns.reshape(rows, channels, -1)
        flat = self._columns.reshape(rows * channels, -1)
        gram = flat.T @ self._solved(self._columns).reshape(rows * channels, -1)
        self._gram = gram + np.eye(len(gram))

    def d_prime(self, signature: Array) -> float:
        """Of a change of the channels [n, c]."""
        solved = self._solved(signature[:, :, None])[:, :, 0]
        across = np.tensordot(self._columns, solved, axes=([0, 1], [0, 1]))
        left = float((signature * solved).sum())
        left -= float(across @ np.linalg.solve(self._gram, across))
        return float(np.sqrt(max(left, 0.0)))

    def _solved(self, columns: Array) -> Array:
        """``R^-1`` times columns [n, c, p]."""
        errors = self._inner @ (self._weighted.transpose(0, 2, 1) @ columns)
        return np.asarray(columns / self._variance[:, None] - self._weighted @ errors)
