"""How far measured and simulated readings are apart, sensor by sensor."""

import numpy as np

from rga.arrays import FloatArray
from rga.findings.arrays import DiagnosisArrays


def percent_off(account: DiagnosisArrays, simulated: FloatArray) -> FloatArray:
    """Measured over simulated by sensor, as percent off.

    The ratio is the slope of the line through the origin that fits measured against simulated, of
    causes that begin late from their onset on.

    Returns:
        float[sensors] [%]; NaN for rejected sensors and where the simulation hardly moves.
    """
    acting = slice(account.since, None)
    measured, simulated = account.record.readings[acting], simulated[acting]
    seen = np.isfinite(measured) & np.isfinite(simulated)
    target, driver = np.where(seen, measured, 0.0), np.where(seen, simulated, 0.0)
    energy = (driver**2).sum(axis=0)
    rows = np.maximum(seen.sum(axis=0), 1)
    slope = (target * driver).sum(axis=0) / np.where(energy > 0, energy, 1.0)
    audible = (energy > 0) & (np.sqrt(energy / rows) > 2 * account.sigma) & ~account.rejected
    return np.where(audible, 100 * (slope - 1), np.nan)


def squares(account: DiagnosisArrays, simulated: FloatArray) -> FloatArray:
    """Squared residual over noise variance, float[rows, sensors]; NaN where there is nothing."""
    present = np.isfinite(account.noise)
    energy = np.where(present, account.noise, 0.0) ** 2
    variance = energy.sum(axis=0) / np.maximum(present.sum(axis=0), 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = (account.record.readings - simulated) ** 2 / variance
    ratio[:, account.rejected] = np.nan
    return np.where(np.isfinite(ratio), ratio, np.nan)


def runs(chosen: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> list[tuple[int, int]]:
    """First and last row of every stretch of chosen rows.

    >>> runs(np.array([True, True, False, True]))
    [(0, 1), (3, 3)]
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]]).astype(int)))
    return [(int(a), int(b) - 1) for a, b in edges.reshape(-1, 2)]
