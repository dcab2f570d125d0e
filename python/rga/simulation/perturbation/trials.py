"""A simulation at given contexts, and what more effects make of it: many trials about one point."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rga._core import StiffnessDifference
from rga.arrays import FloatArray, IntArray
from rga.model.effect import Effect, Values
from rga.model.structure import Structure
from rga.simulation.dispatch import APART, Request, coefficients, with_laws
from rga.simulation.paths.response import respond
from rga.simulation.perturbation.centre import Centre
from rga.simulation.perturbation.chebyshev import along_line

if TYPE_CHECKING:
    from rga.simulation.simulator import Response, Simulator


class Vicinity:
    """A simulation at given contexts, to which effects are added in turn.

    What an effect leaves alone is not worked out again: parameters of the other effects, their
    loads, and the structure where only some of its stiffnesses differ (`Reanalysis`).

    Args:
        simulator: of a model.
        contexts: as for `Simulator.predict`.

    Attributes:
        response: of the simulation without more effects.
        read: what its sensors show, float[rows, sensors].
    """

    def __init__(self, simulator: "Simulator", contexts: Mapping[str, ArrayLike]) -> None:
        self.simulator = simulator
        self.contexts = contexts
        self.response = simulator.respond(contexts)
        effects = simulator.model.effects.values()
        self._true = dict(self.response.contexts)
        for effect in effects:
            if effect.overrides("change_contexts"):
                own = effect.values(self.response.contexts, self._rows)
                effect.change_contexts(self._true, own)
        self._settled = not any(effect.overrides("change_values") for effect in effects)
        self._centres: list[Centre] = []
        self._of_row = np.zeros(self._rows, np.int64)
        self._find_centres()
        self._shown = simulator.shown(self.response)
        self.read = simulator.read(self.response)

    @property
    def _rows(self) -> int:
        return len(self.response.contexts["time"])

    def _find_centres(self) -> None:
        values = self.response.values
        request = self.simulator.assembly.request(values, self._rows)
        if len(request.states) > APART:
            return
        structures = [request.change(state) for state in request.states]
        if not all(structure.linear for structure in structures):
            return
        self._of_row = request.state_of_row
        for structure in structures:
            centre = Centre.of(structure, self.simulator.model.effects, values)
            if centre is None:
                self._centres.clear()
                return
            self._centres.append(centre)
        parts = [one.coefficients @ one.loaded.outputs for one in self._centres]
        self.response = replace(self.response, quantities=self._joined(parts, self._of_row))

    def shown_with(self, effect: Effect) -> tuple[IntArray, FloatArray]:
        """What the sensors that an effect on sensors names show with it; all where it names none.

        Returns:
            Their columns, int[c], and float[rows, c].
        """
        named = sorted({self._shown.columns[name] for name in effect.sensors_named()})
        columns = np.array(named or range(self.read.shape[1]), dtype=np.int64)
        names = list(self._shown.columns)
        readings = replace(
            self._shown,
            values=self._shown.values[:, columns],
            columns={names[column]: place for place, column in enumerate(columns)},
        )
        effect.change_readings(readings, effect.values(self.response.contexts, self._rows))
        return columns, self.simulator.zeroed(readings)

    def trial(self, effects: Mapping[str, Effect]) -> tuple["Simulator", "Response"]:
        """The simulation with more effects, and its response as `Simulator.respond` gives it.

        Args:
            effects: by names that are new to the model.

        Raises:
            InputError, UnstableStructureError: as `Simulator.respond`.
        """
        trial = self.simulator.extended(effects)
        near = self._near(effects)
        return trial, trial.respond(self.contexts) if near is None else near

    def nearly(self, effects: Mapping[str, Effect]) -> tuple[FloatArray, bool]:
        """What the sensors show with more effects, at little cost.

        Where a trial would solve structures anew, the effects are put on the simulation without
        what makes it dear, each by itself and as if it always acted. What they change there is
        added: all but the interplay of effects.

        Args:
            effects: as for `trial`, with the same errors.

        Returns:
            float[rows, sensors], and whether they are those of the trial.
        """
        if not effects:
            return self.read, True
        self.simulator.model.check_effects(effects)
        near = self._near(effects)
        if near is None and not self._calm._centres:
            near = self.simulator.extended(effects).respond(self.contexts)
        if near is not None:
            return self.simulator.read(near, effects), True
        read = self.read.copy()
        time = self.response.contexts["time"]
        for name, effect in effects.items():
            if effect.on_sensors:
                columns, shown = self.shown_with(effect)
                read[:, columns] += shown - self.read[:, columns]
                continue
            always = effect.model_copy(update={"onset": None, "profile": "step", "end": None})
            tried, response = self._calm.trial({name: always})
            read += effect.weight(time)[:, None] * (tried.read(response) - self._calm.read)
        return read, False

    @cached_property
    def _calm(self) -> "Vicinity":
        """The simulation without what gives every row a structure of its own, or corners."""
        if self._centres:
            return self
        calm = self.simulator.calm(self.response.values)
        return self if calm is self.simulator else Vicinity(calm, self.contexts)

    def _near(self, effects: Mapping[str, Effect]) -> "Response | None":
        """The response with more effects out of what is known; None where it takes other solves."""
        if not self._centres:
            return None
        if all(effect.on_sensors for effect in effects.values()):
            return self.response
        apart = self._settled and not any(map(_meddles, effects.values()))
        if not apart:
            return self._elsewhere(effects, None)
        more = {name: one.values(self._true, self._rows) for name, one in effects.items()}
        values = {**self.response.values, **more}
        states = {name: _state(more[name]) for name, one in effects.items() if one.structural}
        if None in states.values():
            return self._elsewhere(effects, values)
        parts = []
        for centre in self._centres:
            structure = centre.near.structure
            if states:
                structure = structure.copy()
            for name, state in states.items():
                effects[name].change_structure(structure, state or {})
            all_effects = {**self.simulator.model.effects, **effects}
            if not structure.bearings:
                part = self._quantities(structure, all_effects, values)
            elif len(self._centres) == 1:
                part = centre.with_friction(structure, all_effects, values)
            else:
                # Friction remembers, and these rows have structures of their own.
                part = None
            if part is None:
                return None
            parts.append(part)
        quantities = self._joined(parts, self._of_row)
        return replace(self.response, values=values, quantities=quantities)

    def _elsewhere(
        self, effects: Mapping[str, Effect], known: dict[str, Values] | None
    ) -> "Response | None":
        """The same where effects reach others' parameters or the structure of single rows.

        Args:
            effects: as for `trial`.
            known: parameters of all effects; None where those of others may have changed too.
        """
        trial = self.simulator.extended(effects)
        values = trial.resolve(self.response.contexts) if known is None else known
        request = trial.assembly.request(values, self._rows)
        apart = known is not None or self._has(values)
        if len(request.states) > APART:
            quantities = self._along_line(trial, request, values, apart)
            if quantities is None:
                return None
            return replace(self.response, values=values, quantities=quantities)
        parts = []
        for state in request.states:
            part = self._quantities(request.change(state), trial.model.effects, values, apart)
            if part is None:
                return None
            parts.append(part)
        quantities = self._joined(parts, request.state_of_row)
        return replace(self.response, values=values, quantities=quantities)

    def stiffness_rates(self) -> dict[int, FloatArray]:
        """Derivatives by the logarithm of EA of members, by their numbers.

        Those of truss members, and of frame members with springs at their ends; about the
        simulation without what is not linear, or varies from row to row.

        Returns:
            float[rows, sensors] of each member, in the sensors' units.
        """
        parts = []
        calm = self._calm
        for centre in calm._centres:
            q = centre.coefficients
            parts.append({m: q @ rate for m, rate in centre.near.rates(centre.loaded).items()})
        members = set(parts[0]).intersection(*parts[1:]) if parts else set()
        return {
            member: calm._joined([part[member] for part in parts], calm._of_row)
            for member in sorted(members)
        }

    def _joined(self, parts: list[FloatArray], of_row: IntArray) -> FloatArray:
        """Rows taken from the part of their state, in the sensors' units."""
        per_si = self._centres[0].near.structure.per_si
        if len(parts) == 1:
            return np.asarray(parts[0] * per_si)
        return np.asarray(np.stack(parts)[of_row, np.arange(len(of_row))] * per_si)

    def _quantities(
        self,
        structure: Structure,
        effects: Mapping[str, Effect],
        values: dict[str, Values],
        apart: bool = True,
    ) -> FloatArray | None:
        """What the sensors are to read of a structure under all rows, in SI units.

        None where the structure has bearings or large displacements.

        Args:
            structure: with all effects.
            effects: all of them.
            values: of their parameters.
            apart: those of the simulation have the values that they had there.
        """
        if structure.bearings or structure.nonlinear:
            return None
        centre, where = self._nearest(structure)
        loads = centre.loads_on(structure, effects, values, apart)
        if structure.laws:
            near = centre.with_laws(structure, loads, where)
            if near is not None:
                return near
            return with_laws(self.simulator.assembly.prepared, structure, loads)
        if where is None:
            return centre.solved_anew(structure, loads)
        q, loaded = centre.under(loads)
        return q @ centre.near.changed(loaded, structure, where)

    def _has(self, values: dict[str, Values]) -> bool:
        """Whether these are the parameters of the simulation's own effects."""
        return all(
            own.keys() == values[name].keys()
            and all(np.array_equal(column, values[name][key]) for key, column in own.items())
            for name, own in self.response.values.items()
        )

    def _along_line(
        self, trial: "Simulator", request: Request, values: dict[str, Values], apart: bool
    ) -> FloatArray | None:
        """The same of rows whose structures lie on a line, in the sensors' units."""

        def solve(structure: Structure) -> tuple[FloatArray, FloatArray]:
            centre, where = self._nearest(structure)
            loads = centre.loads_on(structure, trial.model.effects, values, apart)
            if where is None:
                return coefficients(loads), respond(structure, loads, structure.outputs)
            q, loaded = centre.under(loads)
            return q, centre.near.changed(loaded, structure, where)

        quantities = along_line(request, solve)
        return None if quantities is None else quantities * self._centres[0].near.structure.per_si

    def _nearest(self, structure: Structure) -> tuple[Centre, StiffnessDifference | None]:
        """The centre that a structure is near, or any; and where they differ."""
        for centre in self._centres:
            where = centre.near.differing(structure)
            if where is not None:
                return centre, where
        return self._centres[0], None


def _state(values: Values) -> dict[str, float] | None:
    """Parameters that are the same in every row; None where one varies."""
    if any((column != column[0]).any() for column in values.values()):
        return None
    return {name: float(column[0]) for name, column in values.items()}


def _meddles(effect: Effect) -> bool:
    """True where an effect may change contexts, or parameters of other effects."""
    return effect.overrides("change_contexts") or effect.overrides("change_values")
