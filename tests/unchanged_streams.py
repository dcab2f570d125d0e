"""Streams in which nothing changes, for tests of the monitor."""

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

Rows = NDArray[np.float64]

SENSORS = 6
BASELINE = 400
MISSING = float("nan")
WORLDS = ("white", "memory", "heavy tails", "correlated", "skewed", "all")


def noise(world: str, rows: int, seed: int) -> Rows:
    """Readings float[rows, SENSORS] of a world."""
    generator = np.random.default_rng(seed)
    found = generator.normal(size=(rows + 50, SENSORS))
    if world == "heavy tails":
        found = generator.standard_t(5, size=found.shape)
    if world == "skewed":
        found = found**2
    if world in ("correlated", "all"):
        found = found + generator.normal(size=(len(found), 1))
    if world in ("memory", "all"):
        found = lfilter([1.0], [1.0, -0.6], found, axis=0)
    return np.asarray(found[50:])
