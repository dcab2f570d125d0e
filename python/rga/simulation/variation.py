"""Which stiffnesses of a structure vary from row to row, and how."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rga.model.parameter import FloatArray
from rga.model.structure import IntArray, Structure
from rga.simulation.terms import Arrays, stiffness_terms

#: rows at which straightness is checked, beside the ends of each parameter
CHECKED = 6


@dataclass(frozen=True)
class Variation:
    """Members and springs whose stiffness is a straight function of structural parameters.

    Attributes:
        start: the structure at the first state.
        members, springs: numbers of those that vary; a frame member varies as a whole.
        elements: stiffness of members, then springs, at each state, float[states, elements]: EA / L
            of a truss member [N/m], E of a frame member [Pa], of a spring [N/m or N m/rad].
        slope: of `elements` by the parameters, float[parameters, elements].
    """

    start: Structure
    members: IntArray
    springs: IntArray
    elements: FloatArray
    slope: FloatArray

    @property
    def terms(self) -> int:
        """How many terms of rank one vary."""
        terms, _ = stiffness_terms(
            self.start.arrays, self.start.outputs, self.members, self.springs
        )
        return len(terms)


def unvaried(structure: Structure, parameters: int) -> Variation:
    """One structure, at any of whose structural parameters nothing varies."""
    nothing, none = np.zeros(0, np.int64), np.zeros((1, 0))
    return Variation(structure, nothing, nothing, none, np.zeros((parameters, 0)))


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
    varied = np.flatnonzero(slope.any(axis=0))
    count = len(start.arrays["ends"])
    members, springs = varied[varied < count], varied[varied >= count] - count
    return Variation(start, members, springs, stiffness[:, varied], slope[:, varied])


def _stiffness(structure: Structure) -> FloatArray:
    """EA / L of every truss member or E of a frame member, then the stiffness of every spring."""
    arrays = structure.arrays
    axial = arrays["E"] * arrays["A"] / structure.lengths
    own = np.where(arrays["frame"], arrays["E"], axial)
    return np.concatenate([own, arrays["spring_stiffness"]])


def _only_stiffness_differs(one: Structure, other: Structure) -> bool:
    if other.bearings or other.laws or one.arrays.keys() != other.arrays.keys():
        return False
    for name, array in one.arrays.items():
        changed = other.arrays[name]
        if array.shape != changed.shape:
            return False
        if name in ("E", "G", "spring_stiffness"):
            continue
        if name == "A":
            array, changed = array[one.arrays["frame"]], changed[one.arrays["frame"]]
        if not np.array_equal(array, changed, equal_nan=array.dtype == float):
            return False
    read = (np.array_equal(array, other.outputs[name]) for name, array in one.outputs.items())
    same = (np.array_equal(getattr(one, name), getattr(other, name)) for name in ("alpha", "host"))
    return all(read) and all(same) and _frames_differ_as_a_whole(one.arrays, other.arrays)


def _frames_differ_as_a_whole(one: Arrays, other: Arrays) -> bool:
    """Where E of a frame member differs, G does in proportion, and no end of the member yields."""
    frame = one["frame"]
    yields = (np.isfinite(one["connection"]) & (one["connection"] > 0)).any(axis=1)
    if (frame & yields & (one["E"] != other["E"])).any():
        return False
    ahead, behind = (one["G"] * other["E"])[frame], (other["G"] * one["E"])[frame]
    return np.allclose(ahead, behind, rtol=1e-12, atol=0)
