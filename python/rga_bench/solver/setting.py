"""How much is measured, and on what."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray


@dataclass(frozen=True)
class SolverSetting:
    """How much is measured, and on what.

    Attributes:
        rows: samples of a batch: large enough to leave the caches, as a data set does.
        seconds: that a figure is measured for.
        panels: along a side of the double-layer grids.
        data_set: rows that are written.
        seed: of structures, loads and samples.
        judged: whether figures are held against their targets.
    """

    rows: int = 262_144
    seconds: float = 1.0
    panels: tuple[int, ...] = (64, 204)
    data_set: int = 10_000_000
    seed: int = 0
    judged: bool = True

    def draw(self, rows: int, columns: int) -> FloatArray:
        """Numbers from -1 to 1, float[rows, columns]."""
        return np.random.default_rng([self.seed, columns]).uniform(-1.0, 1.0, (rows, columns))


def shorter(seed: int) -> SolverSetting:
    """What takes less than a minute: too short to judge by."""
    return SolverSetting(16_384, 1.0 / 16.0, (24,), 100_000, seed, judged=False)
