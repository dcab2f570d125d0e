"""How sure a parameter is: what the evidence says of other values, and of other onsets."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.noise.covariance import Reduced
from rga.diagnosis.search.change_point import beginnings
from rga.diagnosis.search.laplace import extended
from rga.diagnosis.search.stepwise import Found
from rga.errors import InputError

#: standard deviations about the estimate at which the model is simulated
AWAY = np.array([-3.0, -2.25, -1.5, -0.75, 0.0, 0.75, 1.5, 2.25, 3.0])


@dataclass(frozen=True)
class Profile:
    """What the data say of other values of a parameter.

    Attributes:
        parameter: its name.
        unit: of its values.
        values: float[points], in their order along `away`.
        away: standard deviations from the estimate, float[points]; the interval of the findings
            takes the log probability to be - away^2 / 2 [-].
        height: log posterior probability less that of the estimate, from the real model,
            float[points].
    """

    parameter: str
    unit: str
    values: FloatArray
    away: FloatArray
    height: FloatArray


@dataclass(frozen=True)
class Onset:
    """Possible onsets of a cause [s since the first row], and their probabilities [-]."""

    times: FloatArray
    chances: FloatArray


def profiles(found: Found, number: int) -> list[Profile]:
    """The profile of every parameter of a cause.

    Beside every value the other parameters, those of the other causes included, take what is
    likeliest with it: by the information matrix first, then by a step from the residual there.
    The height is that of the real model.

    Args:
        found: the end of a search.
        number: of the cause.
    """
    one = found.fit
    hypothesis, where = one.hypotheses[number], one.slices()[number]
    covariance = np.linalg.inv(one.information)
    profiles = []
    for column, (name, prior) in zip(
        range(where.start, where.stop), hypothesis.priors.items(), strict=True
    ):
        along = covariance[:, column] / np.sqrt(covariance[column, column])
        heights = np.array([_height(found, one.z + step * along, column) for step in AWAY])
        values = [prior.value(float(one.z[column] + step * along[column])) for step in AWAY]
        height = heights - heights[len(AWAY) // 2]
        unit = hypothesis.kind.unit(name, hypothesis.place)
        profiles.append(Profile(name, unit, np.array(values), AWAY, height))
    return profiles


def onset_profile(found: Found, number: int, first: float) -> Onset | None:
    """The probability of every onset of a cause; None of a cause without one.

    Args:
        found: the end of a search.
        number: of the cause.
        first: clock of the record's first row [s].
    """
    if found.fit.hypotheses[number].onset is None:
        return None
    possible = beginnings(found.problem, found.base, found.fit, number)
    return Onset(possible.moments - first, possible.chances)


def _height(found: Found, z: FloatArray, held: int) -> float:
    """Log posterior probability with one parameter held, the others adapted, up to a constant."""
    here, residual = _at(found, z)
    others = np.delete(np.arange(len(z)), held)
    if residual is None or not len(others):
        return here
    covariance, information = found.problem.covariance, found.fit.information
    signatures = covariance.reduce(found.fit.signatures[others])
    slope = covariance.product(signatures, residual)[:, 0] - z[others]
    moved = z.copy()
    moved[others] += np.linalg.solve(information[np.ix_(others, others)], slope)
    return max(here, _at(found, moved)[0])


def _at(found: Found, z: FloatArray) -> tuple[float, Reduced | None]:
    """Log posterior probability of parameters up to a constant, and the residual."""
    problem = found.problem
    try:
        simulated = problem.data.predict(extended(found.base, found.fit.hypotheses, z))
    except InputError:
        return -np.inf, None
    residual = problem.covariance.reduce(problem.residual(simulated).T[None])
    return -0.5 * float(problem.covariance.squares(residual)[0] + z @ z), residual
