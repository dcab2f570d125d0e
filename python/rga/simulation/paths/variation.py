"""Which stiffnesses of a structure vary from row to row, and how."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.arrays import FloatArray, IntArray, OutputArrays, StructureArrays, by_name
from rga.model.structure import Structure
from rga.simulation.paths.response import refused

#: rows at which straightness is checked, beside the ends of each parameter
CHECKED = 6
#: and of what lies between the smallest and largest parameters
ASKEW = (0.17, 0.71)
#: share of the range of a parameter that a value is from both ends to be looked at as well
INSIDE = 0.1


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

    def rates(self, states: FloatArray, along: FloatArray) -> FloatArray:
        """Derivatives of the stiffness at states, float[states, elements, directions].

        Args:
            states: parameters, float[states, parameters].
            along: their derivatives along directions, float[states, parameters, directions].
        """
        found = np.zeros((len(states), len(self.first), along.shape[2]))
        for column in np.flatnonzero(self.slope.any(axis=1)):
            own = np.flatnonzero(self.slope[column])
            ways = np.flatnonzero(along[:, column].any(axis=0))
            # Of a product every other factor stays.
            rate = np.broadcast_to(self.slope[column, own], (len(states), len(own)))
            if (product := self.multiplied[own]).any():
                still = states.copy()
                still[:, column] = self.origin[column]
                others = replace(
                    self, first=self.first[own], slope=self.slope[:, own], multiplied=product
                )
                rate = np.where(product, rate / others.first * others.at(still), rate)
            found[:, own[:, None], ways] += rate[:, :, None] * along[:, None, column, ways]
        return found

    @property
    def terms(self) -> int:
        """How many terms of rank one vary.

        Raises:
            InputError: a property that the core refuses.
        """
        arrays, outputs = self.start.arrays, self.start.outputs
        try:
            return _core.count_terms(arrays, outputs, self.members, self.springs)
        except _core.InvalidInput as error:
            raise refused(self.start, error) from None


class VariationWithin:
    """What varies anywhere within limits of the structural parameters.

    Args:
        low, high: the limits, float[parameters] each.
        find: what varies between them; None where it is more than straight stiffnesses.
        beyond: finds the same within wider limits; None where there are none.
    """

    def __init__(
        self,
        low: FloatArray,
        high: FloatArray,
        find: Callable[[], Variation | None],
        beyond: Callable[[], "VariationWithin | None"] = lambda: None,
    ) -> None:
        self._low, self._high, self._find, self._beyond = low, high, find, beyond

    @property
    def varying(self) -> int:
        """How many parameters vary between the limits."""
        return int((self._low < self._high).sum())

    def of(self, states: FloatArray) -> Variation | None:
        """What varies between states, float[states, parameters]; None if they lie elsewhere."""
        if not ((self._low <= states) & (states <= self._high)).all():
            return None if self._wider is None else self._wider.of(states)
        return self._varied

    @cached_property
    def _wider(self) -> "VariationWithin | None":
        return self._beyond()

    @cached_property
    def _varied(self) -> Variation | None:
        return self._find()


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
    if not np.isfinite(states).all():
        return None
    start = change(states[0])
    lengths = start.lengths
    first = _stiffness(start, lengths)
    slope = np.zeros((states.shape[1], len(first)))
    for column in np.flatnonzero(np.ptp(states, axis=0) > 0):
        low, high, here = states[:, column].min(), states[:, column].max(), states[0, column]
        inner = here if INSIDE < (here - low) / (high - low) < 1.0 - INSIDE else (low + high) / 2
        three = []
        for value in (low, inner, high):
            state = states[0].copy()
            state[column] = value
            other = start if value == here else change(state)
            if not _only_stiffness_differs(start, other):
                return None
            three.append(_stiffness(other, lengths))
        slope[column] = (three[2] - three[0]) / (high - low)
        if not np.allclose(three[1], three[0] + (inner - low) * slope[column], rtol=1e-12, atol=0):
            return None
    low, high = states.min(axis=0), states.max(axis=0)
    chosen = np.unique(np.linspace(0, len(states) - 1, CHECKED).astype(int))
    # Parameters that act together show at the far corner, where all have moved; what bends to both
    # sides alike shows at places that do not mirror each other.
    between = [np.where(low < high, low + share * (high - low), low) for share in ASKEW]
    looked_at = np.vstack([states[chosen], np.where(high > states[0], high, low), *between])
    others = [change(state) for state in looked_at]
    truth = np.stack([_stiffness(other, lengths) for other in others])
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


def _stiffness(structure: Structure, lengths: FloatArray) -> FloatArray:
    """EA / L of every truss member or E of a frame member, then the stiffness of every spring.

    Args:
        structure: with its members.
        lengths: of these, float[members] [m].
    """
    modulus, area, frame, springs = (
        _of(structure.arrays, name) for name in ("E", "A", "frame", "spring_stiffness")
    )
    return np.concatenate([np.where(frame, modulus, modulus * area / lengths), springs])


def _only_stiffness_differs(one: Structure, other: Structure) -> bool:
    if other.bearings or other.laws:
        return False
    for name in by_name(one.arrays):
        array, changed = _of(one.arrays, name), _of(other.arrays, name)
        if array is changed:
            continue
        if array.shape != changed.shape:
            return False
        if name in ("E", "G", "spring_stiffness"):
            continue
        if name == "A":
            frame = _of(one.arrays, "frame")
            array, changed = array[frame], changed[frame]
        if not np.array_equal(array, changed, equal_nan=array.dtype == float):
            return False
    pairs = [(_of(one.outputs, name), _of(other.outputs, name)) for name in by_name(one.outputs)]
    pairs += [(one.alpha, other.alpha), (one.host, other.host)]
    same = all(array is changed or np.array_equal(array, changed) for array, changed in pairs)
    return same and _frames_differ_as_a_whole(one.arrays, other.arrays)


def _frames_differ_as_a_whole(one: StructureArrays, other: StructureArrays) -> bool:
    """Where E of a frame member differs, G does in proportion, and no end of the member yields."""
    frame, connection = _of(one, "frame"), _of(one, "connection")
    here, there = ((_of(each, "E")[frame], _of(each, "G")[frame]) for each in (one, other))
    yields = (np.isfinite(connection) & (connection > 0)).any(axis=1)[frame]
    if (yields & (here[0] != there[0])).any():
        return False
    return np.allclose(here[1] * there[0], there[1] * here[0], rtol=1e-12, atol=0)


def _of(arrays: StructureArrays | OutputArrays, name: str) -> NDArray[Any]:
    """An array to look at. Read as arrays[name], a copy would hold one of its own from then on."""
    return dict.__getitem__(by_name(arrays), name)
