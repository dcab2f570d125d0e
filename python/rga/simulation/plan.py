"""The cheapest exact path to the response of rows: chosen from what varies between them."""

from collections.abc import Callable
from dataclasses import dataclass
from hashlib import blake2b
from typing import Literal

import numpy as np

from rga import _core
from rga.model.parameter import FloatArray
from rga.model.structure import IntArray, Load, Structure
from rga.simulation.condensation import Condensation, DependentTerms
from rga.simulation.friction import respond_with_friction
from rga.simulation.response import patterns, refused, respond
from rga.simulation.variation import variation

NOTHING: IntArray = np.zeros(0, np.int64)
#: condensed structures that a simulator keeps
KEPT = 8
Path = Literal["C1", "C2", "C3", "C4"]
WORDS: dict[Path, str] = {
    "C1": "one structure for all rows: a matrix times the coefficients of the loads",
    "C2": "few stiffnesses vary: condensed, one small solve a row",
    "C3": "the structure varies: one factorisation for each of its states",
    "C4": "friction: row after row, as it has a memory",
}


@dataclass(frozen=True)
class Request:
    """What is asked of a structure.

    Attributes:
        states: structural parameters, float[states, parameters].
        state_of_row: int[rows].
        change: makes the structure of a state.
        loads: load patterns on a structure, with coefficients of the rows that are named. What a
            pattern is depends on the structure alone.
        prepared: what earlier requests of the same model have condensed, by content.
    """

    states: FloatArray
    state_of_row: IntArray
    change: Callable[[FloatArray], Structure]
    loads: Callable[[Structure, IntArray], list[Load]]
    prepared: dict[bytes, Condensation]

    @property
    def of_rows(self) -> FloatArray:
        """Structural parameters of every row, float[rows, parameters]."""
        return self.states[self.state_of_row]


@dataclass(frozen=True)
class Plan:
    """How the rows of a request are answered.

    Attributes:
        path: of design 7.1: C1 loads and temperatures vary, C2 a few stiffnesses, C3 the
            structure, C4 friction.
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


def answer(request: Request) -> tuple[Plan, FloatArray]:
    """Plan of a request, and the sensors of its rows, float[rows, sensors] in SI units.

    Raises:
        UnstableStructureError: a structure can move; names node and direction.
        InputError: a property that the core refuses.
    """
    rows = np.arange(len(request.state_of_row))
    structure = request.change(request.states[0])
    loads = request.loads(structure, rows)
    sensors = len(structure.per_si)

    def plan(path: Path, terms: int = 0) -> Plan:
        return Plan(path, len(rows), len(request.states), len(loads), terms, sensors)

    if not loads or not sensors:
        return plan("C1"), np.zeros((len(rows), sensors))
    if structure.bearings:
        return plan("C4"), _each_state(request)
    if len(request.states) == 1:
        whole = condensed(request.prepared, structure, loads)
        try:
            return plan("C1"), whole.respond(coefficients(loads), np.zeros((len(rows), 0)))
        except _core.InvalidInput as error:
            raise refused(structure, error) from None
    varied = variation(request.change, request.states)
    if varied is not None:
        try:
            found = condensed(request.prepared, structure, loads, varied.members, varied.springs)
            stiffness = varied.stiffness[request.state_of_row]
            terms = stiffness.shape[1]
            return plan("C2", terms), found.respond(coefficients(loads), stiffness)
        except (DependentTerms, _core.UnstableSample, _core.InvalidInput):
            pass  # the factorisation of each state decides, and names what is wrong
    return plan("C3"), _each_state(request)


def _each_state(request: Request) -> FloatArray:
    parts = []
    order = np.argsort(request.state_of_row, kind="stable")
    starts = np.searchsorted(request.state_of_row[order], np.arange(len(request.states) + 1))
    for number, state in enumerate(request.states):
        chosen = order[starts[number] : starts[number + 1]]
        structure = request.change(state)
        loads = request.loads(structure, chosen)
        if structure.bearings:
            parts.append(respond_with_friction(structure, loads))
        else:
            parts.append(coefficients(loads) @ respond(structure, loads, structure.outputs))
    out = np.empty((len(order), parts[0].shape[1]))
    out[order] = np.concatenate(parts)
    return out


def condensed(
    prepared: dict[bytes, Condensation],
    structure: Structure,
    loads: list[Load],
    members: IntArray = NOTHING,
    springs: IntArray = NOTHING,
) -> Condensation:
    """A structure condensed onto its loads, sensors, and the members and springs that vary."""
    of_loads = patterns(structure, loads)
    told = blake2b()
    for array in (*structure.arrays.values(), *of_loads.values(), members, springs):
        told.update(repr(array.shape).encode() + np.ascontiguousarray(array).tobytes())
    key = told.digest()
    if key not in prepared:
        try:
            found = Condensation(structure.arrays, of_loads, structure.outputs, members, springs)
        except (_core.UnstableStructure, _core.InvalidInput) as error:
            raise refused(structure, error) from None
        while len(prepared) >= KEPT:
            prepared.pop(next(iter(prepared)))
        prepared[key] = found
    return prepared[key]


def coefficients(loads: list[Load]) -> FloatArray:
    """Of all patterns, float[rows, patterns]."""
    return np.ascontiguousarray(np.column_stack([load.coefficient for load in loads]))
