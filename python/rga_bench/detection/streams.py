"""A stream of residuals: noise, and from an onset on a fault."""

import numpy as np

from rga.arrays import FloatArray
from rga_bench.detection.faults import StreamChange
from rga_bench.detection.noise import NoiseSource, StationaryNoise


class ResidualStream:
    """Rows of noise, and of a fault from the onset on; the same ones in blocks of any size.

    Which sensors change is drawn.

    Args:
        noise: the world.
        sensors: in a row.
        seed: of all that is drawn; the noise is the same for every fault.
        fault: what happens; None: nothing.
        onset: rows before it.
    """

    def __init__(
        self,
        noise: StationaryNoise,
        sensors: int,
        seed: np.random.SeedSequence,
        fault: StreamChange | None = None,
        onset: int = 0,
    ) -> None:
        # Children by number, and not by `spawn`, which would change the seed.
        own, other = (
            np.random.SeedSequence(seed.entropy, spawn_key=(*seed.spawn_key, number))
            for number in range(2)
        )
        self._source = NoiseSource(noise, sensors, own)
        self._fault, self._onset, self._taken = fault, onset, 0
        if fault is None:
            return
        self._generator = np.random.default_rng(other)
        self._changed = self._generator.choice(sensors, fault.count, replace=False)
        signs = self._generator.choice([-1.0, 1.0], fault.count)
        self._signs = signs if fault.signed else np.ones(fault.count)
        self._last = np.zeros(fault.count)

    def take(self, count: int) -> FloatArray:
        """The next rows, float[count, sensors]."""
        rows = self._source.take(count)
        sound = min(max(self._onset - self._taken, 0), count)
        earlier = self._taken + sound - self._onset
        self._taken += count
        if self._fault is None:
            return rows
        if sound:
            self._last = rows[sound - 1, self._changed] * self._signs
        if sound < count:
            # Noise is symmetric, so that a sensor can be turned over, changed and turned back.
            turned = rows[sound:, self._changed] * self._signs
            faulty = self._fault.change(turned, earlier, self._last, self._generator)
            rows[sound:, self._changed] = faulty * self._signs
        return rows
