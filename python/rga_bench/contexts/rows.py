"""The methods that stand in the table."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from importlib.util import find_spec

from rga.inference.rows import Rows
from rga.twin.calibration.amortised import AmortisedEstimator
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.joint_posterior import JointEstimator
from rga.twin.calibration.lesson import Lesson
from rga_bench.contexts.context_regime import MANNERS
from rga_bench.contexts.data import CalibrationData
from rga_bench.contexts.method import LearningProblem, Rival
from rga_bench.contexts.methods.discrepancy import smooth_discrepancy
from rga_bench.contexts.methods.domain_adaptation import skada_coral, skada_dann
from rga_bench.contexts.methods.ensemble_kalman import ensemble_kalman
from rga_bench.contexts.methods.iterated_kalman import iterated_kalman
from rga_bench.contexts.methods.low_rank import low_rank_discrepancy
from rga_bench.contexts.methods.networks import NETWORKS, trained
from rga_bench.contexts.methods.neural_posterior import neural_posterior
from rga_bench.contexts.methods.oracle import oracle_posterior
from rga_bench.contexts.methods.posterior_modes import maximum_posterior
from rga_bench.contexts.methods.prior import prior_mean
from rga_bench.contexts.methods.refined_network import refined_network
from rga_bench.contexts.methods.unscented_kalman import unscented_kalman
from rga_bench.contexts.methods.updated_model import updated_model
from rga_bench.contexts.setting import ContextsTask
from rga_bench.synthetic.physical_twin import PhysicalTwin


@dataclass(frozen=True)
class Row:
    """A method, and what it gets.

    Attributes:
        learn: learns from a lesson; an oracle takes the physical twin beside it.
        oracle: whether it knows the physical twin as it was at first.
        load_tests: measured rows whose contexts it gets as well.
        manners: of contexts that it is run under, `DRIFTING` among them; None: under all.
        needs: packages that rga does without.
    """

    learn: Callable[..., ContextEstimator]
    oracle: bool = False
    load_tests: int = 0
    manners: tuple[str, ...] | None = None
    needs: tuple[str, ...] = ()

    def calibrated(self, known: CalibrationData) -> ContextEstimator:
        """The method after it has learned."""
        tests, labelled = known.lesson.load_tests, None
        if tests is not None and self.load_tests:
            own = slice(self.load_tests)
            labelled = Rows(tests.contexts[own], tests.readings[own])
        lesson = replace(known.lesson, load_tests=labelled)
        return self.learn(lesson, known.usual.twin) if self.oracle else self.learn(lesson)

    @property
    def missing(self) -> list[str]:
        """Packages that are not installed."""
        return [package for package in self.needs if find_spec(package) is None]


def _rival(method: Callable[..., Rival]) -> Callable[..., Rival]:
    """Learns a method that takes tables from a lesson."""

    @wraps(method)
    def learn(lesson: Lesson, *twin: PhysicalTwin) -> Rival:
        return method(LearningProblem.of(lesson), *twin)

    return learn


def amortised(lesson: Lesson) -> AmortisedEstimator:
    """Networks on the twin as the joint posterior of the same lesson corrects it."""
    return AmortisedEstimator.learn(lesson, JointEstimator.learn(lesson))


#: filters need rows in order; in streams are what a twin recalibrates, and two that it cannot
_IN_ORDER = ("smooth",)

METHODS: dict[str, Row] = {
    "knows the frame": Row(_rival(oracle_posterior), oracle=True, manners=MANNERS),
    "prior mean": Row(_rival(prior_mean)),
    "source only": Row(trained(NETWORKS["source only"])),
    "residual network": Row(trained(NETWORKS["residual network"])),
    "CORAL": Row(trained(NETWORKS["CORAL"]), manners=MANNERS),
    "DANN": Row(trained(NETWORKS["DANN"])),
    "DANN + physics, frozen network": Row(trained(NETWORKS["DANN + physics, frozen network"])),
    "DANN + physics, exact simulator": Row(
        trained(NETWORKS["DANN + physics, exact simulator"]), manners=MANNERS
    ),
    "physics only": Row(trained(NETWORKS["physics only"]), manners=MANNERS),
    "network + polish": Row(refined_network, manners=MANNERS),
    "MAP": Row(_rival(maximum_posterior), manners=MANNERS),
    "MAP, smooth discrepancy": Row(_rival(smooth_discrepancy), manners=MANNERS),
    "MAP, low-rank discrepancy (EM)": Row(_rival(low_rank_discrepancy), manners=MANNERS),
    "iterated Kalman filter": Row(_rival(iterated_kalman), manners=_IN_ORDER),
    "unscented Kalman filter": Row(_rival(unscented_kalman), manners=_IN_ORDER),
    "ensemble Kalman filter": Row(_rival(ensemble_kalman), manners=_IN_ORDER),
    "updated model, 20 load tests": Row(_rival(updated_model), load_tests=20, manners=MANNERS),
    "updated model, 60 load tests": Row(_rival(updated_model), load_tests=60, manners=MANNERS),
    "joint posterior": Row(JointEstimator.learn),
    "joint posterior, 20 load tests": Row(JointEstimator.learn, load_tests=20, manners=MANNERS),
    "joint posterior, 60 load tests": Row(JointEstimator.learn, load_tests=60, manners=MANNERS),
    "amortised": Row(amortised, manners=MANNERS),
    "neural posterior (sbi)": Row(_rival(neural_posterior), manners=MANNERS, needs=("sbi",)),
    "CORAL (skada)": Row(_rival(skada_coral), manners=MANNERS, needs=("skada", "sklearn")),
    "DANN (skada)": Row(_rival(skada_dann), manners=MANNERS, needs=("skada", "sklearn", "skorch")),
}
#: methods of a quick run
QUICK = (
    "knows the frame",
    "prior mean",
    "source only",
    "DANN",
    "DANN + physics, frozen network",
    "MAP",
    "joint posterior",
)
#: the method whose Error is a floor: it knows what the physical twin is like
ORACLE = "knows the frame"
#: methods by the columns of the paper's table
PAPERS = {
    "residual loss": "residual network",
    "without physics": "DANN",
    "with physics": "DANN + physics, frozen network",
}


def applies(task: ContextsTask) -> bool:
    """Whether the row of a task is run under its manner of contexts."""
    row = METHODS.get(task.row)
    return row is None or row.manners is None or task.manner in row.manners
