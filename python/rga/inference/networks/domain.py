"""What makes features of simulated and of real rows alike: an adversary, or their covariances."""

import torch
from torch import Tensor, nn

from rga.inference.networks.gradient_reversal import reverse_gradient
from rga.inference.networks.layers import DomainDiscriminator


class Adversary(nn.Module):
    """Cross-entropy of a discriminator behind gradient reversal.

    Ganin et al., Domain-adversarial training of neural networks, JMLR 17 (2016).

    Args:
        features: number of features.
        width: of the hidden layer.
    """

    def __init__(self, features: int, width: int) -> None:
        super().__init__()
        self.discriminator = DomainDiscriminator(features, width)

    def forward(self, source: Tensor, target: Tensor, strength: float) -> Tensor:
        """The loss of as many features of simulated rows as of real ones, float[n, features].

        Args:
            source, target: features.
            strength: how strongly the encoder works against the discriminator [-].
        """
        both = reverse_gradient(torch.cat([source, target]), strength)
        domain = torch.cat([torch.zeros(len(source)), torch.ones(len(target))])
        crossed: Tensor = nn.functional.binary_cross_entropy_with_logits(
            self.discriminator(both), domain
        )
        return crossed


class Coral(nn.Module):
    """Distance of the covariances of features; it has no weights of its own.

    Sun and Saenko, Deep CORAL: correlation alignment for deep domain adaptation, ECCV workshops
    (2016), equation 1: the squared Frobenius norm over 4 d^2.

    >>> rows = torch.tensor([[1.0, 0.0], [-1.0, 0.0]])
    >>> Coral()(rows, rows + 5.0, 1.0).item(), Coral()(rows, rows.flip(1), 1.0).item()
    (0.0, 0.5)
    """

    def forward(self, source: Tensor, target: Tensor, strength: float) -> Tensor:
        """The loss of features, float[n, features] and float[m, features]; weighs by strength."""
        apart = torch.cov(source.T) - torch.cov(target.T)
        return strength * apart.square().sum() / (4.0 * source.shape[1] ** 2)
