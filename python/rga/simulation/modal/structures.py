"""The structures whose modes are computed, and what the core computes of them."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from rga import _core
from rga.arrays import FloatArray, IntArray, MassArrays, by_name
from rga.errors import InputError
from rga.model.effect import Effect, Values, when_all_act
from rga.model.effects.loads.load_mass import LoadMass
from rga.model.schema import Model
from rga.model.structure import Structure, build_structure
from rga.simulation.contexts import Contexts, contexts_by_name
from rga.simulation.dispatch import APART, Request, variation_under
from rga.simulation.paths.response import refused
from rga.simulation.simulator import Simulator

#: states, beside the least and the largest parameters, in which masses are held against each other
DRAWN = 64


@dataclass(frozen=True)
class ModalSamples:
    """Structures that differ in stiffnesses of whole members or springs, and in nothing else.

    Attributes:
        start: near them, or one of them; of its own masses.
        masses: of all of them.
        elements: numbers of members, and of springs behind all members, that vary, int[elements].
        factors: on their stiffness in `start`, above zero, float[states, elements].
        state_of_row: int[rows].
    """

    start: Structure
    masses: MassArrays
    elements: IntArray
    factors: FloatArray
    state_of_row: IntArray


class ModalStructures:
    """What effects make of a structure that is to swing.

    Args:
        model: the structure with its effects; those on sensors change nothing of it.
    """

    def __init__(self, model: Model) -> None:
        silent = model.model_copy(update={"sensors": {}, "effects": _swinging(model)})
        self._model, self._begun = model, when_all_act(model.effects.values())
        self._simulator = Simulator(silent, build_structure(silent))

    def under(self, contexts: Contexts | None) -> tuple[list[Structure], IntArray]:
        """Structures under rows of contexts, and the number of each row's own, int[rows].

        Args:
            contexts: as for `results`.

        Raises:
            InputError: as `results`; or one has no natural frequency of its own.
        """
        request = self._request(contexts)
        structures = [request.change(state) for state in request.states]
        if not all(structure.linear for structure in structures):
            raise InputError(
                "the structure has friction, play, slack or large displacements, and so no natural "
                "frequency that is the same for every motion",
                f"model {self._model.name!r}",
                "leave out these effects, or put stiffnesses in their place",
            )
        return structures, request.state_of_row

    def samples(self, contexts: Contexts | None) -> ModalSamples | None:
        """What varies between rows, where it is stiffnesses of whole members or springs.

        Args:
            contexts: as for `results`.

        Returns:
            None where there are few states, or where something else varies: masses, say.

        Raises:
            InputError: as `results`.
        """
        # Masses that move along are alike at both ends of their ranges, and others between.
        if any(isinstance(one, LoadMass) for one in self._simulator.model.effects.values()):
            return None
        request = self._request(contexts)
        states = request.states
        varied = variation_under(request, states) if len(states) > APART else None
        if varied is None or not varied.start.linear or not (varied.first > 0).all():
            return None
        first = request.change(states[0])
        looked_at = np.vstack([states.min(axis=0), states.max(axis=0), _some(states)])
        if not all(_weigh_alike(first, request.change(state)) for state in looked_at):
            return None
        factors = varied.at(states) / varied.first
        if not (factors > 0).all():
            return None
        elements = np.append(varied.members, len(varied.start.arrays["ends"]) + varied.springs)
        return ModalSamples(varied.start, first.masses, elements, factors, request.state_of_row)

    def _request(self, contexts: Contexts | None) -> Request:
        given = self._given(contexts)
        values = self._simulator.parameters(given)
        rows = max((np.size(column) for column in given.values()), default=1)
        return self._simulator.assembly.request(values, rows)

    def table(self, contexts: Contexts | None) -> Values:
        """Contexts with time, float[rows] each, with the errors of `under` (InputError)."""
        given = {"time": 0.0, **self._given(contexts)}
        rows = max((np.size(column) for column in given.values()), default=1)
        return {
            name: np.broadcast_to(np.asarray(column, dtype=float).ravel(), rows)
            for name, column in given.items()
        }

    def _given(self, contexts: Contexts | None) -> dict[str, Any]:
        given = {} if contexts is None else dict(contexts_by_name(contexts, self._model.context))
        if self._begun is not None and "time" not in given:
            given["time"] = self._begun
        return given

    @cached_property
    def needed(self) -> set[str]:
        """Context variables that change the structure."""
        middle = {name: sum(one.range) / 2 for name, one in self._model.context.items()}
        return {
            name
            for name, one in self._model.context.items()
            if len(self.under({**middle, name: np.array(one.range)})[0]) > 1
        }

    def each_under(self, contexts: Contexts) -> list[Structure]:
        """The structure of every row, with the errors of `under` (InputError)."""
        structures, rows = self.under(contexts)
        return [structures[number] for number in rows]

    def parameters(self, contexts: Contexts) -> dict[str, Values]:
        """Parameters of the effects, by name, float[rows] each."""
        return self._simulator.parameters(dict(contexts_by_name(contexts, self._model.context)))

    def one_under(self, contexts: Contexts | None) -> Structure:
        """The structure under one row of contexts, with the errors of `under` (InputError)."""
        structures, rows = self.under(contexts)
        if len(rows) != 1:
            raise InputError("there is more than one row", "contexts of modes", "give one row")
        return structures[0]


def _swinging(model: Model) -> dict[str, Effect]:
    """Effects that change the structure, and those whose values these ask for."""
    off_sensors = {name: one for name, one in model.effects.items() if not one.at_sensors()}
    swinging = {name: one.swinging() for name, one in off_sensors.items()}
    if any(one.overrides("change_values") for one in off_sensors.values()):
        return {name: swinging[name] or one for name, one in off_sensors.items()}
    return {name: one for name, one in swinging.items() if one is not None}


def _some(states: FloatArray) -> FloatArray:
    """All of few states, or some that are drawn from many, the same in every run."""
    if len(states) <= DRAWN:
        return states
    return states[np.random.default_rng(0).choice(len(states), DRAWN, replace=False)]


def _weigh_alike(one: Structure, other: Structure) -> bool:
    # Read by name they would be copied.
    here, there = (list(dict.values(by_name(each.masses))) for each in (one, other))
    return all(map(np.array_equal, here, there))


def computed_modes(
    structure: Structure, count: int
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """The lowest modes of a structure, or all where there are fewer.

    Returns:
        Frequencies [Hz], float[modes]; shapes for a modal mass of 1 kg, float[modes, nodes, 6];
        roots of their effective masses along the axes, float[modes, 3]; the mass that moves, [kg],
        float[3].

    Raises:
        InputError: nothing has a mass, or a property that the core refuses.
        UnstableStructureError: the structure can move; names node and direction.
    """
    try:
        squares, *rest = _core.modes(structure.arrays, structure.masses, count)
    except (_core.UnstableStructure, _core.InvalidInput) as error:
        raise refused(structure, error) from None
    shapes, participation, mass = rest
    return np.sqrt(squares) / (2 * np.pi), shapes, participation, mass
