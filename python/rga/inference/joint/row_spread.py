"""How well the contexts of a row are known where structure and sensors are not sure themselves."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.inference.joint.derivatives import derivatives
from rga.inference.joint.measured_contexts import MeasuredContexts
from rga.inference.joint.structural_parameters import Unknowns
from rga.inference.map.standard_units import standard


def row_spread(
    unknowns: Unknowns,
    parameters: tuple[FloatArray, FloatArray, FloatArray],
    root: FloatArray,
    variance: FloatArray,
    contexts: FloatArray,
    observed: NDArray[np.bool_],
    measured: MeasuredContexts,
) -> FloatArray:
    """Posterior standard deviation of the contexts of rows, by Laplace's approximation.

    What structure and sensors are not sure of grows with the load: it counts at the contexts of
    each row, as noise that the sensors of a row have in common.

    Args:
        unknowns: of the structure.
        parameters: unknowns, gains and offsets as found.
        root: of the covariance of unknowns, gains and offsets in their units,
            float[parameters, parameters].
        variance: of what readings differ by beside that, float[rows, sensors].
        contexts: of the rows, float[rows, contexts].
        observed: readings that the contexts were found by, bool[rows, sensors].
        measured: contexts that instruments read at these rows.

    Returns:
        float[rows, contexts] in the units of the contexts.
    """
    _, scale = standard(np.array([one.range for one in unknowns.model.context.values()]))
    at = derivatives(unknowns, contexts, parameters)
    seen = observed[:, :, None]
    unsure = np.where(seen, at.by_parameters @ root, 0.0)
    near = np.where(seen, at.by_contexts * scale, 0.0)
    own = np.where(observed, variance, 1.0)[:, :, None] * np.eye(observed.shape[1])
    noise = unsure @ unsure.transpose(0, 2, 1) + own
    precision = near.transpose(0, 2, 1) @ np.linalg.solve(noise, near)
    own = np.where(np.isfinite(measured.values), (scale / measured.noise) ** 2, 1.0)
    precision += own[:, :, None] * np.eye(len(scale))
    spread = np.sqrt(np.diagonal(np.linalg.inv(precision), axis1=1, axis2=2))
    return np.asarray(spread * scale)
