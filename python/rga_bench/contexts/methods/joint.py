"""Contexts and unknowns of the structure together, with load tests where there are any."""

from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import FloatArray
from rga.inference.joint.infer import Joint, infer_jointly
from rga.inference.joint.structural_parameters import Unknowns
from rga.inference.map.initial_guess import QuadraticGuess
from rga.inference.rows import Rows
from rga.model import Model
from rga_bench.contexts.method import Calibrated, LearningProblem
from rga_bench.contexts.methods.posterior_modes import PosteriorModes


@dataclass(frozen=True)
class JointModes(PosteriorModes):
    """Modes under a twin that has learned its unknowns.

    Attributes:
        joint: what was found beside the contexts.
    """

    joint: Joint | None = None

    def recalibrated(self, recent: FloatArray, *, alone: bool = False) -> Calibrated:
        """The unknowns found again.

        For all rows, sensors that have changed weigh less. For recent rows alone, what they
        have changed by is found; the structure is known beforehand but for what may have moved.
        """
        if alone:
            return _learned(replace(self.problem, real=recent), prior=self.joint)
        problem = replace(self.problem, real=np.vstack([self.problem.real, recent]))
        return _learned(problem, start=self.joint)


_KNOWN: dict[str, Unknowns] = {}


def unknowns_of(model: Model) -> Unknowns:
    """The unknowns of a model; those of the last one are kept, with what they take long to see."""
    content = model.model_dump_json()
    if content not in _KNOWN:
        _KNOWN.clear()
        _KNOWN[content] = Unknowns(model)
    return _KNOWN[content]


def joint_posterior(problem: LearningProblem) -> Calibrated:
    """Contexts and unknowns in one posterior."""
    return _learned(problem)


def _learned(
    problem: LearningProblem, *, start: Joint | None = None, prior: Joint | None = None
) -> JointModes:
    found = infer_jointly(
        unknowns_of(problem.model),
        problem.real,
        problem.noise,
        problem.source.contexts,
        load_tests=problem.load_tests if len(problem.load_tests) else None,
        start=start,
        prior=prior,
    )
    twin = found.twin
    simulated = Rows(problem.source.contexts, twin.simulate(problem.source.contexts))
    deviation = np.sqrt(np.diagonal(found.covariance))
    guess = QuadraticGuess(simulated, deviation, twin.ranges, problem.seed)
    return JointModes(problem, twin, found.covariance, guess, joint=found)
