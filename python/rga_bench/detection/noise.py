"""Worlds of noise, of mean 0 and variance 1 at every sensor."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from rga.arrays import FloatArray


@dataclass(frozen=True)
class StationaryNoise:
    """Stationary noise of variance 1.

    Attributes:
        name: in tables.
        memory: coefficient of AR(1).
        freedom: degrees of freedom of Student's t; 0: normal.
        shared: correlation of any two sensors.
    """

    name: str
    memory: float = 0.0
    freedom: float = 0.0
    shared: float = 0.0


WHITE = StationaryNoise("white")
WORLDS = (
    WHITE,
    StationaryNoise("AR(1) 0.3", memory=0.3),
    StationaryNoise("AR(1) 0.6", memory=0.6),
    StationaryNoise("Student's t5", freedom=5.0),
    StationaryNoise("correlated 0.5", shared=0.5),
)


class NoiseSource:
    """Rows of noise, the same ones in blocks of any size.

    Args:
        noise: the world.
        sensors: in a row.
        seed: of the rows.
    """

    def __init__(self, noise: StationaryNoise, sensors: int, seed: np.random.SeedSequence) -> None:
        self._noise, self._sensors = noise, sensors
        self._generator = np.random.default_rng(seed)
        # The filter's state at which its first row has the variance of all others.
        self._state = noise.memory / np.sqrt(1.0 - noise.memory**2) * self._fresh(1)

    def take(self, rows: int) -> FloatArray:
        """The next rows, float[rows, sensors]."""
        memory = self._noise.memory
        fresh = self._fresh(rows)
        if not memory:
            return fresh
        drawn, self._state = lfilter([1.0], [1.0, -memory], fresh, axis=0, zi=self._state)
        return np.asarray(drawn * np.sqrt(1.0 - memory**2))

    def _fresh(self, rows: int) -> FloatArray:
        """Rows without memory."""
        shared, freedom = self._noise.shared, self._noise.freedom
        shape = (rows, self._sensors + bool(shared))
        if freedom:
            drawn = self._generator.standard_t(freedom, shape) * math.sqrt(1.0 - 2.0 / freedom)
        else:
            drawn = self._generator.standard_normal(shape)
        if not shared:
            return np.asarray(drawn)
        return np.asarray(math.sqrt(1.0 - shared) * drawn[:, 1:] + math.sqrt(shared) * drawn[:, :1])
