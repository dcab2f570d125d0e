"""How large an effect is against what nobody can know: the generator's own account.

The unknown of a record is white noise of the long-run variance of each channel, with what the
errors of measured contexts put in, and the as-built scatter, from realities drawn of the same
spreads: a few columns of what all channels do together, and beside them what each channel does by
itself under every pattern of loads, for a few realities hold no channel's gain. With all of these
as columns ``B``, ``d'^2 = s.T (R + B B.T)^-1 s`` by Woodbury's identity.
"""

from __future__ import annotations

import numpy as np

from rga_bench.field.solver import Array


class ReadingCovariance:
    """``variance`` [c]; ``amounts`` [n, p] of the patterns of loads in every row; ``scatter``
    [k, p, c]: what drawn realities answer to a unit of each, less their mean."""

    def __init__(self, variance: Array, amounts: Array, scatter: Array) -> None:
        self._root = np.sqrt(variance)
        scatter = scatter / np.sqrt(len(scatter)) / self._root
        rows, channels = len(amounts), scatter.shape[2]
        columns = [np.moveaxis(amounts @ scatter, 0, -1).reshape(rows * channels, -1)]
        for channel in range(channels):
            _, sizes, shapes = np.linalg.svd(scatter[:, :, channel], full_matrices=False)
            own = np.zeros((rows, channels, len(sizes)))
            own[:, channel] = amounts @ (sizes[:, None] * shapes).T
            columns.append(own.reshape(rows * channels, -1))
        self._columns = np.hstack(columns)
        self._gram = np.eye(self._columns.shape[1]) + self._columns.T @ self._columns

    def d_prime(self, signature: Array) -> float:
        """Of a change of the channels [n, c]."""
        white = (signature / self._root).ravel()
        across = self._columns.T @ white
        left = float(white @ white - across @ np.linalg.solve(self._gram, across))
        return float(np.sqrt(max(left, 0.0)))
