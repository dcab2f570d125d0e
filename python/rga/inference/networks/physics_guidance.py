"""Simulations of the rows of one domain, at the contexts that a network infers for them."""

from collections.abc import Callable

import numpy as np
import torch
from torch import Tensor

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.variables import Variables

#: contexts in physical units, float[n, contexts] in the order of the model -> readings,
#: float[n, sensors], or float[ways, n, sensors] where the structure may answer in several ways
Physics = Callable[[Tensor], Tensor]


class Guide:
    """Simulates rows at inferred contexts, one for each candidate, and lets gradients through.

    A simulator is followed along its tangents. They are taken where contexts were last inferred,
    and taken anew from time to time: what a network learns holds for the simulator itself, at the
    cost of a small matrix product a step.

    Args:
        physics: a differentiable simulation, or a simulator of rows that stand alone, of which
            sensors without a finite reading say nothing.
        measured: measured contexts of all rows, float[rows, measured], NaN where missing.
        variables: sensors and contexts.
        ways: of the network.
    """

    def __init__(
        self,
        physics: Physics | TwinOnArrays,
        measured: FloatArray,
        variables: Variables,
        ways: int,
    ) -> None:
        self._physics, self._variables, self._ways = physics, variables, ways
        middle = variables.middle[variables.measured_columns]
        self._measured = torch.from_numpy(np.where(np.isfinite(measured), measured, middle))
        self._order = torch.from_numpy(
            np.argsort([*variables.measured_columns, *variables.latent_columns])
        )

    def look(self, latent: Tensor) -> None:
        """Take the tangents anew.

        Args:
            latent: contexts of all rows in their units, float64[rows, modes, latent].
        """
        if not isinstance(self._physics, TwinOnArrays):
            return
        rows, modes, _ = latent.shape
        contexts = self._contexts(torch.arange(rows), latent).numpy()
        rates = self._physics.jacobian(contexts)[:, :, self._variables.latent_columns]
        readings = self._physics.simulate(contexts)
        self._looked = latent
        self._readings, self._rates = (
            torch.from_numpy(np.nan_to_num(part)).float().view(rows, modes, *part.shape[1:])
            for part in (readings, rates)
        )

    def __call__(self, rows: Tensor, latent: Tensor) -> Tensor:
        """Simulated readings in their units, float[n, modes, sensors].

        Args:
            rows: which ones, int[n].
            latent: their contexts in their units, float64[n, modes, latent].
        """
        if isinstance(self._physics, TwinOnArrays):
            moved = (latent - self._looked[rows]).float()[..., None]
            return self._readings[rows] + (self._rates[rows] @ moved)[..., 0]
        found = self._physics(self._contexts(rows, latent))
        found = found.view(-1, *latent.shape[:2], found.shape[-1])
        # Each candidate is judged by the way that it takes the train to go.
        modes = torch.arange(latent.shape[1])
        return found[modes % self._ways % len(found), :, modes].transpose(0, 1).float()

    def _contexts(self, rows: Tensor, latent: Tensor) -> Tensor:
        """All contexts in the order of the model, float64[n modes, contexts]."""
        measured = self._measured[rows].repeat_interleave(latent.shape[1], 0)
        return torch.cat([measured, latent.flatten(0, 1)], dim=1)[:, self._order]
