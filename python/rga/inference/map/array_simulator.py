"""A simulator on tables of contexts as numbers."""

from dataclasses import dataclass, field

import numpy as np

from rga.arrays import FloatArray
from rga.simulation import Simulator


@dataclass(frozen=True)
class TwinOnArrays:
    """A simulator of which all contexts are latent, with contexts as one table.

    Attributes:
        simulator: of the model.
        time: clock [s] that effects with an onset go by; None where there are none.
    """

    simulator: Simulator
    time: float | None = field(default=None, kw_only=True)

    @property
    def ranges(self) -> FloatArray:
        """Smallest and largest of each context, float[contexts, 2]."""
        return np.array([one.range for one in self.simulator.model.context.values()])

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """Readings without noise, float[n, sensors], of contexts, float[n, contexts]."""
        if not len(contexts):
            return np.zeros((0, len(self.simulator.model.sensors)))
        return self.simulator.predict(self._named(contexts))

    def jacobian(self, contexts: FloatArray) -> FloatArray:
        """Derivatives by the contexts in their units, float[n, sensors, contexts]."""
        if not len(contexts):
            return np.zeros((0, len(self.simulator.model.sensors), contexts.shape[1]))
        return self.simulator.jacobian(self._named(contexts))

    def _named(self, contexts: FloatArray) -> dict[str, FloatArray]:
        table = dict(zip(self.simulator.model.context, contexts.T, strict=True))
        return table if self.time is None else {**table, "time": np.full(len(contexts), self.time)}
