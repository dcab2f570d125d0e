"""CORAL and DANN, by the package `skada`."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.standard_units import EDGE, standard
from rga.inference.networks.determinism import one_thread
from rga.twin.calibration.lesson import Lesson
from rga_bench.contexts.method import Estimate, LearningProblem, Rival
from rga_bench.installed import NotInstalledError

#: units of a layer, passes over the rows, rows of a batch, weight of the adaptation, rate
UNITS, EPOCHS, BATCH, WEIGHT, RATE = 128, 150, 128, 0.1, 1e-3


@dataclass(frozen=True)
class Adapted(Rival):
    """A regressor that learned from source rows adapted to the measured ones.

    Attributes:
        problem: what was learned from.
        twin: what simulates.
        regress: readings over their noise -> contexts in standard units.
        usual: what stands in for a missing reading, float[sensors].
        learn: what learned this from the problem.
    """

    problem: LearningProblem
    twin: TwinOnArrays
    regress: Callable[[FloatArray], FloatArray]
    usual: FloatArray
    learn: Callable[[LearningProblem], "Adapted"]

    def estimate(self, readings: FloatArray) -> Estimate:
        """Contexts of measured rows, float[n, sensors]; without spread."""
        middle, scale = standard(self.twin.ranges)
        if not len(readings):
            return Estimate(np.empty((0, len(scale))), None)
        found = self.regress(_filled(readings, self.usual) / self.problem.noise)
        return Estimate(middle + scale * np.clip(found, -EDGE, EDGE), None)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """What the model simulates, float[n, sensors]."""
        return self.twin.simulate(contexts)

    def refined(self, lesson: Lesson) -> "Adapted":
        """Learned anew from all measured rows of a lesson."""
        return self.learn(LearningProblem.of(lesson))


def skada_coral(problem: LearningProblem) -> Adapted:
    """`skada`'s `CORALAdapter` (Sun, Feng and Saenko, 2017), then a perceptron of scikit-learn.

    `skada`'s own pipeline takes one target a row at most, so that the adapter is used by itself.

    Raises:
        NotInstalledError: `skada` is not there.
    """
    try:
        from skada import CORALAdapter
        from sklearn.exceptions import ConvergenceWarning
        from sklearn.neural_network import MLPRegressor
    except ImportError:
        raise NotInstalledError("skada is not installed") from None
    shown, domain, wanted = _rows(problem)
    adapter = CORALAdapter()
    adapted = adapter.fit_transform(shown, sample_domain=domain)
    center = adapter.mean_target_
    size = adapted[domain > 0].std(axis=0)
    perceptron = MLPRegressor(
        hidden_layer_sizes=(UNITS, UNITS), max_iter=EPOCHS, random_state=problem.seed % 2**32
    )
    with one_thread(), warnings.catch_warnings():
        warnings.simplefilter("ignore", ConvergenceWarning)  # the passes are bounded
        perceptron.fit(adapted[domain > 0] / size, wanted)
    return _adapted(problem, lambda given: perceptron.predict((given - center) / size), skada_coral)


def skada_dann(problem: LearningProblem) -> Adapted:
    """`skada`'s `DANN` (Ganin et al., JMLR 17, 2016).

    It knows classes only: labels are the numbers of source rows, and the criterion looks up the
    contexts that belong to them. Its default domain classifier ends in a softmax over one class,
    which is one whatever it sees; here it ends in a sigmoid.

    Raises:
        NotInstalledError: `skada` is not there.
    """
    try:
        from skada.deep import DANN
        from skada.deep.modules import DomainClassifier
    except ImportError:
        raise NotInstalledError("skada is not installed") from None
    shown, domain, wanted = _rows(problem)
    center, size = shown[domain > 0].mean(axis=0), shown[domain > 0].std(axis=0)
    inputs = ((shown - center) / size).astype(np.float32)
    number = np.where(domain > 0, np.cumsum(domain > 0) - 1, -1)
    with torch.random.fork_rng(devices=[]), one_thread():
        torch.manual_seed(problem.seed)
        judge = DomainClassifier(num_features=UNITS)
        judge.classifier[-1] = nn.Sigmoid()
        network = DANN(
            _Regressor(shown.shape[1], wanted.shape[1]),
            reg=WEIGHT,
            layer_name="features",
            domain_classifier=judge,
            base_criterion=_OfRows(torch.as_tensor(wanted, dtype=torch.float32)),
            batch_size=BATCH,
            max_epochs=EPOCHS,
            lr=RATE,
            optimizer=torch.optim.Adam,
            train_split=None,
            iterator_train__drop_last=True,
            classes=list(range(-1, len(wanted))),
            predict_nonlinearity=None,
            verbose=0,
        )
        network.fit(inputs, number, sample_domain=domain)
        module = network.module_.base_module_.eval()

    def regress(given: FloatArray) -> FloatArray:
        with torch.no_grad():
            found: Tensor = module(torch.as_tensor((given - center) / size, dtype=torch.float32))
        return found.double().numpy()

    return _adapted(problem, regress, skada_dann)


class _Regressor(nn.Module):
    """Two layers, of which the last is named, and a linear one; weights of rows are not used."""

    def __init__(self, sensors: int, contexts: int) -> None:
        super().__init__()
        first, second = nn.Linear(sensors, UNITS), nn.Linear(UNITS, UNITS)
        self.features = nn.Sequential(first, nn.ReLU(), second, nn.ReLU())
        self.last = nn.Linear(UNITS, contexts)

    def forward(self, inputs: Tensor, sample_weight: Tensor | None = None) -> Tensor:
        out: Tensor = self.last(self.features(inputs))
        return out


class _OfRows(nn.Module):
    """Mean squared error to the contexts of source rows, of which the numbers are given."""

    def __init__(self, contexts: Tensor) -> None:
        super().__init__()
        self.contexts = contexts

    def forward(self, found: Tensor, numbers: Tensor) -> Tensor:
        return nn.functional.mse_loss(found, self.contexts[numbers.long()])


def _rows(problem: LearningProblem) -> tuple[FloatArray, Any, FloatArray]:
    """Noisy source rows, then measured ones, over their noise; their domain; source contexts."""
    middle, scale = standard(problem.ranges)
    rng = np.random.default_rng(problem.seed)
    source = problem.source.readings
    noisy = source / problem.noise + rng.standard_normal(source.shape)
    real = _filled(problem.real, source.mean(axis=0)) / problem.noise
    domain = np.repeat([1, -2], [len(noisy), len(real)])
    return np.vstack([noisy, real]), domain, (problem.source.contexts - middle) / scale


def _filled(readings: FloatArray, usual: FloatArray) -> FloatArray:
    return np.where(np.isfinite(readings), readings, usual)


def _adapted(
    problem: LearningProblem,
    regress: Callable[[FloatArray], FloatArray],
    learn: Callable[[LearningProblem], Adapted],
) -> Adapted:
    usual = problem.source.readings.mean(axis=0)
    return Adapted(problem, TwinOnArrays(problem.simulator), regress, usual, learn)
