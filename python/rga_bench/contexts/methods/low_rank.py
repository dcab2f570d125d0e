"""MAP with a model error of a few shapes, learned from measured rows whose contexts are unknown."""

from dataclasses import replace

import numpy as np

from rga.arrays import FloatArray
from rga_bench.contexts.method import LearningProblem
from rga_bench.contexts.methods.linearised import Linearised
from rga_bench.contexts.methods.posterior_modes import PosteriorModes, maximum_posterior

#: numbers of shapes tried; steps of EM; rounds in which modes and shapes follow each other
RANKS, STEPS, ROUNDS = (0, 1, 2, 4, 8, 16), 15, 3


def low_rank_discrepancy(problem: LearningProblem) -> PosteriorModes:
    """y = S(c) + B x + noise, with x standard normal and B found by EM.

    Factor analysis (Rubin and Thayer, Psychometrika 47, 1982) whose contexts are integrated along
    with x, on the simulation linearised at the modes. How many shapes B has is what half of the
    rows say is likeliest of the other half.
    """
    found = replace(maximum_posterior(problem), learn=low_rank_discrepancy)
    if len(problem.real) < 2:
        return found
    noise = problem.noise**2
    rows = Linearised.at(found.twin, problem.real, found.mode(problem.real).value)
    kept, other = rows[::2], rows[1::2]

    def held_out(rank: int) -> float:
        shapes = expectation_maximisation(kept, principal(kept, noise, rank), noise)
        return float(other.log_likelihood(shapes @ shapes.T + np.diag(noise)).sum())

    shapes = principal(rows, noise, max(RANKS, key=held_out))
    for _ in range(ROUNDS):
        shapes = expectation_maximisation(rows, shapes, noise)
        found = replace(found, covariance=shapes @ shapes.T + np.diag(noise))
        rows = Linearised.at(found.twin, problem.real, found.mode(problem.real).value)
    return found


def principal(rows: Linearised, noise: FloatArray, rank: int) -> FloatArray:
    """Shapes to start from, float[sensors, rank]: of what contexts leave of the rows."""
    left = rows.off - posterior(rows, np.zeros((len(noise), 0)), noise)[2]
    _, size, ways = np.linalg.svd(left / np.sqrt(noise * len(left)), full_matrices=False)
    return np.asarray(np.sqrt(noise)[:, None] * (ways[:rank] * size[:rank, None]).T)


def expectation_maximisation(rows: Linearised, shapes: FloatArray, noise: FloatArray) -> FloatArray:
    """Shapes B, float[sensors, rank], after some steps of EM.

    The variance of x is a parameter as well, which shapes take over after each step: it makes up
    for most of EM's slowness (Liu, Rubin and Wu, Biometrika 85, 1998).

    Args:
        rows: of which contexts and x are unknown.
        shapes: to start from.
        noise: variance of each sensor's noise, float[sensors].
    """
    many = rows.slope.shape[2]
    for _ in range(STEPS if shapes.shape[1] else 0):
        mean, covariance, explained = posterior(rows, shapes, noise)
        x = mean[:, many:]
        left = rows.off - explained
        shared = np.einsum("nsc,ncr->nsr", rows.slope, covariance[:, :many, many:])
        numerator = np.einsum("ns,nsr->sr", rows.seen, left[:, :, None] * x[:, None] - shared)
        square = covariance[:, many:, many:] + x[:, :, None] * x[:, None]
        denominator = np.einsum("ns,nqr->sqr", rows.seen, square) + 1e-9 * np.eye(x.shape[1])
        shapes = np.linalg.solve(denominator, numerator[:, :, None])[:, :, 0]
        shapes = shapes @ np.linalg.cholesky(square.mean(axis=0))
    return shapes


def posterior(
    rows: Linearised, shapes: FloatArray, noise: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of contexts and x together: mean, covariance, and what the contexts explain of each row.

    Returns:
        float[n, contexts + rank], float[n, contexts + rank, contexts + rank], float[n, sensors].
    """
    spread = np.broadcast_to(shapes, (*rows.off.shape, shapes.shape[1]))
    design = np.concatenate([rows.slope, spread * rows.seen[:, :, None]], axis=2)
    weighed = (design / noise[:, None]).transpose(0, 2, 1)
    covariance = np.linalg.inv(weighed @ design + np.eye(design.shape[2]))
    mean = (covariance @ weighed @ rows.off[:, :, None])[:, :, 0]
    many = rows.slope.shape[2]
    return mean, covariance, np.einsum("nsc,nc->ns", rows.slope, mean[:, :many])
