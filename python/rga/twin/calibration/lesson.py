"""What an estimator learns from."""

from collections.abc import Callable, Container
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.inference import Rows, TrainingSettings
from rga.twin.calibration.correction import Correction
from rga.twin.messages.queries import R4
from rga.twin.simulation_model import SimulationModel, broken


@dataclass(frozen=True)
class Lesson:
    """What an estimator learns from.

    Attributes:
        data: simulated and measured rows.
        latent: contexts to infer.
        noise: standard deviation of each channel's noise, float[channels]; NaN for one that is
            not to be looked at.
        clock: time [s] that effects with an onset go by.
        seed: of everything random.
        training: of networks.
        progress: called with the share that is done.
        new: first of the measured rows that nothing was learned from yet.
        load_tests: measured rows of which all contexts are known; None: there are none.
    """

    data: R4
    latent: tuple[str, ...]
    noise: FloatArray
    clock: float
    seed: int
    training: TrainingSettings
    progress: Callable[[float], None]
    new: int = 0
    load_tests: Rows | None = None

    @property
    def simulation(self) -> SimulationModel:
        """The simulation model of the version in force."""
        simulation: SimulationModel = self.data.simulation
        return simulation

    def watched(self, known: Container[str] = ()) -> NDArray[np.bool_]:
        """Channels that are looked at: sound in the model, read, with a noise, bool[channels].

        Args:
            known: channels that have been read before.
        """
        read = np.isfinite(self.data.real).any(axis=0)
        read |= np.array([name in known for name in self.simulation.model.sensors], dtype=bool)
        return np.asarray(np.isfinite(self.noise) & ~broken(self.data.readings) & read)

    def rows(self, chosen: NDArray[np.bool_] | slice) -> Self:
        """The same with some of the measured rows, all of them new."""
        real, contexts = self.data.real[chosen], self.data.real_contexts[chosen]
        data = self.data.model_copy(update={"real": real, "real_contexts": contexts})
        return replace(self, data=data, new=0)

    def corrected(self, correction: Correction, noise: FloatArray) -> Self:
        """The same about the corrected twin, with what readings differ by from it as noise.

        Args:
            correction: of structure and sensors.
            noise: float[channels].
        """
        given = self.simulation
        simulation = SimulationModel(given.model, given.station, correction)
        contexts = self.data.contexts
        readings = simulation.readings(np.full(len(contexts), self.clock), contexts)
        data = self.data.model_copy(update={"simulation": simulation, "readings": readings})
        return replace(self, data=data, noise=noise)
