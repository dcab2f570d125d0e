"""Members and springs whose force is no multiple of their elongation: slack, play and stops.

A law N(v) of a term is written as that of the linear term of the structure and a pseudo-force
w = N(v) - k v beside it. Condensed onto these terms, v + G w(v) = v0 is a small system with corners
at the ends of the play; Newton's method meets few of them (Qi and Sun, A nonsmooth version of
Newton's method, Math. Programming 58, 1993).

A trace of stiffness in idle terms keeps in the middle of the play what only the play lets move and
no load pushes. It finds the side on which each term is; its force is then taken off again.
"""

import numpy as np
from numpy.typing import NDArray

from rga._core import Condensation, OutputKind
from rga.arrays import FloatArray, IntArray
from rga.errors import InputError
from rga.model.structure import Law, Structure

#: Newton steps before a row is given up
STEPS = 60
#: an elongation is found when it changes by less than this part of the largest
CONVERGED = 1e-12
#: share of its stiffness that an idle term keeps, and how much of the loads it may carry by that
TRACE, CARRIED = 1e-8, 1e-3
#: shares that lead to the trace where it cannot be reached at once
TRACES = (0.9, 0.5, 0.3, 0.2, 0.1, 0.05, 0.02, 1e-2, 3e-3, 1e-3, 1e-4, 1e-6, TRACE)
#: shares of a step that are tried on the way
SHORTER = 0.5 ** np.arange(16)
#: steps that take its force off again
REFINED = 2
#: elongations below this are none [m]
NONE = 1e-12


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
    stiffness, unit = linear.stiffness, linear.unit
    size = np.array([law.size for law in laws])
    rod = np.array([law.kind == "tension" for law in laws])
    apart = coefficients @ linear.stretched

    def left(elongation: FloatArray, side: FloatArray, rows: IntArray, trace: float) -> FloatArray:
        """By how much compatibility is missed, float[rows, terms]."""
        idle = (1 - trace) * elongation + trace * size * rod
        pseudo = -stiffness * np.where(side == 0, idle, side * size)
        return np.asarray(elongation + pseudo @ unit - apart[rows])

    def move(elongation: FloatArray, side: FloatArray, rows: IntArray, trace: float) -> FloatArray:
        """One Newton step, the terms staying on their sides."""
        missed = left(elongation, side, rows, trace)
        slope = (max(trace, TRACE) - 1) * stiffness
        idle = side == 0
        if len(laws) == 1:
            return np.asarray(elongation - missed / (1.0 + unit[0, 0] * slope * idle))
        # Terms that bear follow the idle ones: these alone are a system, as large as they are many.
        own = np.zeros_like(missed)
        count = idle.sum(1)
        for many in np.unique(count[count > 0]):
            which = np.flatnonzero(count == many)[:, None]
            terms = np.nonzero(idle[which[:, 0]])[1].reshape(-1, many)
            matrix = unit[terms[:, :, None], terms[:, None, :]] * slope[terms][:, None, :]
            matrix += np.eye(many)
            own[which, terms] = np.linalg.solve(matrix, missed[which, terms][:, :, None])[:, :, 0]
        return np.asarray(elongation - np.where(idle, own, missed - (slope * own) @ unit.T))

    def shortened(before: FloatArray, now: FloatArray, rows: IntArray, trace: float) -> FloatArray:
        """The point between two that misses compatibility least."""
        tried = np.stack([before + share * (now - before) for share in SHORTER])
        sides = _side(tried, size, rod, trace)
        missed = [
            np.square(left(*one, rows, trace)).sum(1) for one in zip(tried, sides, strict=True)
        ]
        return np.asarray(tried[np.argmin(missed, axis=0), np.arange(len(rows))])

    def settle(waiting: IntArray, trace: float, damped: bool = False) -> IntArray:
        """Newton steps of rows, in place; those that are still on their way after many."""
        for _ in range(STEPS):
            if not len(waiting):
                break
            before, on = elongation[waiting], side[waiting]
            now = move(before, on, waiting, trace)
            if damped:
                now = shortened(before, now, waiting, trace)
            elongation[waiting], side[waiting] = now, _side(now, size, rod, trace)
            # Between corners all is straight, and a step that meets none is exact.
            met = (side[waiting] != on).any(axis=1)
            far = np.abs(now - before).max(axis=1) > CONVERGED * np.abs(now).max(axis=1)
            waiting = waiting[far & (met | damped)]
        return waiting

    # All terms bear at first, each on the side that it would take without its law.
    elongation = apart + (np.sign(apart) * size * stiffness) @ unit
    side = _side(elongation, size, rod, TRACE)
    waiting = settle(np.arange(len(apart)), TRACE)
    if len(waiting):
        # Many idle terms and little load: Newton's method goes round in circles, and is led from
        # terms that keep much of their stiffness to those that keep a trace.
        going = waiting
        for trace in TRACES:
            waiting = settle(going, trace, damped=True)
    held = TRACE * np.abs(elongation) < CARRIED * (np.abs(apart).max() + np.abs(size).max() + NONE)
    lost = np.union1d(waiting, np.flatnonzero(~held.all(axis=1)))
    if len(lost):
        raise InputError(
            "play or slack leaves nothing that holds the structure",
            f"row {lost[0] + 1}",
            "reduce the slack, or name fewer members",
        )
    for _ in range(REFINED):
        elongation = move(elongation, side, np.arange(len(apart)), 0.0)
    pseudo = -stiffness * np.where(side == 0, elongation, side * size)
    influence, arrays, outputs = linear.influence, structure.arrays, structure.outputs
    # A gauge on a slack member reads its force, not the way that its ends have moved.
    gauges = np.where(
        outputs["total"] | (outputs["kind"] != OutputKind.STRAIN), -1, outputs["index"]
    )
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


def _side(
    elongation: FloatArray, size: FloatArray, rod: NDArray[np.bool_], trace: float
) -> FloatArray:
    """1 or -1 for terms that bear at an end of their play, 0 for idle ones, float[rows, terms]."""
    # With the trace a rod's force is zero at its slack, that of a play in its middle.
    highest = np.where(rod, size, size / (1 - trace))
    lowest = np.where(rod, -np.inf, -highest)
    return np.where(elongation >= highest, 1.0, np.where(elongation <= lowest, -1.0, 0.0))
