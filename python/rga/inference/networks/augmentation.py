"""What reality does to a reading that a simulation does not."""

import torch
from torch import Tensor

from rga.inference.networks.settings import TrainingSettings


class Corruption:
    """Noise, gains, missing and broken channels, drawn afresh for every batch.

    Args:
        noise: standard deviation of each channel, float[channels].
        centre, spread: of each channel over the source, float[channels].
        gains: bool[channels], channels that a gain may act on: the sensors.
        settings: dropout, faults and gain.
        generator: what all draws come from.
    """

    def __init__(
        self,
        noise: Tensor,
        centre: Tensor,
        spread: Tensor,
        gains: Tensor,
        settings: TrainingSettings,
        generator: torch.Generator,
    ) -> None:
        self._noise, self._centre, self._spread = noise, centre, spread
        self.gain = settings.gain * gains
        self._settings, self._generator = settings, generator

    def __call__(self, channels: Tensor) -> Tensor:
        """Channels as a logger might have recorded them, NaN where missing, float[n, channels]."""
        normal = torch.randn(2, *channels.shape, generator=self._generator)
        out = channels * (1.0 + self.gain * normal[0]) + self._noise * normal[1]
        chance, size = torch.rand(2, *channels.shape, generator=self._generator)
        broken = self._centre + 6.0 * self._spread * (size - 0.5)
        gone = chance < self._settings.dropout
        wrong = ~gone & (chance < self._settings.dropout + self._settings.faults)
        return torch.where(gone, torch.nan, torch.where(wrong, broken, out))
