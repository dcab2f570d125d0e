"""Modes from several starts: position and eccentricity have more than one under a light crowd."""

import numpy as np

from rga.inference.posterior_mode import Mode, posterior_mode, standard
from rga.inference.rows import Rows
from rga.inference.twin_on_arrays import TwinOnArrays
from rga.inference.whitening import Whitening
from rga.model.parameter import FloatArray

#: starts of a row, and steps after which the best of them goes on alone
STARTS, FIRST = 4, 4


def best_mode(
    twin: TwinOnArrays, readings: FloatArray, covariance: FloatArray, source: Rows
) -> Mode:
    """The best mode reached from the simulated rows that are most alike.

    Args:
        twin: what simulates.
        readings: float[n, sensors]; a reading that is not finite is left out.
        covariance: of the sensors, float[sensors, sensors].
        source: simulated rows.
    """
    near = nearest(readings, covariance, source, twin.ranges, STARTS)
    many = near.shape[1]
    tried = posterior_mode(
        twin.simulate,
        twin.jacobian,
        np.repeat(readings, many, axis=0),
        covariance,
        twin.ranges,
        near.reshape(-1, near.shape[2]),
        FIRST,
    )
    best = np.arange(len(readings)) * many
    if many:
        best += tried.misfit.reshape(-1, many).argmin(axis=1)
    return posterior_mode(
        twin.simulate, twin.jacobian, readings, covariance, twin.ranges, tried.value[best]
    )


def nearest(
    readings: FloatArray, covariance: FloatArray, source: Rows, ranges: FloatArray, many: int
) -> FloatArray:
    """Contexts of the source rows of the highest posterior, float[n, many, contexts]."""
    middle, scale = standard(ranges)
    cost = (((source.contexts - middle) / scale) ** 2).sum(axis=1)
    seen = np.isfinite(readings)
    filled, rows = np.where(seen, readings, 0.0), np.arange(len(readings))
    many = min(many, len(source.contexts))
    found = np.empty((len(readings), many, len(scale)))
    for chosen, root in Whitening(covariance, seen).parts(rows):
        sought, had = filled[chosen] @ root.T, source.readings @ root.T
        far = cost + (had**2).sum(axis=1) - 2.0 * sought @ had.T
        found[chosen] = source.contexts[np.argpartition(far, many - 1, axis=1)[:, :many]]
    return found
