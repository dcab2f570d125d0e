"""Exact condensation of a structure onto its loads, its outputs and the few terms that vary."""

from functools import cached_property

import numpy as np

from rga import _core
from rga.arrays import FloatArray, IntArray
from rga.simulation.derivatives.directions import along
from rga.simulation.paths.pseudo_forces import (
    at_rest,
    own_readings,
    parting,
    with_motions,
    with_unit_forces,
)
from rga.simulation.paths.rank_one_terms import Arrays, stiffness_terms

#: the elongations under unit pseudo-forces must be independent to at least this share
INDEPENDENT = 1e-7


class Condensation:
    """A structure for which only stiffnesses of some members and springs vary.

    A term (`terms`) of stiffness k (1 + m) and elongation v acts on the structure as it is like
    one of stiffness k with the pseudo-force w = k m v beside it. Elongations under unit
    pseudo-forces are a matrix G; its inverse is the stiffness that these terms see, and a sample
    costs a factorisation of that size alone (Woodbury's identity; Akgun et al., Fast exact linear
    and non-linear structural reanalysis, IJNME 50, 2001). Forces of temperature and of lack of fit
    scale with the stiffness of their member; those of loads between its ends do not.

    Attributes:
        stiffness: of the terms in the structure as it is, float[terms] [N/m, N m/rad or Pa].
        element: place of each term among the members, then springs, that vary, int[terms].
        loaded, stretched: outputs and elongations under unit loads, float[patterns, outputs] and
            float[patterns, terms].
        influence, unit: the same under unit pseudo-forces, float[terms, outputs] and
            float[terms, terms].

    Args:
        structure, loads, outputs: as `_core.respond` takes them; all patterns are kept.
        members: numbers of the members that vary, as a whole, int[members]; no end of a frame
            member yields.
        springs: numbers of the springs that vary, int[springs].
        axial: of frame members too, no more varies than how they resist growing longer.

    Raises:
        DependentTerms: elongations are prescribed.
        _core.UnstableStructure, _core.InvalidInput: as `_core.respond`.
    """

    def __init__(
        self,
        structure: Arrays,
        loads: Arrays,
        outputs: Arrays,
        members: IntArray,
        springs: IntArray,
        axial: bool = False,
    ) -> None:
        members, springs = np.asarray(members, np.int64), np.asarray(springs, np.int64)
        terms, held = stiffness_terms(structure, outputs, members, springs, axial)
        moved = loads["prescribed"][:, held.nodes] * held.motion.reshape(-1, 2, 6)
        if (moved.sum(axis=(2, 3)) != at_rest(loads, held)).any():
            raise DependentTerms
        patterns, count = len(loads["forces"]), len(outputs["kind"])
        found = _core.respond(
            structure, with_unit_forces(loads, terms), with_motions(outputs, terms)
        )
        elongations = parting(found[:, count:])
        unit = elongations[patterns:].copy()
        self.stiffness, self.element = terms.stiffness, terms.element
        self.loaded = found[:patterns, :count].copy()
        self.stretched = elongations[:patterns] - at_rest(loads, terms)
        self.influence = found[patterns:, :count] + own_readings(outputs, terms)
        gauges = np.flatnonzero(terms.gauge >= 0)
        if len(gauges):
            read = terms.gauge[gauges]
            self.stretched[:, gauges] = _between_held_ends(structure, loads, outputs, read)
            unit[gauges, gauges] = self.influence[gauges, read] = 1.0 / self.stiffness[gauges]
        self.unit = (unit + unit.T) / 2

    @cached_property
    def _core(self) -> _core.Condensed:
        inverse = _inverse(self.unit)
        return _core.Condensed(self.loaded, self.stretched @ inverse, inverse, self.influence)

    @property
    def terms(self) -> int:
        """How many terms there are."""
        return len(self.stiffness)

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
            stiffness: of each element that varies, members first, float[rows, elements].
            threads: how many share the rows; the results do not depend on it.
            out: where to write them, in C order; left out, a new array.

        Raises:
            DependentTerms: elongations depend on each other, so that no inverse exists.
            _core.UnstableSample: names the row.
        """
        return self._core.respond(coefficients, self._changes(stiffness), threads, out)

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
            stiffness_rates: derivatives of the stiffnesses, float[rows, elements, directions].

        Raises:
            DependentTerms: as `respond`.
        """
        if not self.terms:
            rates = np.moveaxis(coefficient_rates, 2, 0)
            many = np.ascontiguousarray(rates).reshape(-1, rates.shape[2])
            found = self._core.respond(many, np.zeros((len(many), 0)), threads)
            return np.moveaxis(found.reshape(*rates.shape[:2], -1), 0, 2)
        loads, of_loads = along(coefficient_rates)
        terms, of_terms = along(stiffness_rates[:, self.element])
        changes, directions = self._changes(stiffness), coefficient_rates.shape[2]
        found = self._core.differentiate(
            coefficients, changes, directions, loads, of_loads, terms, of_terms, threads
        )
        return found.transpose(0, 2, 1)

    def pull_back(
        self,
        coefficients: FloatArray,
        stiffness: FloatArray,
        gradients: FloatArray,
        threads: int = 1,
    ) -> FloatArray:
        """Derivatives of the sum of the outputs times gradients: the adjoint of `respond`.

        Args:
            coefficients, stiffness, threads: as for `respond`.
            gradients: float[rows, outputs].

        Returns:
            float[rows, patterns + elements], by the coefficients and then by the stiffnesses.
        """
        changes = self._changes(stiffness)
        found = self._core.pull_back(coefficients, changes, gradients, threads)
        patterns, elements = coefficients.shape[1], stiffness.shape[1]
        if self.terms == elements:
            return found
        of_terms = np.eye(elements)[self.element]
        return np.concatenate([found[:, :patterns], found[:, patterns:] @ of_terms], axis=1)

    def _changes(self, stiffness: FloatArray) -> FloatArray:
        """Of the terms, float[rows, terms]: each has the stiffness of its element."""
        if self.terms == stiffness.shape[1]:
            return stiffness - self.stiffness
        return stiffness[:, self.element] - self.stiffness


class DependentTerms(ArithmeticError):
    """The elongations of the terms that vary depend on each other, or are prescribed."""


def _between_held_ends(
    structure: Arrays, loads: Arrays, outputs: Arrays, read: IntArray
) -> FloatArray:
    """What outputs read of loads along members with all nodes held, float[patterns, outputs]."""
    still = {
        name: np.zeros_like(loads[name])
        for name in ("forces", "strain", "prescribed", "prescribed_inclined")
    }
    return _core.respond(
        {**structure, "fixed": np.ones_like(structure["fixed"])},
        {**loads, **still},
        {name: column[read] for name, column in outputs.items()},
    )


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
