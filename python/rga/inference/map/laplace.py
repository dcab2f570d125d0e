"""How well an inferred context is known: Laplace's approximation, scaled until it covers."""

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.variables import Variables
from rga.simulation import Simulator

LEVEL = 0.9
#: a channel further off than this, in spreads of its row, is broken and says nothing of the model
BROKEN = 10.0


def laplace_spread(
    simulator: Simulator,
    variables: Variables,
    measured: FloatArray,
    latent: FloatArray,
    observed: NDArray[np.bool_],
    noise: FloatArray,
    time: FloatArray | None = None,
) -> FloatArray:
    """Posterior standard deviation of each latent context by Laplace's approximation.

    The posterior precision of a row is J' S^-1 J + P^-1: J the derivatives of the sensors by the
    latent contexts, S the variance of the noise with what the noise of the measured contexts adds,
    P the variance of a context spread evenly over its range.

    Args:
        simulator: of the model.
        variables: sensors and contexts.
        measured, latent: contexts at which to linearise, float[n, measured], float[n, latent].
        observed: bool[n, sensors], False where a reading is missing.
        noise: standard deviation of every sensor, then of every measured context, in their units,
            float[sensors + measured].
        time: clock of the rows [s], where the model needs it.

    Returns:
        float[n, latent] in the units of the contexts.

    Raises:
        InputError: a context is not finite.
    """
    contexts = variables.together(measured, latent)
    table = dict(zip(variables.contexts, contexts.T, strict=True))
    if time is not None:
        table["time"] = time
    sensors = len(variables.sensors)
    # Contexts in shares of their ranges: kelvin and pascal side by side would spoil the inverse.
    jacobian = np.where(observed[:, :, None], simulator.jacobian(table) * variables.width, 0.0)
    noisy = jacobian[:, :, variables.measured_columns] * (
        noise[sensors:] / variables.width[variables.measured_columns]
    )
    sigma = np.maximum(noise[:sensors], 1e-12 * (1.0 + np.abs(jacobian).max((0, 2), initial=0.0)))
    sought = jacobian[:, :, variables.latent_columns] / sigma[:, None]
    noisy = noisy / sigma[:, None]
    # Woodbury: the few measured contexts are projected off, no row asks for a sensors^2 matrix.
    cross = noisy.transpose(0, 2, 1) @ sought
    inner = noisy.transpose(0, 2, 1) @ noisy + np.eye(noisy.shape[2])
    precision = sought.transpose(0, 2, 1) @ sought - cross.transpose(0, 2, 1) @ np.linalg.solve(
        inner, cross
    )
    covariance = np.linalg.inv(precision + 12.0 * np.eye(sought.shape[2]))
    share = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2))
    return np.asarray(share * variables.width[variables.latent_columns])


def covering_factor(errors: FloatArray, spreads: FloatArray, level: float = LEVEL) -> FloatArray:
    """Factor on spreads that makes their central intervals cover (split conformal).

    Lei et al., Distribution-free predictive inference for regression, JASA 113 (2018).

    Args:
        errors: inferred less true contexts of rows that no training has seen, float[n, latent].
        spreads: standard deviations stated for them, float[n, latent].
        level: share of the errors that the normal interval of that level is to hold.

    Returns:
        float[latent].

    Raises:
        InputError: too few rows for the level.

    >>> errors = np.linspace(-2, 2, 41)[:, None]
    >>> float(covering_factor(errors, np.ones_like(errors))[0] * ndtri(0.95))
    1.9
    """
    rows = len(errors)
    rank = int(np.ceil((rows + 1) * level))
    if rank > rows:
        remedy = f"give {int(np.ceil(level / (1 - level)))} rows or more"
        raise InputError(f"{rows} rows are too few", "calibration of intervals", remedy)
    ratio = np.sort(np.abs(errors) / spreads, axis=0)[rank - 1]
    return np.asarray(ratio / ndtri(0.5 + level / 2))


def birge_ratio(gaps: FloatArray, noise: FloatArray) -> FloatArray:
    """Factor on the spreads of a row whose gap its noise does not explain (Birge, 1932).

    A model that is wrong pulls its contexts along; how far, the gap that stays shows. One broken
    channel is not held against a row, as the networks learned to pass it over.

    Args:
        gaps: squared differences of measured and simulated, float[rows, channels], NaN where
            missing.
        noise: standard deviation of each channel's noise, NaN for one that is not looked at.

    Returns:
        float[rows], 1 or more.

    >>> birge_ratio(np.array([[1.0, 0.5], [4.0, 4.0], [np.nan, np.nan]]), np.ones(2))
    array([1., 2., 1.])
    """
    scaled = gaps / noise**2
    rows = np.isfinite(scaled).any(axis=1)
    own = scaled[rows]
    usual = np.maximum(np.nanmedian(own, axis=1, keepdims=True), 1.0)
    ratio = np.ones(len(gaps))
    ratio[rows] = np.sqrt(np.maximum(np.nanmean(np.minimum(own, BROKEN**2 * usual), axis=1), 1.0))
    return ratio
