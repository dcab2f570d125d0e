"""The methods that stand in the table."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib.util import find_spec

from rga.benchmark.loi.data import Calibration
from rga.benchmark.loi.method import Calibrated
from rga.benchmark.loi.methods.discrepancy import smooth_discrepancy
from rga.benchmark.loi.methods.domain_adaptation import skada_coral, skada_dann
from rga.benchmark.loi.methods.ensemble_kalman import ensemble_kalman
from rga.benchmark.loi.methods.iterated_kalman import iterated_kalman
from rga.benchmark.loi.methods.low_rank import low_rank_discrepancy
from rga.benchmark.loi.methods.modes import maximum_posterior
from rga.benchmark.loi.methods.neural_posterior import neural_posterior
from rga.benchmark.loi.methods.prior import prior_mean
from rga.benchmark.loi.methods.unscented_kalman import unscented_kalman
from rga.benchmark.loi.methods.updated_model import updated_model
from rga.inference.rows import Rows


@dataclass(frozen=True)
class Row:
    """A method, and what it gets.

    Attributes:
        learn: a `Method`; that of an oracle takes the physical twin beside the problem.
        oracle: whether it knows the physical twin as it was at first.
        load_tests: measured rows whose contexts it gets as well.
        needs: packages that rga does without.
    """

    learn: Callable[..., Calibrated]
    oracle: bool = False
    load_tests: int = 0
    needs: tuple[str, ...] = ()

    def calibrated(self, known: Calibration) -> Calibrated:
        """The method after it has learned."""
        tests = known.problem.load_tests
        labelled = Rows(tests.contexts[: self.load_tests], tests.readings[: self.load_tests])
        problem = replace(known.problem, load_tests=labelled)
        return self.learn(problem, known.usual.twin) if self.oracle else self.learn(problem)

    @property
    def missing(self) -> list[str]:
        """Packages that are not installed."""
        return [package for package in self.needs if find_spec(package) is None]


METHODS: dict[str, Row] = {
    "prior mean": Row(prior_mean),
    "MAP": Row(maximum_posterior),
    "MAP with discrepancy": Row(smooth_discrepancy),
    "EM low-rank discrepancy": Row(low_rank_discrepancy),
    "calibrated model, 20 load tests": Row(updated_model, load_tests=20),
    "calibrated model, 60 load tests": Row(updated_model, load_tests=60),
    "iterated EKF": Row(iterated_kalman),
    "unscented KF": Row(unscented_kalman),
    "ensemble KF": Row(ensemble_kalman),
    "NPE (sbi)": Row(neural_posterior, needs=("sbi",)),
    "CORAL (skada)": Row(skada_coral, needs=("skada",)),
    "DANN (skada)": Row(skada_dann, needs=("skada",)),
}
#: methods of a quick run
QUICK = ("prior mean", "MAP")
#: the method whose Error is a floor: it knows what the physical twin is like
ORACLE = "knows the frame"
#: methods by the columns of the paper's table
PAPERS = {
    "residual loss": "residual network",
    "without physics": "DANN",
    "with physics": "DANN + physics, frozen network",
}
