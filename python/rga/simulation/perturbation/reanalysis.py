"""A structure solved once: further loads, and a few stiffnesses that differ, cost little more."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.arrays import FloatArray, IntArray
from rga.model.structure import Load, Structure
from rga.simulation.paths.pseudo_forces import (
    at_rest,
    own_readings,
    parting,
    with_motions,
    with_unit_forces,
)
from rga.simulation.paths.rank_one_terms import stiffness_terms
from rga.simulation.paths.response import patterns, refused
from rga.simulation.perturbation.frame_change import Alone, change, motions, stiffened

#: properties of a truss member that only reach the answer through EA / L
AXIAL = ("E", "G", "A")
#: further ones of a frame member
BENDING = ("Iy", "Iz", "connection")
#: arrays that may differ between structures near each other
STIFFNESS = {*AXIAL, *BENDING, "spring_stiffness"}
#: frame members that may differ, beyond which a solve of the whole structure is no dearer
FEW = 4
#: loads that are remembered
KEPT = 32


@dataclass(frozen=True)
class Loaded:
    """What load patterns with coefficient one do to a structure.

    Attributes:
        outputs: float[patterns, outputs] in SI units.
        elongations: of the terms, float[patterns, terms] [m or rad].
        displacements: of the nodes of frame members, float[patterns, 6 nodes] [m and rad].
        pattern: the loads as the core takes them.
        alone: frame members cut out under these loads, by their numbers, once known.
    """

    outputs: FloatArray
    elongations: FloatArray
    displacements: FloatArray
    pattern: dict[str, NDArray[Any]]
    alone: dict[bytes, Alone] = field(default_factory=dict)


@dataclass(frozen=True)
class OnTerms:
    """A structure under loads condensed onto some of its terms, as `Condensation` tells."""

    stiffness: FloatArray
    loaded: FloatArray
    stretched: FloatArray
    influence: FloatArray
    unit: FloatArray


@dataclass(frozen=True)
class StiffnessDifference:
    """Where the stiffness of a structure differs: terms, and numbers of frame members."""

    terms: IntArray
    frames: IntArray


class Reanalysis:
    """The response of one structure, and of those near it.

    What unit pseudo-forces at every truss member and spring do is known from one solve, and what
    they do along frame members with springs at their ends: trusses with stiff joints. A term of
    stiffness k + d and elongation v acts like one of stiffness k with the pseudo-force d v beside
    it, so that structures that differ in few terms cost a system of as many equations
    (`condensation` has the algebra and its source).

    Args:
        structure: must not be changed afterwards.

    Raises:
        UnstableStructureError: the structure can move; names node and direction.
        InputError: a property that the core refuses.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        arrays = structure.arrays
        springy = np.isfinite(arrays["connection"]) & (arrays["connection"] > 0)
        members = np.flatnonzero(~arrays["frame"] | springy.any(axis=1))
        springs = np.arange(len(arrays["spring_stiffness"]))
        #: number of each term, springs behind all members
        self._terms = np.concatenate([members, len(arrays["frame"]) + springs])
        self._lengths = structure.lengths
        self._stiffness = self._stiffness_of(structure)
        self._content = self._but_stiffness(structure)
        self._nodes = np.unique(arrays["ends"][arrays["frame"]])
        self._stretching, _ = stiffness_terms(
            arrays, structure.outputs, members, springs, axial=True
        )
        wanted = with_motions(structure.outputs, self._stretching)
        moved = motions(self._nodes)
        self._outputs = {
            name: np.concatenate([column, moved[name].astype(column.dtype)])
            for name, column in wanted.items()
        }
        self._forced: Loaded | None = None
        self._known: dict[bytes, Loaded] = {}
        found = self._solved(with_unit_forces(patterns(structure, []), self._stretching))
        own = own_readings(structure.outputs, self._stretching)
        self._influence, self._unit = found.outputs + own, found.elongations

    def under(self, loads: list[Load]) -> Loaded:
        """The structure under loads; InputError for a property that the core refuses."""
        pattern = patterns(self.structure, loads)
        content = b"".join(array.tobytes() for array in pattern.values())
        if content not in self._known:
            self._known[content] = self._solved(pattern)
            if len(self._known) > KEPT:
                del self._known[next(iter(self._known))]
        return self._known[content]

    def differing(self, other: Structure) -> StiffnessDifference | None:
        """Where stiffnesses differ; None where more than few stiffnesses do."""
        if self._but_stiffness(other) != self._content:
            return None
        straight = np.append(
            ~self.structure.arrays["frame"], np.ones(len(other.arrays["spring_stiffness"]), bool)
        )
        differ = (self._stiffness_of(other) != self._stiffness) & straight
        terms = np.flatnonzero(differ[self._terms])
        own, theirs = self.structure.arrays, other.arrays
        count = len(own["frame"])
        differs = [
            (own[name] != theirs[name]).reshape(count, -1).any(axis=1)
            for name in (*AXIAL, *BENDING)
        ]
        frames = np.flatnonzero(np.any(differs, axis=0) & own["frame"])
        if len(frames) > FEW or (len(frames) and len(terms)):
            return None
        return StiffnessDifference(terms, frames)

    def changed(self, loaded: Loaded, other: Structure, where: StiffnessDifference) -> FloatArray:
        """Outputs of a structure near this one, float[patterns, outputs] in SI units.

        Args:
            loaded: this structure under the loads.
            other: the structure near it.
            where: it differs.
        """
        if len(where.frames):
            return self._with_frames(loaded, other, where.frames)
        terms = where.terms
        if not len(terms):
            return loaded.outputs
        place = self._terms[terms]
        stiffer = self._stiffness_of(other)[place] - self._stiffness[place]
        matrix = np.eye(len(terms)) + self._unit[np.ix_(terms, terms)] * stiffer
        elongations = np.linalg.solve(matrix, loaded.elongations[:, terms].T).T
        return np.asarray(loaded.outputs - (elongations * stiffer) @ self._influence[terms])

    def onto(self, loaded: Loaded, members: IntArray, springs: IntArray) -> OnTerms | None:
        """The structure under loads condensed along members and onto springs.

        None for frame members without springs at their ends.
        """
        wanted = np.append(members, len(self._lengths) + springs)
        if not np.isin(wanted, self._terms).all():
            return None
        terms = np.searchsorted(self._terms, wanted)
        return OnTerms(
            self._stretching.stiffness[terms],
            loaded.outputs,
            loaded.elongations[:, terms],
            self._influence[terms],
            self._unit[np.ix_(terms, terms)],
        )

    def _with_frames(self, loaded: Loaded, other: Structure, frames: IntArray) -> FloatArray:
        if self._forced is None:
            self._forced = self._under_forces()
        first = 6 * np.searchsorted(self._nodes, self.structure.arrays["ends"][frames])
        ends = (first[:, :, None] + np.arange(6)).ravel()
        key = frames.tobytes()
        if key not in loaded.alone:
            loaded.alone[key] = Alone(self.structure, frames, loaded.pattern)
        return loaded.outputs + change(
            loaded.alone[key],
            Alone(other, frames, loaded.pattern),
            loaded.displacements[:, ends],
            self._forced.displacements[np.ix_(ends, ends)],
            self._forced.outputs[ends],
        )

    def _under_forces(self) -> Loaded:
        """The structure under unit forces and moments on the nodes of frame members."""
        units = stiffened(self.structure, self._nodes)
        unit = patterns(self.structure, [])
        unit |= {
            name: np.zeros((len(units), *unit[name].shape[1:]))
            for name in ("forces", "strain", "prescribed", "prescribed_inclined")
        }
        unit["forces"][:, self._nodes] = units.reshape(len(units), -1, 6)
        found = self._solved(unit)
        return replace(
            found, outputs=units.T @ found.outputs, displacements=units.T @ found.displacements
        )

    def rates(self, loaded: Loaded) -> dict[int, FloatArray]:
        """Derivatives of the outputs by the logarithm of EA of members that are terms.

        Returns:
            float[patterns, outputs] by the number of the member.
        """
        count = len(self._lengths)
        return {
            int(member): -self._stretching.stiffness[term]
            * np.outer(loaded.elongations[:, term], self._influence[term])
            for term, member in enumerate(self._terms)
            if member < count
        }

    def _stiffness_of(self, structure: Structure) -> FloatArray:
        """EA / L of every member, then the stiffness of every spring."""
        arrays = structure.arrays
        axial = arrays["E"] * arrays["A"] / self._lengths
        return np.concatenate([axial, arrays["spring_stiffness"]])

    @staticmethod
    def _but_stiffness(structure: Structure) -> list[bytes]:
        """All of a structure and its outputs but what `STIFFNESS` names."""
        parts = [array for name, array in structure.arrays.items() if name not in STIFFNESS]
        return [array.tobytes() for array in (*parts, *structure.outputs.values())]

    def _solved(self, pattern: dict[str, NDArray[Any]]) -> Loaded:
        try:
            found = _core.respond(self.structure.arrays, pattern, self._outputs)
        except (_core.UnstableStructure, _core.InvalidInput) as error:
            raise refused(self.structure, error) from None
        first = len(self.structure.per_si)
        last = first + 3 * len(self._stretching)
        elongations = parting(found[:, first:last]) - at_rest(pattern, self._stretching)
        return Loaded(found[:, :first].copy(), elongations, found[:, last:], pattern)
