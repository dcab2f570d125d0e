"""Rows of which the contexts are known."""

from dataclasses import dataclass

from rga.arrays import FloatArray


@dataclass(frozen=True)
class Rows:
    """Contexts and readings side by side: simulated rows, or load tests.

    Attributes:
        contexts: in the order and the units of the model, float[n, contexts].
        readings: in the order and the units of the model's sensors, float[n, sensors].
    """

    contexts: FloatArray
    readings: FloatArray

    def __len__(self) -> int:
        return len(self.readings)
