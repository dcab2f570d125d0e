"""Which stiffnesses of a structure vary from row to row, and how."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.arrays import FloatArray, IntArray, StructureArrays, by_name
from rga.model.structure import Structure

#: rows at which straightness is checked, beside the ends of each parameter
CHECKED = 6


@dataclass(frozen=True)
class Variation:
    """Members and springs whose stiffness follows structural parameters, straight in each of them.

    Where several parameters act on a stiffness, they add to it or multiply it.

    Attributes:
        start: the structure at the first state.
        members, springs: numbers of those that vary; a frame member varies as a whole.
        origin: the first state, float[parameters].
        first: stiffness of members, then springs, there, float[elements]: EA / L of a truss member
            [N/m], E of a frame member [Pa], of a spring [N/m or N m/rad].
        slope: of `first` by the parameters, float[parameters, elements].
        multiplied: bool[elements], where parameters multiply.
    """

    start: Structure
    members: IntArray
    springs: IntArray
    origin: FloatArray
    first: FloatArray
    slope: FloatArray
    multiplied: NDArray[np.bool_]

    def at(self, states: FloatArray) -> FloatArray:
        """Stiffness at states, float[states, parameters] -> float[states, elements]."""
        moved = states - self.origin
        found = np.asarray(self.first + moved @ self.slope)
        product = np.flatnonzero(self.multiplied)
        if len(product):
            found[:, product] = self.first[product]
        for column in np.flatnonzero(self.slope[:, product].any(axis=1)):
            own = product[self.slope[column, product] != 0]
            share = self.slope[column, own] / self.first[own]
            found[:, own] *= 1.0 + moved[:, [column]] * share
        return found

    @property
    def terms(self) -> int:
        """How many terms of rank one vary."""
        return _core.count_terms(self.start.arrays, self.start.outputs, self.members, self.springs)


def unvaried(structure: Structure, parameters: int) -> Variation:
    """One structure, at any of whose structural parameters nothing varies."""
    nothing, none = np.zeros(0, np.int64), np.zeros(0)
    slope = np.zeros((parameters, 0))
    return Variation(structure, nothing, nothing, np.zeros(parameters), none, slope, none > 0)


def variation(change: Callable[[FloatArray], Structure], states: FloatArray) -> Variation | None:
    """What varies between states, or None where it is more than stiffnesses straight in each.

    Args:
        change: makes the structure of a state.
        states: parameters, float[states, parameters]; two states or more.
    """
    start = change(states[0])
    first = _stiffness(start)
    slope = np.zeros((states.shape[1], len(first)))
    for column in np.flatnonzero(np.ptp(states, axis=0) > 0):
        low, high = states[:, column].min(), states[:, column].max()
        three = []
        for value in (low, (low + high) / 2, high):
            state = states[0].copy()
            state[column] = value
            other = change(state)
            if not _only_stiffness_differs(start, other):
                return None
            three.append(_stiffness(other))
        if not np.allclose(three[1], (three[0] + three[2]) / 2, rtol=1e-12, atol=0):
            return None
        slope[column] = (three[2] - three[0]) / (high - low)
    low, high = states.min(axis=0), states.max(axis=0)
    chosen = np.unique(np.linspace(0, len(states) - 1, CHECKED).astype(int))
    # Parameters that act together show at the far corner, where all have moved.
    looked_at = np.vstack([states[chosen], np.where(high > states[0], high, low)])
    others = [change(state) for state in looked_at]
    truth = np.stack([_stiffness(other) for other in others])
    shared = ((slope != 0).sum(axis=0) > 1) & (first > 0)
    varied = np.flatnonzero(slope.any(axis=0))
    count = len(start.arrays["ends"])
    members, springs = varied[varied < count], varied[varied >= count] - count
    for multiplied in (np.zeros_like(shared), shared):
        found = Variation(
            start, members, springs, states[0], first[varied], slope[:, varied], multiplied[varied]
        )
        there = np.tile(first, (len(looked_at), 1))
        there[:, varied] = found.at(looked_at)
        if np.allclose(truth, there, rtol=1e-12, atol=0):
            return found
    return None


def _stiffness(structure: Structure) -> FloatArray:
    """EA / L of every truss member or E of a frame member, then the stiffness of every spring."""
    arrays = structure.arrays
    axial = arrays["E"] * arrays["A"] / structure.lengths
    own = np.where(arrays["frame"], arrays["E"], axial)
    return np.concatenate([own, arrays["spring_stiffness"]])


def _only_stiffness_differs(one: Structure, other: Structure) -> bool:
    if other.bearings or other.laws:
        return False
    for name, array in by_name(one.arrays).items():
        changed = by_name(other.arrays)[name]
        if array.shape != changed.shape:
            return False
        if name in ("E", "G", "spring_stiffness"):
            continue
        if name == "A":
            array, changed = array[one.arrays["frame"]], changed[one.arrays["frame"]]
        if not np.array_equal(array, changed, equal_nan=array.dtype == float):
            return False
    outputs = by_name(other.outputs)
    read = (np.array_equal(array, outputs[name]) for name, array in by_name(one.outputs).items())
    same = (np.array_equal(getattr(one, name), getattr(other, name)) for name in ("alpha", "host"))
    return all(read) and all(same) and _frames_differ_as_a_whole(one.arrays, other.arrays)


def _frames_differ_as_a_whole(one: StructureArrays, other: StructureArrays) -> bool:
    """Where E of a frame member differs, G does in proportion, and no end of the member yields."""
    frame = one["frame"]
    yields = (np.isfinite(one["connection"]) & (one["connection"] > 0)).any(axis=1)
    if (frame & yields & (one["E"] != other["E"])).any():
        return False
    ahead, behind = (one["G"] * other["E"])[frame], (other["G"] * one["E"])[frame]
    return np.allclose(ahead, behind, rtol=1e-12, atol=0)
