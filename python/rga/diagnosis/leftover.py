"""Structure that is left: patterns that many sensors share and no cause explains.

What sensors share, row by row, beyond loads, contexts and scatter shows as correlation between
their innovations. The largest eigenvalue of that correlation is compared with what as many rows of
independent noise give (Marchenko and Pastur 1967 for its edge, a margin for its scatter).
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import spearmanr

from rga.diagnosis.covariance import BoolArray
from rga.diagnosis.noise import unexplainable
from rga.diagnosis.problem import Problem, load_basis, pose
from rga.model.effect import Values
from rga.model.parameter import FloatArray

MOST = 3
MARGIN = 1.25


@dataclass(frozen=True)
class Pattern:
    """A pattern over the sensors that varies for reasons unknown.

    Attributes:
        direction: over the sensors, in their units, float[sensors].
        share: of the variance of the innovations [-].
    """

    direction: FloatArray
    share: float


def with_leftovers(problem: Problem) -> Problem:
    """The problem with the patterns that it leaves added to the covariance."""
    for _ in range(MOST):
        pattern = shared_pattern(problem)
        if pattern is None:
            break
        factors = np.column_stack([problem.factors, pattern.direction])
        problem = pose(problem.simulator, problem.data, problem, factors)
    return problem


def shared_pattern(problem: Problem) -> Pattern | None:
    """The strongest pattern that the sensors still share, or None where there is none."""
    white, seen = innovations(problem)
    working = seen.sum(0) > 0.5 * len(seen)
    if working.sum() < 3:
        return None
    columns = white[:, working]
    scale = np.sqrt((columns**2).sum(0) / np.maximum(seen[:, working].sum(0), 1))
    columns = columns / np.maximum(scale, 1e-12)
    rows, sensors = columns.shape
    values, vectors = np.linalg.eigh(columns.T @ columns / rows)
    edge = (1 + np.sqrt(sensors / rows)) ** 2
    if values[-1] <= MARGIN * edge:
        return None
    direction = np.zeros(len(working))
    direction[working] = vectors[:, -1] * np.sqrt(values[-1]) * problem.noise.sigma[working]
    return Pattern(direction, float((values[-1] - 1) / sensors))


def innovations(problem: Problem) -> tuple[FloatArray, BoolArray]:
    """What is new in every row, whitened, beyond what any linear structure could explain.

    Returns:
        float[rows, sensors], and bool[rows, sensors] where there is one.
    """
    data = problem.data
    residual = problem.residual(problem.simulated)
    left = unexplainable(residual, data.observed, load_basis(problem.simulator, data))
    rows = problem.covariance.rows
    error = rows.context_error(left)
    left = left - np.einsum("tsi,ti->ts", rows.context_jacobian, error)
    return rows.reduce(left[:, :, None]).white.reshape(left.shape), data.observed


def share_left(problem: Problem) -> float:
    """Share of the innovations' variance that unexplained patterns take [-]."""
    variance = problem.noise.sigma**2
    spread = problem.noise.context_sigma[
        len(problem.noise.context_sigma) - problem.factors.shape[1] :
    ]
    patterns = ((problem.factors * spread) ** 2).sum(1)
    return float(np.mean(patterns / (patterns + variance)))


def in_words(problem: Problem, contexts: Values) -> str:
    """What the unexplained patterns follow: sensors, a context, time."""
    if problem.factors.shape[1] == 0:
        return "noise: nothing that sensors share is left"
    rows = problem.covariance.rows
    residual = problem.residual(problem.simulated)
    error = rows.context_error(residual - _scatter(problem, residual))
    first = error.shape[1] - problem.factors.shape[1]
    told = []
    for number, direction in enumerate(problem.factors.T):
        strongest = np.argsort(-np.abs(direction) / problem.noise.sigma)[:4]
        signs = [
            f"{problem.data.sensors[k]} ({'+' if direction[k] > 0 else '-'})" for k in strongest
        ]
        told.append(
            f"a pattern of {', '.join(signs)} that {_follows(error[:, first + number], contexts)}"
        )
    return "; ".join(told)


def _scatter(problem: Problem, residual: FloatArray) -> FloatArray:
    covariance = problem.covariance
    return np.asarray(covariance.scatter @ covariance.scatter_estimate(residual))


def _follows(amplitude: FloatArray, contexts: Values) -> str:
    """What an amplitude goes with, by rank correlation."""
    drivers = {
        (f"grows with {name}" if power == 1 else f"grows with {name} either way from its middle"): (
            column if power == 1 else np.abs(column - np.median(column))
        )
        for name, column in contexts.items()
        for power in (1, 2)
        if np.ptp(column) > 0
    }
    found = {
        words: abs(float(spearmanr(column, amplitude)[0])) for words, column in drivers.items()
    }
    best = max(found, key=lambda words: found[words], default="")
    if best and found[best] > 0.4:
        return f"{best} (rank correlation {found[best]:.2f})"
    centred = amplitude - amplitude.mean()
    memory = float((centred[1:] * centred[:-1]).sum() / max((centred**2).sum(), 1e-300))
    if memory > 0.5:
        return (
            f"moves slowly with time (correlation {memory:.2f} from row to row) and with no context"
        )
    return "follows no context and changes from row to row"
