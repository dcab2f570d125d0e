"""Members and springs whose force is no multiple of their elongation: slack, play and stops.

A law N(v) of a term is written as that of the linear term of the structure and a pseudo-force
w = N(v) - k v beside it. Condensed onto these terms, v + G w(v) = v0 is a small system with corners
at the ends of the play; Newton's method meets few of them (Qi and Sun, A nonsmooth version of
Newton's method, Math. Programming 58, 1993).
"""

import numpy as np
from numpy.typing import NDArray

from rga.errors import InputError
from rga.model.parameter import FloatArray
from rga.model.structure import Law, Structure
from rga.simulation.condensation import Condensation
from rga.simulation.terms import STRAIN

#: Newton steps before a row is given up
STEPS = 60
#: an elongation is found when it changes by less than this part of the largest
CONVERGED = 1e-12
#: share of its stiffness that a step grants an idle term, so that it may lead out of the play
TRACE = 1e-8


def respond_with_laws(
    structure: Structure, linear: Condensation, coefficients: FloatArray
) -> FloatArray:
    """Sensors of rows, float[rows, sensors] in SI units.

    Args:
        structure: with its laws.
        linear: the structure condensed onto the terms that have them, in the order of
            `terms_of`.
        coefficients: of the load patterns, float[rows, patterns].

    Raises:
        InputError: play or slack leaves a row nothing that holds it.
    """
    laws = sorted(structure.laws, key=_order)
    apart = coefficients @ linear.stretched
    # All terms bear at first, each on the side that it would take without its law.
    size = np.array([law.size for law in laws])
    elongation = apart + (np.sign(apart) * size * linear.stiffness) @ linear.unit
    waiting = np.arange(len(apart))
    identity = np.eye(len(laws))
    for _ in range(STEPS):
        pseudo, slope = _pseudo(laws, linear.stiffness, elongation[waiting])
        left = elongation[waiting] + pseudo @ linear.unit - apart[waiting]
        matrix = identity + linear.unit * slope[:, None, :]
        step = np.linalg.solve(matrix, left[:, :, None])[:, :, 0]
        elongation[waiting] -= step
        largest = np.abs(elongation[waiting]).max(axis=1)
        waiting = waiting[np.abs(step).max(axis=1) > CONVERGED * largest]
        if not len(waiting):
            break
    else:
        raise InputError(
            "play or slack leaves nothing that holds the structure",
            f"row {waiting[0] + 1}",
            "reduce the slack, or name fewer members",
        )
    pseudo, _ = _pseudo(laws, linear.stiffness, elongation)
    influence, arrays, outputs = linear.influence.copy(), structure.arrays, structure.outputs
    # A gauge on a slack member reads its force, not the way that its ends have moved.
    gauges = np.where(outputs["total"] | (outputs["kind"] != STRAIN), -1, outputs["index"])
    for term, law in enumerate(laws):
        if law.member is not None:
            axial = arrays["E"][law.member] * arrays["A"][law.member]
            influence[term, gauges == law.member] -= 1.0 / axial
    return np.asarray(coefficients @ linear.loaded - pseudo @ influence)


def terms_of(structure: Structure) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Members and springs with a law.

    Raises:
        InputError: one has two.
    """
    laws = sorted(structure.laws, key=_order)
    places = [(law.member, law.spring) for law in laws]
    if len(set(places)) < len(places):
        raise InputError(
            "a member has two of joint_slip and tension_only", "effects", "leave it one of them"
        )
    members = [law.member for law in laws if law.member is not None]
    springs = [law.spring for law in laws if law.spring is not None]
    return np.array(members, dtype=np.int64), np.array(springs, dtype=np.int64)


def _order(law: Law) -> tuple[bool, int]:
    """Members first, as a condensation has its terms."""
    return law.member is None, (law.spring if law.member is None else law.member) or 0


def _pseudo(
    laws: list[Law], stiffness: FloatArray, elongation: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """N(v) - k v and its slope, float[rows, terms]: what play or slack takes off the force."""
    size = np.array([law.size for law in laws])
    lowest = np.where([law.kind == "tension" for law in laws], -np.inf, -size)
    idle = np.clip(elongation, lowest, size)
    return -stiffness * idle, np.where(idle == elongation, (TRACE - 1.0) * stiffness, 0.0)
