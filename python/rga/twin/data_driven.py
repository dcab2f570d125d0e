"""The data-driven model: from live readings to the contexts that nothing measures."""

import json
from collections.abc import Callable

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from rga.inference import ContextNetwork, Samples, TrainingSettings, Variables, train
from rga.inference.posterior import covering_factor, laplace_spread
from rga.model.parameter import FloatArray
from rga.twin.messages import R4
from rga.twin.simulation_model import SimulationModel, broken

#: one simulation in so many is held out from training, to measure how far intervals must reach
HELD_OUT = 8
#: rows are inferred in blocks of this size, so that packets of any size give the same bits
BLOCK = 32


class DataDrivenModel:
    """Encoder and context predictor, with what their intervals must be stretched by.

    Args:
        network: what infers.
        simulation: of the version that it learned from.
        faulty: channels that are not looked at, bool[channels].
        noise: standard deviation of channels, then of contexts that are not inferred.
        factor: on the spread of each latent context, float[latent].
    """

    def __init__(
        self,
        network: ContextNetwork,
        simulation: SimulationModel,
        faulty: NDArray[np.bool_],
        noise: FloatArray,
        factor: FloatArray,
    ) -> None:
        self._network, self._simulation = network, simulation
        self._faulty, self._noise, self._factor = faulty, noise, factor

    @classmethod
    def learn(
        cls,
        data: R4,
        latent: tuple[str, ...],
        *,
        noise: FloatArray,
        settings: TrainingSettings,
        seed: int,
        start: "DataDrivenModel | None",
        clock: float,
        progress: Callable[[float], None],
    ) -> "DataDrivenModel":
        """Learn from a data set (R4).

        Args:
            data: simulated and measured rows.
            latent: contexts to infer.
            noise: standard deviation of each channel's noise, float[channels].
            settings: of the training.
            seed: of everything random.
            start: a model to refine; None: from new networks.
            clock: time [s] that effects with an onset go by.
            progress: told the share that is done.
        """
        simulation: SimulationModel = data.simulation
        model = simulation.model
        variables = Variables.of(model, latent)
        faulty = broken(data.readings)
        source = Samples(
            np.where(faulty, 0.0, data.readings),
            data.contexts[:, variables.measured_columns],
            data.contexts[:, variables.latent_columns],
            data.falling if data.falling.any() else None,
        )
        unheld = np.arange(len(source)) % HELD_OUT != HELD_OUT - 1
        told = np.tile(variables.middle, (len(data.real), 1))
        columns = [variables.contexts.index(name) for name in simulation.station.measured]
        told[:, columns] = data.real_contexts
        known = [model.context[name].noise or 0.0 for name in variables.measured]
        level = np.concatenate([noise, known])
        exact = settings.physics == "exact"
        network = train(
            source.rows(unheld),
            Samples(np.where(faulty, np.nan, data.real), told[:, variables.measured_columns]),
            settings,
            variables=variables,
            noise=level,
            seed=seed,
            physics=_physics(simulation, faulty, clock) if exact else None,
            start=None if start is None else start._network,
            progress=progress,
        )
        learned = cls(network, simulation, faulty, level, np.ones(len(latent)))
        learned._stretch(source.rows(~unheld), clock, seed)
        return learned

    def estimate(
        self, first: int, readings: FloatArray, contexts: FloatArray, clock: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """Latent contexts of rows, each from its own readings, and their standard deviations.

        Args:
            first: number of the first row.
            readings: float[n, channels], NaN where missing.
            contexts: all contexts in the order of the model; latent ones are not looked at.
            clock: of the rows [s].

        Returns:
            float[n, latent] each.
        """
        rows, lead = len(readings), first % BLOCK
        within = np.clip(np.arange(-lead, -(-(lead + rows) // BLOCK) * BLOCK - lead), 0, rows - 1)
        blocks = within.reshape(-1, BLOCK)
        parts = [self._estimate(readings[b], contexts[b], clock[b]) for b in blocks]
        wanted = slice(lead, lead + rows)
        value = np.concatenate([part[0] for part in parts])[wanted]
        return value, np.concatenate([part[1] for part in parts])[wanted]

    def to_bytes(self) -> bytes:
        """Everything but the simulation."""
        head = {
            "faulty": self._faulty.tolist(),
            "noise": self._noise.tolist(),
            "factor": self._factor.tolist(),
        }
        return json.dumps(head).encode() + b"\n" + self._network.to_bytes()

    @classmethod
    def from_bytes(cls, content: bytes, simulation: SimulationModel) -> "DataDrivenModel":
        """What `to_bytes` wrote, about the same simulation."""
        head, network = content.split(b"\n", 1)
        known = json.loads(head)
        return cls(
            ContextNetwork.from_bytes(network),
            simulation,
            np.array(known["faulty"], dtype=bool),
            np.array(known["noise"], dtype=float),
            np.array(known["factor"], dtype=float),
        )

    def _estimate(
        self, readings: FloatArray, contexts: FloatArray, clock: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        variables = self._network.variables
        seen = np.where(self._faulty, np.nan, readings)
        measured = contexts[:, variables.measured_columns]
        value = self._network.infer(seen, measured)
        spread = laplace_spread(
            self._simulation.simulator,
            variables,
            measured,
            value,
            np.isfinite(seen),
            self._noise,
            clock,
        )
        return value, spread * self._factor

    def _stretch(self, unseen: Samples, clock: float, seed: int) -> None:
        """Measure on simulations that no training saw how far the intervals must reach."""
        assert unseen.latent is not None
        generator = np.random.default_rng(seed)
        sensors = unseen.readings.shape[1]
        readings = unseen.readings + self._noise[:sensors] * generator.standard_normal(
            unseen.readings.shape
        )
        measured = unseen.measured + self._noise[sensors:] * generator.standard_normal(
            unseen.measured.shape
        )
        contexts = self._network.variables.together(measured, unseen.latent)
        value, spread = self.estimate(0, readings, contexts, np.full(len(unseen), clock))
        self._factor = covering_factor(value - unseen.latent, spread)


def _physics(
    simulation: SimulationModel, faulty: NDArray[np.bool_], clock: float
) -> Callable[[Tensor], Tensor]:
    """The exact simulation as the physics loss takes it: contexts in, readings out."""
    layer = simulation.simulator.as_torch()

    def read(contexts: Tensor) -> Tensor:
        found = contexts.detach().numpy()
        time = np.full(len(found), clock)
        zero = torch.from_numpy(simulation.zero(time[:1], found[:1]))
        readings: Tensor = layer(contexts, time) - zero
        return torch.where(torch.from_numpy(faulty), 0.0, readings)

    return read
