"""Exact condensation of a structure onto its loads, its outputs and the few terms that vary."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.model.parameter import FloatArray
from rga.model.structure import IntArray

Arrays = dict[str, NDArray[Any]]
STRAIN, REACTION_FORCE = 2, 4
#: the elongations under unit pseudo-forces must be independent to at least this share
INDEPENDENT = 1e-7


class Condensation:
    """A structure for which only stiffnesses of some truss members and springs vary.

    A member or spring of stiffness k (1 + m) and elongation v acts on the structure as it is like
    one of stiffness k with the pseudo-force w = k m v beside it. Elongations under unit
    pseudo-forces are a matrix G; its inverse is the stiffness that these terms see, and a sample
    costs a factorisation of that size alone (Woodbury's identity; Akgun et al., Fast exact linear
    and non-linear structural reanalysis, IJNME 50, 2001). Forces of temperature and of lack of fit
    scale with the stiffness of their member.

    Attributes:
        stiffness: of the terms in the structure as it is, float[terms] [N/m or N m/rad].
        loaded, stretched: outputs and elongations under unit loads, float[patterns, outputs] and
            float[patterns, terms].
        influence, unit: the same under unit pseudo-forces, float[terms, outputs] and
            float[terms, terms].
        own: part of the influence that comes of what outputs on a term read of its own
            pseudo-force, float[terms, outputs].

    Args:
        structure, loads, outputs: as `_core.respond` takes them; all patterns are kept.
        members: numbers of the truss members that vary, int[members].
        springs: numbers of the springs that vary, int[springs].

    Raises:
        DependentTerms: elongations depend on each other, so that no inverse exists.
        _core.UnstableStructure, _core.InvalidInput: as `_core.respond`.
    """

    def __init__(
        self,
        structure: Arrays,
        loads: Arrays,
        outputs: Arrays,
        members: IntArray,
        springs: IntArray,
    ) -> None:
        members, springs = np.asarray(members, np.int64), np.asarray(springs, np.int64)
        patterns, count = len(loads["forces"]), len(outputs["kind"])
        axial = structure["E"] * structure["A"]
        ends = structure["coordinates"][structure["ends"][members]]
        lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        self.stiffness = np.concatenate(
            [axial[members] / lengths, structure["spring_stiffness"][springs]]
        )
        found = _core.respond(
            structure,
            with_unit_forces(structure, loads, members, springs),
            with_elongations(structure, outputs, members, springs),
        )
        scale = np.concatenate([lengths, np.ones(len(springs))])
        elongations = found[:, count:] * scale
        self.own = own_readings(structure, outputs, members, springs)
        unit = elongations[patterns:].copy()
        of_members = np.arange(len(members))
        # A unit initial force lengthens a free member by 1 / k, which its gauge does not read.
        unit[of_members, of_members] += 1.0 / self.stiffness[: len(members)]
        self.unit = (unit + unit.T) / 2
        self.loaded, self.stretched = found[:patterns, :count].copy(), elongations[:patterns]
        self.influence = found[patterns:, :count] + self.own
        inverse = _inverse(self.unit)
        self._core = _core.Condensed(self.loaded, self.stretched @ inverse, inverse, self.influence)

    def respond(
        self,
        coefficients: FloatArray,
        stiffness: FloatArray,
        threads: int = 1,
        out: FloatArray | None = None,
    ) -> FloatArray:
        """Outputs of samples, float[rows, outputs] in SI units.

        Args:
            coefficients: of the load patterns, float[rows, patterns].
            stiffness: of each term, members first, float[rows, terms] [N/m or N m/rad].
            threads: how many share the rows; the results do not depend on it.
            out: where to write them, in C order; left out, a new array.

        Raises:
            _core.UnstableSample: names the row.
        """
        return self._core.respond(coefficients, stiffness - self.stiffness, threads, out)

    def differentiate(
        self,
        coefficients: FloatArray,
        stiffness: FloatArray,
        coefficient_rates: FloatArray,
        stiffness_rates: FloatArray,
        threads: int = 1,
    ) -> FloatArray:
        """Derivatives of the outputs along directions, float[rows, outputs, directions].

        Args:
            coefficients, stiffness, threads: as for `respond`.
            coefficient_rates: derivatives of the coefficients, float[rows, patterns, directions].
            stiffness_rates: derivatives of the stiffnesses, float[rows, terms, directions].
        """
        loads = np.argwhere(coefficient_rates.any(axis=0).T)
        terms = np.argwhere(stiffness_rates.any(axis=0).T)
        found = self._core.differentiate(
            coefficients,
            stiffness - self.stiffness,
            coefficient_rates.shape[2],
            loads,
            coefficient_rates[:, loads[:, 1], loads[:, 0]],
            terms,
            stiffness_rates[:, terms[:, 1], terms[:, 0]],
            threads,
        )
        return found.transpose(0, 2, 1)


class DependentTerms(ArithmeticError):
    """The elongations of the terms that vary depend on each other."""


def with_unit_forces(
    structure: Arrays, loads: Arrays, members: IntArray, springs: IntArray
) -> Arrays:
    """The loads, then a pattern for each term: what a unit of pseudo-force does."""
    extended = dict(loads)
    count = len(members) + len(springs)
    for name in ("forces", "strain", "prescribed", "prescribed_inclined"):
        extended[name] = np.concatenate([loads[name], np.zeros((count, *loads[name].shape[1:]))])
    first = len(loads["forces"])
    axial = structure["E"] * structure["A"]
    extended["strain"][first + np.arange(len(members)), members, 0] = 1.0 / axial[members]
    node, to = structure["spring_node"][springs].T
    dof = structure["spring_dof"][springs]
    rows = first + len(members) + np.arange(len(springs))
    extended["forces"][rows, node, dof] += 1.0
    between = to >= 0
    extended["forces"][rows[between], to[between], dof[between]] -= 1.0
    return extended


def with_elongations(
    structure: Arrays, outputs: Arrays, members: IntArray, springs: IntArray
) -> Arrays:
    """The outputs, then the mechanical strain of each member and the elongation of each spring."""
    node, to = structure["spring_node"][springs].T
    dof = structure["spring_dof"][springs]
    vector = np.zeros((len(members) + len(springs), 3))
    vector[len(members) + np.arange(len(springs)), dof % 3] = 1.0
    added = {
        "kind": np.concatenate([np.full(len(members), STRAIN), dof // 3]),
        "index": np.concatenate([members, node]),
        "other": np.concatenate([np.full(len(members), -1), to]),
        "vector": vector,
        "total": np.zeros(len(vector), dtype=bool),
    }
    return {
        name: np.concatenate([outputs[name], column.astype(outputs[name].dtype)])
        for name, column in added.items()
    }


def own_readings(
    structure: Arrays, outputs: Arrays, members: IntArray, springs: IntArray
) -> FloatArray:
    """What outputs on a term read of its own pseudo-force, float[terms, outputs].

    The pseudo-force of a member is an initial strain that no gauge is to read; that of a spring to
    the ground is a part of the reaction there.
    """
    own = np.zeros((len(members) + len(springs), len(outputs["kind"])))
    axial = structure["E"] * structure["A"]
    gauges = (outputs["kind"] == STRAIN) & ~outputs["total"]
    for number, member in enumerate(members):
        own[number, gauges & (outputs["index"] == member)] = 1.0 / axial[member]
    for number, spring in enumerate(springs, start=len(members)):
        node, to = structure["spring_node"][spring]
        dof = structure["spring_dof"][spring]
        here = (outputs["kind"] == REACTION_FORCE + dof // 3) & (outputs["index"] == node)
        if to < 0:
            own[number, here] = outputs["vector"][here, dof % 3]
    return own


def _inverse(unit: FloatArray) -> FloatArray:
    if not len(unit):
        return unit
    size = np.sqrt(np.abs(np.diagonal(unit)))
    if not (np.diagonal(unit) > 0).all():
        raise DependentTerms
    values, vectors = np.linalg.eigh(unit / np.outer(size, size))
    if values[0] < INDEPENDENT:
        raise DependentTerms
    return np.asarray((vectors / values) @ vectors.T / np.outer(size, size))
