"""The simulator as a layer of a network."""

from typing import TYPE_CHECKING, Any

import numpy as np
import torch
from torch import Tensor, nn

from rga.errors import InputError

if TYPE_CHECKING:
    from rga.arrays import FloatArray
    from rga.simulation.simulator import Simulator


class DifferentiableSimulator(nn.Module):
    """A simulator whose backward pass is its adjoint.

    Where effects have memory (lag, friction, a clock), a reading is taken to depend on the
    contexts of its own row alone.

    Args:
        simulator: what predicts and differentiates.
        time: clock of the rows [s], where the model needs one; `forward` may give another.
    """

    def __init__(self, simulator: "Simulator", time: "FloatArray | None" = None) -> None:
        super().__init__()
        self.simulator = simulator
        self.time = time

    def forward(self, contexts: Tensor, time: "FloatArray | None" = None) -> Tensor:
        """Sensor values.

        Args:
            contexts: float64[rows, contexts], all contexts of the model in its order and units.
            time: clock of the rows [s], float[rows].

        Returns:
            float64[rows, sensors] in the units of the sensors, in the order of the model.

        Raises:
            InputError: the contexts have another shape or are not finite.
        """
        names = list(self.simulator.model.context)
        if contexts.ndim != 2 or contexts.shape[1] != len(names):
            raise InputError(
                f"the contexts have the shape {list(contexts.shape)}",
                "the simulator as a module",
                f"give float[rows, {len(names)}], in the order " + ", ".join(names),
            )
        clock = self.time if time is None else time
        readings: Tensor = _Simulation.apply(contexts, self.simulator, clock)
        return readings


class _Simulation(torch.autograd.Function):
    @staticmethod
    def forward(
        ctx: Any, contexts: Tensor, simulator: "Simulator", time: "FloatArray | None"
    ) -> Tensor:
        columns = contexts.detach().double().cpu().numpy().T
        ctx.table = dict(zip(simulator.model.context, columns, strict=True))
        if time is not None:
            ctx.table["time"] = np.asarray(time, dtype=float)
        ctx.simulator = simulator
        return torch.from_numpy(simulator.predict(ctx.table))

    @staticmethod
    @torch.autograd.function.once_differentiable
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor, None, None]:
        of_sensors = gradients[0].detach().double().cpu().numpy()
        return torch.from_numpy(ctx.simulator.pull_back(ctx.table, of_sensors)), None, None
