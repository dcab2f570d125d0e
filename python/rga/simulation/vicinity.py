"""A simulation at given contexts, and what more effects make of it: many trials about one point."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rga.model.effect import Effect, Values
from rga.model.parameter import FloatArray
from rga.model.structure import IntArray, Load, Structure
from rga.simulation.laws import respond_with_laws, terms_of
from rga.simulation.plan import APART, coefficients
from rga.simulation.reanalysis import Difference, Loaded, Reanalysis
from rga.simulation.response import patterns, respond

if TYPE_CHECKING:
    from rga.simulation.simulator import Response, Simulator


@dataclass(frozen=True)
class Centre:
    """One of the structures of a simulation.

    Attributes:
        near: that structure and those near it.
        own: loads of every effect on it, before any other effect changes them.
        loads: all of them, changed.
        loaded: the structure under `loads`.
        coefficients: of `loads`, float[rows, patterns].
    """

    near: Reanalysis
    own: dict[str, list[Load]]
    loads: list[Load]
    loaded: Loaded
    coefficients: FloatArray


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
            effect.change_contexts(self._true, effect.values(self.response.contexts, self._rows))
        self._settled = not any(_overrides(effect, "change_values") for effect in effects)
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
        request = self.simulator.request(values, self._rows)
        if len(request.states) > APART:
            return
        structures = [request.change(state) for state in request.states]
        if any(one.bearings or one.laws or one.nonlinear for one in structures):
            return
        self._of_row = request.state_of_row
        effects = self.simulator.model.effects
        for structure in structures:
            own = {
                name: effect.loads(structure, values[name], values)
                for name, effect in effects.items()
            }
            loads = _changed(effects, own, structure, values)
            if not loads:
                self._centres.clear()
                return
            near = Reanalysis(structure)
            found = Centre(near, own, loads, near.under(loads), coefficients(loads))
            self._centres.append(found)
        parts = [one.coefficients @ one.loaded.outputs for one in self._centres]
        self.response = replace(self.response, quantities=self._joined(parts, self._of_row))

    def read_with(self, effect: Effect) -> FloatArray:
        """What the sensors show with an effect on them alone, float[rows, sensors]."""
        readings = replace(self._shown, values=self._shown.values.copy())
        effect.change_readings(readings, effect.values(self.response.contexts, self._rows))
        return self.simulator.zeroed(readings)

    def trial(self, effects: Mapping[str, Effect]) -> tuple["Simulator", "Response"]:
        """The simulation with more effects, and its response as `Simulator.respond` gives it.

        Args:
            effects: by names that are new to the model.

        Raises:
            InputError, UnstableStructureError: as `Simulator.respond`.
        """
        trial = self.simulator.extended(effects)
        return trial, self._respond(trial, effects)

    def _respond(self, trial: "Simulator", effects: Mapping[str, Effect]) -> "Response":
        if not self._centres:
            return trial.respond(self.contexts)
        if all(effect.on_sensors for effect in effects.values()):
            return self.response
        apart = self._settled and not any(map(_meddles, effects.values()))
        if apart:
            more = {name: one.values(self._true, self._rows) for name, one in effects.items()}
            values = {**self.response.values, **more}
        else:
            values = trial.resolve(self.response.contexts)
        request = trial.request(values, self._rows)
        if len(request.states) > APART:
            return trial.respond(self.contexts)
        parts = []
        for state in request.states:
            structure = request.change(state)
            if structure.bearings or structure.nonlinear:
                return trial.respond(self.contexts)
            part = self._quantities(trial, structure, values, apart)
            if part is None:
                return trial.respond(self.contexts)
            parts.append(part)
        quantities = self._joined(parts, request.state_of_row)
        return replace(self.response, values=values, quantities=quantities)

    def stiffness_rates(self) -> dict[int, FloatArray]:
        """Derivatives by the logarithm of EA of members, by their numbers.

        Those of truss members, and of frame members with springs at their ends.

        Returns:
            float[rows, sensors] of each member, in the sensors' units; none where the structure
            varies in too many ways.
        """
        parts = []
        for centre in self._centres:
            q = centre.coefficients
            parts.append({m: q @ rate for m, rate in centre.near.rates(centre.loaded).items()})
        members = set(parts[0]).intersection(*parts[1:]) if parts else set()
        return {
            member: self._joined([part[member] for part in parts], self._of_row)
            for member in sorted(members)
        }

    def _joined(self, parts: list[FloatArray], of_row: IntArray) -> FloatArray:
        """Rows taken from the part of their state, in the sensors' units."""
        per_si = self._centres[0].near.structure.per_si
        if len(parts) == 1:
            return np.asarray(parts[0] * per_si)
        return np.asarray(np.stack(parts)[of_row, np.arange(len(of_row))] * per_si)

    def _quantities(
        self, trial: "Simulator", structure: Structure, values: dict[str, Values], apart: bool
    ) -> FloatArray | None:
        """What the sensors are to read of a structure under all rows, in SI units.

        None where the structure has play or slack and is not near another.
        """
        effects = trial.model.effects
        where, centre = None, self._centres[0]
        for one in self._centres:
            where = one.near.differing(structure)
            if where is not None:
                centre = one
                break
        known = _known(centre, effects, structure, where is not None) if apart else {}
        own = {
            name: known[name] if name in known else effect.loads(structure, values[name], values)
            for name, effect in effects.items()
        }
        loads = _changed(effects, own, structure, values)
        if structure.laws:
            return None if where is None else _with_laws(centre, structure, loads, where)
        if where is None:
            few = _together(loads)
            return coefficients(few) @ respond(structure, few, structure.outputs)
        q, loaded = _under(centre, loads)
        return q @ centre.near.changed(loaded, structure, where)


