"""What the logger's zero is off: the noise of its rows, and the errors of the contexts there.

The mean over a few rows is not free of noise. What is left of it stays on the channel in every row,
and what the contexts were off in those rows stays on all channels together.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.noise.row_covariance import Noise
from rga.simulation import Simulator

#: difference of a derivative by a context, in its range: above rounding, below curvature
STEP = 1e-3


@dataclass(frozen=True)
class ZeroErrors:
    """Errors of the zero, each a constant of the channels over all rows.

    Attributes:
        patterns: over the channels, float[errors, sensors].
        spread: prior standard deviation of each, float[errors].
        measured: of each, True for noise of the sensors and of contexts that were measured.
    """

    patterns: FloatArray
    spread: FloatArray
    measured: NDArray[np.bool_]

    def of_rows(self, rows: int) -> list[tuple[FloatArray, float]]:
        """The errors in so many rows, float[rows, sensors], with their spread."""
        return [
            (np.tile(pattern, (rows, 1)), float(spread))
            for pattern, spread in zip(self.patterns, self.spread, strict=True)
        ]

    @property
    def variance(self) -> FloatArray:
        """Variance that errors of measurement give every reading of a channel, float[sensors]."""
        sizes = (self.patterns * self.spread[:, None])[self.measured]
        return np.asarray((sizes**2).sum(0))


def zero_errors(simulator: Simulator, data: Data, noise: Noise) -> ZeroErrors:
    """The errors of a record's zero; none where nothing was taken off.

    Args:
        simulator: the simulation.
        data: readings and belief.
        noise: of sensors and contexts.
    """
    belief, sensors = data.belief, len(data.sensors)
    if not len(data.tare):
        return ZeroErrors(np.zeros((0, sensors)), np.zeros(0), np.zeros(0, dtype=bool))
    counts = data.tare.counts[data.columns]
    tared = counts > 0
    # Noise with memory averages out more slowly, and never less than not at all.
    slowly = np.sqrt((1 + noise.phi) / (1 - noise.phi) / np.maximum(counts, 1))
    patterns = list(np.eye(sensors)[tared])
    spread = list((noise.deviation * np.minimum(slowly, 1.0))[tared])
    measured = [True] * len(patterns)
    slopes = slopes_at_zero(simulator, data)
    for number, name in enumerate(belief.spread):
        pattern = data.taken_off(slopes[name])
        if not pattern.any():
            continue
        patterns.append(pattern)
        if name in belief.latent:
            # Nothing says where in its range it was.
            spread.append(belief.spread[name])
        else:
            spread.append(float(noise.context_sigma[number]) / np.sqrt(data.tare.rows))
        measured.append(name not in belief.latent)
    return ZeroErrors(np.array(patterns), np.array(spread), np.array(measured))


def slopes_at_zero(simulator: Simulator, data: Data) -> dict[str, FloatArray]:
    """Derivatives by uncertain contexts in the zero rows, float[zero rows, sensors] each."""
    found = {}
    for name in data.belief.spread if len(data.tare) else ():
        low, high = simulator.model.context[name].range
        step = STEP * (high - low)
        ahead = data.at_zero(simulator, {name: np.array(step)})
        behind = data.at_zero(simulator, {name: np.array(-step)})
        found[name] = (ahead - behind) / (2 * step)
    return found
