"""Neural posterior estimation, by the package `sbi`."""

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.standard_units import EDGE, standard
from rga.inference.networks.determinism import one_thread
from rga_bench.contexts.method import Estimate, LearningProblem, Rival
from rga_bench.installed import NotInstalledError

#: simulated rows beside the source; passes over all of them at most; samples of a posterior
DRAWS, EPOCHS, SAMPLES = 12_000, 40, 256


@dataclass(frozen=True)
class NeuralPosterior(Rival):
    """A density of contexts in standard units, given readings over their noise.

    Attributes:
        problem: what was learned from.
        twin: what simulates.
        density: what `sbi` trained.
        usual: what stands in for a missing reading, float[sensors].
    """

    problem: LearningProblem
    twin: TwinOnArrays
    density: Any
    usual: FloatArray

    def estimate(self, readings: FloatArray) -> Estimate:
        """Mean and standard deviation of samples, which are kept to the ranges."""
        middle, scale = standard(self.twin.ranges)
        if not len(readings):
            return Estimate(np.empty((0, len(scale))), np.empty((0, len(scale))))
        filled = np.where(np.isfinite(readings), readings, self.usual) / self.problem.noise
        given = torch.as_tensor(filled, dtype=torch.float32)
        with torch.random.fork_rng(devices=[]), one_thread(), torch.no_grad():
            torch.manual_seed(self.problem.seed)
            drawn = self.density.sample((SAMPLES,), condition=given).double().numpy()
        drawn = np.clip(drawn, -EDGE, EDGE)
        return Estimate(middle + scale * drawn.mean(axis=0), scale * drawn.std(axis=0))

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the model simulates, float[n, sensors]."""
        return self.twin.simulate(contexts)


def neural_posterior(problem: LearningProblem) -> NeuralPosterior:
    """A masked autoregressive flow (Papamakarios and Murray, NeurIPS 2016), with `sbi`'s defaults.

    Raises:
        NotInstalledError: `sbi` is not there.
    """
    try:
        from sbi.inference import NPE
        from sbi.utils import BoxUniform
    except ImportError:
        raise NotInstalledError("sbi is not installed") from None
    twin = TwinOnArrays(problem.simulator)
    middle, scale = standard(twin.ranges)
    rng = np.random.default_rng(problem.seed)
    drawn = middle + scale * rng.uniform(-EDGE, EDGE, (DRAWS, len(scale)))
    contexts = np.vstack([problem.source.contexts, drawn])
    shown = np.vstack([problem.source.readings, twin.simulate(drawn)])
    noisy = shown / problem.noise + rng.standard_normal(shown.shape)
    edge = torch.full((len(scale),), EDGE)
    with torch.random.fork_rng(devices=[]), one_thread():
        torch.manual_seed(problem.seed)
        learner = NPE(
            BoxUniform(-edge, edge),
            density_estimator="maf",
            tracker=_Silent(),
            show_progress_bars=False,
        )
        learner.append_simulations(
            torch.as_tensor((contexts - middle) / scale, dtype=torch.float32),
            torch.as_tensor(noisy, dtype=torch.float32),
        )
        with warnings.catch_warnings():
            # The passes are bounded so that the same seed trains alike on every machine.
            warnings.filterwarnings("ignore", message="Maximum number of epochs")
            density = learner.train(max_num_epochs=EPOCHS, show_train_summary=False)
    return NeuralPosterior(problem, twin, density.eval(), problem.source.readings.mean(axis=0))


class _Silent:
    """Keeps no log of a training: by default `sbi` writes one where it runs."""

    log_dir = None

    def log_metric(self, name: str, value: float, step: int | None = None) -> None: ...

    def log_metrics(self, metrics: dict[str, float], step: int | None = None) -> None: ...

    def log_params(self, params: dict[str, Any]) -> None: ...

    def add_figure(self, name: str, figure: Any, step: int | None = None) -> None: ...

    def flush(self) -> None: ...
