"""Layers of the networks: reversed gradients, channels that are missing or far off."""

import torch

from rga.inference.networks.gradient_reversal import reverse_gradient
from rga.inference.networks.layers import Encoder


def test_reversal_is_minus_the_gradient() -> None:
    features = torch.randn(4, 3, generator=torch.Generator().manual_seed(1), dtype=torch.float64)
    features.requires_grad_()
    forward = torch.autograd.grad(features.sin().sum(), features)[0]
    backward = torch.autograd.grad(reverse_gradient(features, 0.7).sin().sum(), features)[0]
    assert torch.allclose(backward, -0.7 * forward)
    assert torch.equal(reverse_gradient(features, 0.7), features)
    # Twice reversed is the plain gradient, which finite differences know.
    assert torch.autograd.gradcheck(
        lambda x: reverse_gradient(reverse_gradient(x, 1.0).sin(), 1.0), (features,)
    )


def test_a_channel_far_off_is_a_missing_channel() -> None:
    encoder = Encoder(3, 4, 2)
    rows = torch.tensor([[1.0, 2.0, 1e9], [1.0, 2.0, -torch.inf], [1.0, 2.0, torch.nan]])
    off, infinite, missing = encoder.standardise(rows)
    assert torch.allclose(off, missing, atol=1e-6)
    assert torch.equal(infinite, missing)
    assert torch.allclose(missing, torch.tensor([1.0, 2.0, 0.0, 0.0, 0.0, 1.0]), atol=1e-4)
