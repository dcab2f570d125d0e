"""What can happen to some of the sensors from an onset on."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray

#: share of the rows of a spiking sensor that hold a spike
SPIKES = 0.02


@dataclass(frozen=True)
class StreamChange(ABC):
    """A change of `count` sensors.

    Attributes:
        size: in standard deviations of the noise.
        count: sensors that change.
        signed: whether each sensor has a sign of its own, drawn; else all are positive.
    """

    size: float
    count: int = 1
    signed: bool = False

    @abstractmethod
    def change(
        self, rows: FloatArray, earlier: int, last: FloatArray, generator: np.random.Generator
    ) -> FloatArray:
        """What the changed sensors read.

        Args:
            rows: what they would have read, float[n, count].
            earlier: rows between the onset and the first of these.
            last: what they read before the onset, float[count].
            generator: of what the fault itself draws, row by row.
        """

    @property
    def name(self) -> str:
        """What happens, without the number of sensors."""
        return f"{self._words}, signs drawn" if self.signed else self._words

    @property
    @abstractmethod
    def _words(self) -> str: ...


class Step(StreamChange):
    """The mean jumps by the size."""

    def change(
        self, rows: FloatArray, earlier: int, last: FloatArray, generator: np.random.Generator
    ) -> FloatArray:
        return rows + self.size

    @property
    def _words(self) -> str:
        return f"step of {self.size:g} sd"


class Drift(StreamChange):
    """The mean moves by the size with every row."""

    def change(
        self, rows: FloatArray, earlier: int, last: FloatArray, generator: np.random.Generator
    ) -> FloatArray:
        return rows + self.size * np.arange(earlier + 1.0, earlier + 1.0 + len(rows))[:, None]

    @property
    def _words(self) -> str:
        return f"drift of {self.size:g} sd a row"


class Spread(StreamChange):
    """The noise is multiplied by the size."""

    def change(
        self, rows: FloatArray, earlier: int, last: FloatArray, generator: np.random.Generator
    ) -> FloatArray:
        return rows * self.size

    @property
    def _words(self) -> str:
        return f"noise times {self.size:g}"


class Stuck(StreamChange):
    """The sensor repeats what it read last; it has no size."""

    def change(
        self, rows: FloatArray, earlier: int, last: FloatArray, generator: np.random.Generator
    ) -> FloatArray:
        return np.broadcast_to(last, rows.shape)

    @property
    def _words(self) -> str:
        return "stuck at its last value"


class Spikes(StreamChange):
    """Single rows, up or down by the size."""

    def change(
        self, rows: FloatArray, earlier: int, last: FloatArray, generator: np.random.Generator
    ) -> FloatArray:
        lot = generator.random(rows.shape)
        return rows + self.size * ((lot < SPIKES / 2.0) - 1.0 * (lot > 1.0 - SPIKES / 2.0))

    @property
    def _words(self) -> str:
        return f"spikes of {self.size:g} sd in {SPIKES:.0%} of rows"
