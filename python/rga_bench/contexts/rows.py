"""The methods that stand in the table."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.util import find_spec

from rga.inference.rows import Rows
from rga_bench.contexts.context_regime import MANNERS
from rga_bench.contexts.data import CalibrationData
from rga_bench.contexts.method import Calibrated
from rga_bench.contexts.methods import networks
from rga_bench.contexts.methods.discrepancy import smooth_discrepancy
from rga_bench.contexts.methods.domain_adaptation import skada_coral, skada_dann
from rga_bench.contexts.methods.ensemble_kalman import ensemble_kalman
from rga_bench.contexts.methods.iterated_kalman import iterated_kalman
from rga_bench.contexts.methods.joint import joint_posterior
from rga_bench.contexts.methods.low_rank import low_rank_discrepancy
from rga_bench.contexts.methods.neural_posterior import neural_posterior
from rga_bench.contexts.methods.oracle import oracle_posterior
from rga_bench.contexts.methods.posterior_modes import maximum_posterior
from rga_bench.contexts.methods.prior import prior_mean
from rga_bench.contexts.methods.refined_network import refined_network
from rga_bench.contexts.methods.unscented_kalman import unscented_kalman
from rga_bench.contexts.methods.updated_model import updated_model
from rga_bench.contexts.setting import ContextsTask


@dataclass(frozen=True)
class Row:
    """A method, and what it gets.

    Attributes:
        learn: a `Method`; that of an oracle takes the physical twin beside the problem.
        oracle: whether it knows the physical twin as it was at first.
        load_tests: measured rows whose contexts it gets as well.
        manners: of contexts that it is run under, `DRIFTING` among them; None: under all.
        needs: packages that rga does without.
    """

    learn: Callable[..., Calibrated]
    oracle: bool = False
    load_tests: int = 0
    manners: tuple[str, ...] | None = None
    needs: tuple[str, ...] = ()

    def calibrated(self, known: CalibrationData) -> Calibrated:
        """The method after it has learned."""
        tests = known.problem.load_tests
        labelled = Rows(tests.contexts[: self.load_tests], tests.readings[: self.load_tests])
        problem = replace(known.problem, load_tests=labelled)
        return self.learn(problem, known.usual.twin) if self.oracle else self.learn(problem)

    @property
    def missing(self) -> list[str]:
        """Packages that are not installed."""
        return [package for package in self.needs if find_spec(package) is None]


#: filters need rows in order; a few rows that adapt stand for the others in streams
_IN_ORDER = ("smooth",)

METHODS: dict[str, Row] = {
    "knows the frame": Row(oracle_posterior, oracle=True, manners=MANNERS),
    "prior mean": Row(prior_mean),
    "source only": Row(networks.source_only),
    "residual network": Row(networks.residual_network),
    "CORAL": Row(networks.coral, manners=MANNERS),
    "DANN": Row(networks.adversarial),
    "DANN + physics, frozen network": Row(networks.adversarial_reduced_physics),
    "DANN + physics, exact simulator": Row(networks.adversarial_exact_physics),
    "physics only": Row(networks.physics_only, manners=MANNERS),
    "network + polish": Row(refined_network, manners=MANNERS),
    "MAP": Row(maximum_posterior),
    "MAP, smooth discrepancy": Row(smooth_discrepancy, manners=MANNERS),
    "MAP, low-rank discrepancy (EM)": Row(low_rank_discrepancy),
    "iterated Kalman filter": Row(iterated_kalman, manners=_IN_ORDER),
    "unscented Kalman filter": Row(unscented_kalman, manners=_IN_ORDER),
    "ensemble Kalman filter": Row(ensemble_kalman, manners=_IN_ORDER),
    "updated model, 20 load tests": Row(updated_model, load_tests=20, manners=MANNERS),
    "updated model, 60 load tests": Row(updated_model, load_tests=60, manners=MANNERS),
    "joint posterior": Row(joint_posterior),
    "joint posterior, 20 load tests": Row(joint_posterior, load_tests=20, manners=MANNERS),
    "joint posterior, 60 load tests": Row(joint_posterior, load_tests=60, manners=MANNERS),
    "neural posterior (sbi)": Row(neural_posterior, manners=MANNERS, needs=("sbi",)),
    "CORAL (skada)": Row(skada_coral, manners=MANNERS, needs=("skada", "sklearn")),
    "DANN (skada)": Row(skada_dann, manners=MANNERS, needs=("skada", "sklearn", "skorch")),
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
