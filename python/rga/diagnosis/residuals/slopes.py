"""Bends: responses to measured contexts that are not linear.

What a measured context does is proportional to it as long as the structure is linear. A response
along a curve shows as a part that goes with the square of a context, its own or another. Where
there is one, the linear part of the response is not what it was either, and a cause must not
live by that.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.search.linearised import Calibration, Problem, pose

Key = TypeVar("Key")
#: how far off the linear part may be, in sizes of the bend, as a prior spread
STRAIGHT = 3.0
#: share of its variance that a square must have beside the context itself
OWN = 1e-3


@dataclass(frozen=True)
class Bend:
    """A measured context to which the structure answers otherwise than in proportion.

    Attributes:
        context: its name; by: the context with which the answer bends.
        size: of the part that goes with the square, per squared standard deviation of `by`
            [unit of the context].
        error: what the readings make of the error of its measurement [its unit], float[rows].
    """

    context: str
    by: str
    size: float
    error: FloatArray


def bends(problem: Problem) -> list[Bend]:
    """Measured contexts to which the response bends, with the context that it bends most with."""
    belief, covariance = problem.data.belief, problem.covariance
    residual = problem.residual(problem.simulated)
    scatter = covariance.scatter.at(covariance.scatter_estimate(residual))
    error = covariance.rows.context_error(residual - scatter)
    reduced = covariance.reduce(residual.T[None])
    linear_part = linear_histories(problem)
    squared = squares(linear_part)
    found = []
    for number, name in enumerate(belief.spread):
        along = covariance.rows.context_jacobian[:, :, number]
        if name in belief.latent or not along.any():
            continue
        courses = [np.ones(len(along)), *linear_part.values(), *squared.values()]
        columns = covariance.reduce(np.stack([(along * one[:, None]).T for one in courses]))
        product = covariance.product(columns, columns)
        sums = covariance.product(columns, reduced)[:, 0]
        size = dict.fromkeys(squared, (0.0, 0.0))
        linear = range(1 + len(linear_part))
        for place, by in enumerate(squared, len(linear)):
            chosen = [*linear, place]
            inverse = np.linalg.pinv(product[np.ix_(chosen, chosen)], hermitian=True)
            bend = float((inverse @ sums[chosen])[-1])
            size[by] = bend, abs(bend) / float(np.sqrt(max(inverse[-1, -1], 1e-300)))
        by = max(size, key=lambda one: size[one][1], default="")
        if by and size[by][1] > problem.criteria.structure.bend:
            found.append(Bend(name, by, size[by][0], error[:, number]))
    return found


def with_free_slopes(problem: Problem, found: list[Bend], further: list[Calibration]) -> Problem:
    """The problem where a nonlinear response may follow any context, and no other keeps its slope.

    Args:
        problem: in which there are bends.
        found: those.
        further: random effects that are free beside them.
    """
    belief = problem.data.belief
    jacobian = dict(
        zip(
            belief.spread, problem.covariance.rows.context_jacobian.transpose(2, 0, 1), strict=False
        )
    )
    linear_part = linear_histories(problem)
    squared = squares(linear_part)
    more = list(further)
    share = 0.0
    for bend in found:
        courses = [np.ones(len(problem.data.time)), *linear_part.values(), *squared.values()]
        along, size = jacobian[bend.context], STRAIGHT * abs(bend.size)
        more += [(along * course[:, None], size) for course in courses]
        if bend.by == bend.context:
            share = max(share, size / float(belief.centre[bend.context].std()))
    if share > 0:
        for name in sorted(linear_part.keys() & set(belief.measured)):
            along = jacobian[name] * belief.centre[name][:, None]
            more += [(along, share), (along * linear_part[name][:, None], share)]
    return pose(problem.simulator, problem.data, problem, more=more)


def linear_histories(problem: Problem) -> dict[str, FloatArray]:
    """Contexts that vary, about their means and in their standard deviations."""
    return standardised(problem.data.belief.centre)


def standardised(columns: Mapping[Key, FloatArray]) -> dict[Key, FloatArray]:
    """Columns that vary, about their means and in their standard deviations."""
    return {
        name: (column - column.mean()) / column.std()
        for name, column in columns.items()
        if column.std() > 0
    }


def squares(linear_part: Mapping[Key, FloatArray]) -> dict[Key, FloatArray]:
    """The part of the squares that no straight line has; none of a context of two values."""
    found = {}
    for name, scaled in linear_part.items():
        design = np.column_stack([np.ones(len(scaled)), scaled])
        square = scaled**2
        rest = square - design @ np.linalg.lstsq(design, square, rcond=None)[0]
        if (rest**2).mean() > OWN * (square**2).mean():
            found[name] = rest
    return found
