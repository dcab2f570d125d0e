"""Which stiffnesses of a structure vary from row to row, and how."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rga.model.parameter import FloatArray
from rga.model.structure import IntArray, Structure

#: rows at which straightness is checked, beside the ends of each parameter
CHECKED = 6
#: properties of a truss member that only reach the answer through EA / L
AXIAL = ("E", "G", "A")


@dataclass(frozen=True)
class Variation:
    """Truss members and springs whose stiffness is a straight function of structural parameters.

    Attributes:
        start: the structure at the first state.
        members, springs: numbers of those that vary.
        first: their stiffness at the first state, float[terms] [N/m or N m/rad].
        stiffness: of members, then springs, at each state, float[states, terms] [N/m].
        slope: of the stiffness by the parameters, float[parameters, terms].
    """

    start: Structure
    members: IntArray
    springs: IntArray
    first: FloatArray
    stiffness: FloatArray
    slope: FloatArray


def variation(change: Callable[[FloatArray], Structure], states: FloatArray) -> Variation | None:
    """What varies between states, or None where it is more than straight stiffnesses.

    Args:
        change: makes the structure of a state.
        states: parameters, float[states, parameters]; two states or more.
    """
    start = change(states[0])
    first = _stiffness(start)
    slope = np.zeros((states.shape[1], len(first)))
    for column in np.flatnonzero(np.ptp(states, axis=0) > 0):
        low, high = states[:, column].min(), states[:, column].max()
        found = []
        for value in (low, (low + high) / 2, high):
            state = states[0].copy()
            state[column] = value
            other = change(state)
            if not _only_stiffness_differs(start, other):
                return None
            found.append(_stiffness(other))
        if not np.allclose(found[1], (found[0] + found[2]) / 2, rtol=1e-12, atol=0):
            return None
        slope[column] = (found[2] - found[0]) / (high - low)
    stiffness = first + (states - states[0]) @ slope
    for row in np.unique(np.linspace(0, len(states) - 1, CHECKED).astype(int)):
        other = change(states[row])
        if not np.allclose(_stiffness(other), stiffness[row], rtol=1e-12, atol=0):
            return None
    terms = np.flatnonzero(slope.any(axis=0))
    count = len(start.arrays["ends"])
    members, springs = terms[terms < count], terms[terms >= count] - count
    return Variation(start, members, springs, first[terms], stiffness[:, terms], slope[:, terms])


def _stiffness(structure: Structure) -> FloatArray:
    """EA / L of every member, then the stiffness of every spring."""
    arrays = structure.arrays
    axial = arrays["E"] * arrays["A"] / structure.lengths
    return np.concatenate([axial, arrays["spring_stiffness"]])


def _only_stiffness_differs(one: Structure, other: Structure) -> bool:
    if other.bearings or other.laws or one.arrays.keys() != other.arrays.keys():
        return False
    bends = one.arrays["frame"]
    for name, array in one.arrays.items():
        changed = other.arrays[name]
        if array.shape != changed.shape:
            return False
        if name == "spring_stiffness":
            continue
        if name in AXIAL:
            array, changed = array[bends], changed[bends]
        if not np.array_equal(array, changed, equal_nan=array.dtype == float):
            return False
    same = (np.array_equal(getattr(one, name), getattr(other, name)) for name in ("alpha", "host"))
    return all(same)
