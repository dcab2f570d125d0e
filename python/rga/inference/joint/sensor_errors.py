"""A simulation with the gains and offsets of its sensors."""

from dataclasses import dataclass, field

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays


@dataclass(frozen=True)
class CorrectedTwin(TwinOnArrays):
    """Readings as sensors of other gains and zeros show them.

    Attributes:
        gains: factors, float[sensors].
        offsets: in the units of the sensors, float[sensors].
    """

    gains: FloatArray = field(default_factory=lambda: np.ones(1))
    offsets: FloatArray = field(default_factory=lambda: np.zeros(1))

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """Readings without noise, float[n, sensors], of contexts, float[n, contexts]."""
        return np.asarray(self.gains * super().simulate(contexts) + self.offsets)

    def jacobian(self, contexts: FloatArray) -> FloatArray:
        """Derivatives by the contexts in their units, float[n, sensors, contexts]."""
        return np.asarray(self.gains[:, None] * super().jacobian(contexts))
