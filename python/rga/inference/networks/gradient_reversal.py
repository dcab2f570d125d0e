"""Gradient reversal: the identity on the way forward, its opposite on the way back.

Ganin et al., Domain-adversarial training of neural networks, JMLR 17 (2016), section 4.2.
"""

from typing import Any

import torch
from torch import Tensor


class _Reversal(torch.autograd.Function):
    @staticmethod
    def forward(ctx: Any, features: Tensor, strength: float) -> Tensor:
        ctx.strength = strength
        return features.view_as(features)

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor, None]:
        return -ctx.strength * gradients[0], None


def reverse_gradient(features: Tensor, strength: float) -> Tensor:
    """The features themselves; their gradient comes back times minus the strength.

    Args:
        features: of any shape.
        strength: how strongly the encoder works against the discriminator [-].

    >>> features = torch.ones(2, requires_grad=True)
    >>> reverse_gradient(features, 0.5).sum().backward()
    >>> features.grad
    tensor([-0.5000, -0.5000])
    """
    reversed_features: Tensor = _Reversal.apply(features, strength)
    return reversed_features