def _with_laws(
    centre: Centre, structure: Structure, loads: list[Load], where: Difference
) -> FloatArray | None:
    """A structure that differs from a centre by play or slack alone; None for any other."""
    if len(where.terms) or len(where.frames):
        return None
    q, loaded = _under(centre, loads)
    linear = centre.near.onto(loaded, *terms_of(structure))
    return None if linear is None else respond_with_laws(structure, linear, q)


def _known(
    centre: Centre, effects: Mapping[str, Effect], structure: Structure, near: bool
) -> dict[str, list[Load]]:
    """Loads that are on a structure what they are on a centre, by effect."""
    first = centre.near.structure
    points = first.arrays["coordinates"]
    if not np.array_equal(points, structure.arrays["coordinates"][: len(points)]):
        return {}
    warms = near and np.array_equal(first.alpha, structure.alpha)
    return {
        name: loads
        for name, loads in centre.own.items()
        if effects[name].loads_by_geometry and (warms or all(load.strain is None for load in loads))
    }


def _under(centre: Centre, loads: list[Load]) -> tuple[FloatArray, Loaded]:
    """Coefficients of loads, and the centre under them; it knows most of them."""
    place = {id(load): number for number, load in enumerate(centre.loads)}
    new = [load for load in loads if id(load) not in place]
    if not new and len(loads) == len(place):
        return centre.coefficients, centre.loaded
    place |= {id(load): len(centre.loads) + number for number, load in enumerate(new)}
    parts = [centre.loaded, *([centre.near.under(new)] if new else [])]
    order = [place[id(load)] for load in loads]
    outputs, elongations, displacements = (
        np.concatenate([getattr(part, name) for part in parts])[order]
        for name in ("outputs", "elongations", "displacements")
    )
    pattern = patterns(centre.near.structure, loads)
    return coefficients(loads), Loaded(outputs, elongations, displacements, pattern)


def _changed(
    effects: Mapping[str, Effect],
    own: Mapping[str, list[Load]],
    structure: Structure,
    values: dict[str, Values],
) -> list[Load]:
    """Loads of all effects, as other effects change them."""
    loads = dict(own)
    for name, effect in effects.items():
        effect.change_loads(loads, structure, values[name])
    return [load for of_effect in loads.values() for load in of_effect]


def _meddles(effect: Effect) -> bool:
    """True where an effect may change contexts, or parameters of other effects."""
    return _overrides(effect, "change_contexts") or _overrides(effect, "change_values")


def _together(loads: list[Load]) -> list[Load]:
    """The same loads, with nodal forces that have the same coefficients put into one."""
    found: list[Load] = []
    place: dict[bytes, int] = {}
    for load in loads:
        if load.strain is not None or load.prescribed or load.spread:
            found.append(load)
            continue
        key = load.coefficient.tobytes()
        if key not in place:
            place[key] = len(found)
            found.append(replace(load, forces=dict(load.forces)))
            continue
        forces = found[place[key]].forces
        for node, force in load.forces.items():
            forces[node] = forces[node] + force if node in forces else force
    return found


def _overrides(effect: Effect, method: str) -> bool:
    return getattr(type(effect), method) is not getattr(Effect, method)
