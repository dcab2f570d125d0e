"""The losses of context and physics."""

import torch
from torch import Tensor

from rga.inference.networks.layers import Mixture

#: residuals of so many scales begin to count less
ROBUST = 3.0
#: half as much again as a range in standard units; farther contexts are drawn back
REACH = 1.5 * 3.0**0.5


def excess(value: Tensor) -> Tensor:
    """How far contexts in standard units lie beyond half as much again as their range."""
    return (value.abs() - REACH).clamp(min=0.0)


def context_loss(mixture: Mixture, wanted: Tensor, backwards: Tensor, ways: int) -> Tensor:
    """Minus the log likelihood of the contexts under the candidates, a context.

    Args:
        mixture: candidates.
        wanted: float[n, contexts], in standard units.
        backwards: int[n], 1 where a train goes backwards: candidates of that way answer for it.
        ways: 2 if candidates take it to go forwards and backwards in turn, else 1.
    """
    off = (wanted[:, None] - mixture.value) * torch.exp(-mixture.log_spread)
    each = mixture.log_share - (0.5 * off.square() + mixture.log_spread).sum(2)
    if ways == 2:
        own = torch.arange(each.shape[1]) % 2 == backwards[:, None]
        each = torch.where(own, each, -torch.inf)
    return -each.logsumexp(1).mean() / wanted.shape[1]


def physics_loss(simulated: Tensor, measured: Tensor, scale: Tensor) -> Tensor:
    """Robust mismatch of simulations and readings, a mean over the sensors that were observed.

    Half the squared residual where it is small, its logarithm where it is large: neither a broken
    channel nor a place where the model is wrong rules the rest.

    Args:
        simulated: float[n, modes, sensors].
        measured: float[n, 1, sensors], NaN where missing.
        scale: of a residual, float[sensors].

    Returns:
        float[n, modes].
    """
    seen = torch.isfinite(measured)
    residual = torch.where(seen, (simulated - torch.nan_to_num(measured)) / scale, 0.0)
    each = 0.5 * ROBUST**2 * torch.log1p((residual / ROBUST).square())
    return each.sum(2) / seen.sum(2).clamp(min=1)
