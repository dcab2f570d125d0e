"""The simulator on rows in any order, for a train that goes either way."""

import torch
from torch import Tensor, nn


class EitherWay(nn.Module):
    """Simulates rows as a train that goes forwards, then as one that goes backwards.

    A train is taken as reversed when its position falls from row to row; the rows of a batch
    stand in no order.

    Args:
        simulator: float[n, contexts] -> float[n, sensors], as from `Simulator.as_torch()`.
        column: of the position among the contexts.
    """

    def __init__(self, simulator: nn.Module, column: int) -> None:
        super().__init__()
        self.simulator = simulator
        self.column = column

    def forward(self, contexts: Tensor) -> Tensor:
        """Readings, float[2, n, sensors]; the way backwards stands second."""
        rising = torch.argsort(contexts[:, self.column].detach(), stable=True)
        orders = (rising, rising.flip(0))
        return torch.stack(
            [self.simulator(contexts[order])[torch.argsort(order)] for order in orders]
        )
