"""The cheapest exact path to the response of rows: chosen from what varies between them."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from rga import _core
from rga._core import Condensation, DependentTerms
from rga.arrays import FloatArray, IntArray, LoadArrays, by_name
from rga.errors import InputError
from rga.model.structure import Load, Structure
from rga.simulation.paths.factorisation import Factorisation
from rga.simulation.paths.friction import respond_with_friction
from rga.simulation.paths.friction_past import FrictionPast
from rga.simulation.paths.large_displacements import respond_deformed
from rga.simulation.paths.response import patterns, refused, respond
from rga.simulation.paths.unilateral import LawTable, laws_alone, respond_with_laws, terms_of
from rga.simulation.paths.variation import Variation, VariationWithin, unvaried, variation
from rga.simulation.perturbation.chebyshev import along_line

NOTHING: IntArray = np.zeros(0, np.int64)
#: structures that are solved one by one, which costs less than to look for what varies
APART = 4
#: terms that vary, beyond which a factorisation of the whole structure is no dearer
MOST_TERMS = 32
#: condensed structures that a simulator keeps
KEPT = 8
Path = Literal["C1", "C2", "C3", "C4"]
WORDS: dict[Path, str] = {
    "C1": "one structure for all rows: a matrix times the coefficients of the loads",
    "C2": "few stiffnesses vary: condensed, one small solve a row",
    "C3": "the structure varies: one factorisation for each of its states",
    "C4": "friction, play, slack or large displacements: solved row by row",
}


@dataclass(frozen=True)
class CondensedPaths:
    """What was condensed once.

    Attributes:
        structure: as an object; no effect changes one after it was condensed.
        patterns: of the loads, as objects.
        content: bytes of all arrays that tell what was condensed.
        found: the condensation.
    """

    structure: Structure
    patterns: list[tuple[object, ...]]
    content: list[bytes]
    found: Condensation

    def is_of(self, structure: Structure, loads: list[Load], apart: list[bytes]) -> bool:
        """Whether the very same objects are asked for again: quicker to tell than by content."""
        return (
            structure is self.structure
            and len(loads) == len(self.patterns)
            and self.content[-len(apart) :] == apart
            and all(
                one is other
                for load, known in zip(loads, self.patterns, strict=True)
                for one, other in zip(load.pattern, known, strict=True)
            )
        )


@dataclass(frozen=True)
class Request:
    """What is asked of a structure.

    Attributes:
        states: structural parameters, float[states, parameters].
        state_of_row: int[rows].
        change: makes the structure of a state.
        loads: load patterns on a structure, with coefficients of the rows that are named. What a
            pattern is depends on the structure alone.
        fixed_patterns: no stiffness changes a load pattern.
        prepared: what earlier requests of the same model have condensed, by content.
        over_ranges: what varies over the ranges of the contexts, where that is known.
        friction: where bearings stand after the rows before; in place, after these.
    """

    states: FloatArray
    state_of_row: IntArray
    change: Callable[[FloatArray], Structure]
    loads: Callable[[Structure, IntArray], list[Load]]
    fixed_patterns: bool
    prepared: list[CondensedPaths]
    over_ranges: Callable[[], VariationWithin | None]
    friction: FrictionPast = field(default_factory=FrictionPast)

    @property
    def of_rows(self) -> FloatArray:
        """Structural parameters of every row, float[rows, parameters]."""
        return self.states[self.state_of_row]

    def same_patterns(self, one: Structure, other: Structure) -> bool:
        """Whether the load patterns on two structures are the same.

        Where a spring stands for a support, a settlement pushes on it: its load follows a
        stiffness.
        """
        if self.fixed_patterns:
            return True
        here, there = (
            by_name(patterns(each, self.loads(each, NOTHING))).values() for each in (one, other)
        )
        return all(np.array_equal(*pair) for pair in zip(here, there, strict=True))


@dataclass(frozen=True)
class ResponsePlan:
    """How the rows of a request are answered.

    Attributes:
        path: of design 7.1: C1 loads and temperatures vary, C2 a few stiffnesses, C3 the
            structure, C4 friction, play or large displacements.
        rows, states, patterns, terms, sensors: how many rows, different structures, load
            patterns, condensed stiffnesses and sensors there are.
    """

    path: Path
    rows: int
    states: int
    patterns: int
    terms: int
    sensors: int

    def __str__(self) -> str:
        counts = f"{self.rows} rows, {self.states} structures, {self.patterns} load patterns, "
        counts += f"{self.terms} condensed stiffnesses, {self.sensors} sensors"
        return f"{self.path}: {WORDS[self.path]} ({counts})"


def answer(request: Request) -> tuple[ResponsePlan, FloatArray]:
    """Plan of a request, and the sensors of its rows, float[rows, sensors] in SI units.

    Raises:
        UnstableStructureError: a structure can move; names node and direction.
        InputError: a property that the core refuses.
    """
    rows = np.arange(len(request.state_of_row))
    request.friction.pass_through(request.states, request.state_of_row)
    varied = _varied(request)
    structure = request.change(request.states[0]) if varied is None else varied.start
    loads = request.loads(structure, rows)
    sensors = len(structure.per_si)

    def plan(path: Path, terms: int = 0) -> ResponsePlan:
        return ResponsePlan(path, len(rows), len(request.states), len(loads), terms, sensors)

    if not loads or not sensors:
        return plan("C1"), np.zeros((len(rows), sensors))
    if not structure.linear:
        return plan("C4"), _each_state(request)
    if varied is None:
        return plan("C3"), _each_state(request)
    q, stiffness = coefficients(loads), varied.at(request.states)[request.state_of_row]
    for path, system in linear_paths(request.prepared, varied, loads):
        try:
            return plan(path, system.terms), system.respond(q, stiffness)
        except (_core.UnstableSample, DependentTerms):
            continue  # a factorisation of each sample decides, and names what is wrong
        except (_core.UnstableStructure, _core.InvalidInput) as error:
            raise refused(structure, error) from None
    return plan("C3"), _each_state(request)


def _varied(request: Request) -> Variation | None:
    """What varies between the rows of a request; None where its states are to be solved apart."""
    states, limits = request.states, request.over_ranges()
    if len(states) > APART:
        return variation_under(request, states)
    known = None
    if limits is not None and limits.varying <= APART and len(states) == len(request.state_of_row):
        # What was condensed for structures of all rows is cheaper than to condense that of each.
        known = limits.of(states)
    if known is None and len(states) == 1:
        return unvaried(request.change(states[0]), states.shape[1])
    return known


def variation_under(request: Request, states: FloatArray) -> Variation | None:
    """What varies between states, or None where it is more than straight stiffnesses."""
    limits = request.over_ranges()
    known = None if limits is None else limits.of(states)
    return variation_between(request, states) if known is None else known


def variation_between(request: Request, states: FloatArray) -> Variation | None:
    """The same, whatever is known of the ranges of the contexts."""
    varied = variation(request.change, states)
    if varied is None or request.fixed_patterns:
        return varied
    low, high = states.min(axis=0), states.max(axis=0)
    far = request.change(np.where(high > states[0], high, low))
    return varied if request.same_patterns(varied.start, far) else None


def linear_paths(
    prepared: list[CondensedPaths], varied: Variation, loads: list[Load]
) -> Iterator[tuple[Path, Condensation | Factorisation]]:
    """Ways to the response when nothing but these stiffnesses and loads vary, cheapest first."""
    structure, members, springs = varied.start, varied.members, varied.springs
    count = len(members) + len(springs)
    if not count or (count <= MOST_TERMS and varied.terms <= MOST_TERMS):
        with suppress(DependentTerms):
            path: Path = "C2" if count else "C1"
            yield path, condensed(prepared, structure, loads, members, springs)
    if (varied.first > 0).all():
        arrays, of_loads = structure.arrays, patterns(structure, loads)
        try:
            whole = Factorisation(
                arrays, of_loads, structure.outputs, members, springs, varied.first
            )
        except (_core.UnstableStructure, _core.InvalidInput) as error:
            raise refused(structure, error) from None
        yield "C3", whole


def _each_state(request: Request) -> FloatArray:
    rows = np.arange(len(request.state_of_row))

    def solve(structure: Structure) -> tuple[FloatArray, FloatArray]:
        loads = request.loads(structure, rows)
        return coefficients(loads), respond(structure, loads, structure.outputs)

    straight = along_line(request, solve)
    if straight is not None:
        return straight
    if len(request.states) > APART and request.fixed_patterns:
        found = laws_alone([request.change(state) for state in request.states])
        if found is not None:
            structure, table = found
            of_rows = LawTable(
                table.size[request.state_of_row], table.stiffness[request.state_of_row]
            )
            return with_laws(request.prepared, structure, request.loads(structure, rows), of_rows)
    parts = []
    order = np.argsort(request.state_of_row, kind="stable")
    starts = np.searchsorted(request.state_of_row[order], np.arange(len(request.states) + 1))
    friction = request.friction
    for number, state in enumerate(request.states):
        chosen = order[starts[number] : starts[number + 1]]
        structure = request.change(state)
        loads = request.loads(structure, chosen)
        if structure.nonlinear:
            parts.append(respond_deformed(structure, loads, chosen))
        elif structure.laws:
            parts.append(with_laws(request.prepared, structure, loads))
        elif structure.bearings and friction.changes >= APART:
            # Friction starts anew with each structure, and would never come to hold.
            raise InputError(
                "friction is simulated through rows that share a structure, and this one changes "
                f"{friction.changes} times",
                "bearing_friction",
                "let nothing that changes from row to row drive mu or a stiffness beside it",
            )
        elif structure.bearings:
            key = tuple(state.tolist())
            part, rested = respond_with_friction(structure, loads, friction.rested.get(key))
            friction.rested[key] = rested
            parts.append(part)
        else:
            of_structure = _condense(structure, patterns(structure, loads))
            parts.append(of_structure.respond(coefficients(loads), np.zeros((len(chosen), 0))))
    out = np.empty((len(order), parts[0].shape[1]))
    out[order] = np.concatenate(parts)
    return out


def with_laws(
    prepared: list[CondensedPaths],
    structure: Structure,
    loads: list[Load],
    table: LawTable | None = None,
) -> FloatArray:
    """A structure with play or slack under loads, float[rows, sensors] in SI units.

    Args:
        prepared: what was condensed before.
        structure: with its laws.
        loads: on it.
        table: the laws of every row; None: those of the structure.
    """
    if structure.bearings:
        raise InputError(
            "friction and slack are not simulated together", "effects", "leave out one of them"
        )
    members, springs = terms_of(structure)
    linear = condensed(prepared, structure, loads, members, springs, axial=True)
    return respond_with_laws(structure, linear, coefficients(loads), table)


def condensed(
    prepared: list[CondensedPaths],
    structure: Structure,
    loads: list[Load],
    members: IntArray = NOTHING,
    springs: IntArray = NOTHING,
    axial: bool = False,
) -> Condensation:
    """A structure condensed onto its loads, sensors, and the members and springs that vary."""
    apart = [array.tobytes() for array in (members, springs, np.array(axial))]
    for known in prepared:
        if known.is_of(structure, loads, apart):
            return known.found
    of_loads = patterns(structure, loads)
    parts = by_name(structure.arrays), by_name(of_loads), by_name(structure.outputs)
    content = [array.tobytes() for part in parts for array in part.values()] + apart
    for known in prepared:
        if known.content == content:
            return known.found
    found = _condense(structure, of_loads, members, springs, axial)
    prepared.append(CondensedPaths(structure, [load.pattern for load in loads], content, found))
    del prepared[:-KEPT]
    return found


def _condense(
    structure: Structure,
    of_loads: LoadArrays,
    members: IntArray = NOTHING,
    springs: IntArray = NOTHING,
    axial: bool = False,
) -> Condensation:
    try:
        return Condensation(structure.arrays, of_loads, structure.outputs, members, springs, axial)
    except (_core.UnstableStructure, _core.InvalidInput) as error:
        raise refused(structure, error) from None


def coefficients(loads: list[Load]) -> FloatArray:
    """Of all patterns, float[rows, patterns]."""
    return np.ascontiguousarray(np.column_stack([load.coefficient for load in loads]))
