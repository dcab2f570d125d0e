"""A structure of a simulation under its loads, and what structures near it make of them."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Self

import numpy as np

from rga._core import Loaded, StiffnessDifference
from rga.arrays import FloatArray, LoadArrays
from rga.model.effect import Effect, Values
from rga.model.structure import Load, Structure
from rga.simulation.dispatch import coefficients
from rga.simulation.paths.friction import frictionless, slid
from rga.simulation.paths.response import patterns, respond, respond_to
from rga.simulation.paths.unilateral import respond_with_laws, terms_of
from rga.simulation.perturbation.reanalysis import Reanalysis


@dataclass(frozen=True)
class Centre:
    """One of the structures of a simulation.

    Attributes:
        near: that structure and those near it.
        own: loads of every effect on it, before any other effect changes them.
        loads: all of them, changed.
        loaded: the structure under `loads`.
        coefficients: of `loads`, float[rows, patterns].
        of_geometry: its loads follow from the geometry and alpha alone.
        frictionless: the structure under `loads` and under unit forces at bearings, once known, by
            their nodes and directions.
    """

    near: Reanalysis
    own: dict[str, list[Load]]
    loads: list[Load]
    loaded: Loaded
    coefficients: FloatArray
    of_geometry: bool
    frictionless: dict[tuple[tuple[int, int], ...], FloatArray] = field(default_factory=dict)

    @classmethod
    def of(
        cls, structure: Structure, effects: Mapping[str, Effect], values: dict[str, Values]
    ) -> Self | None:
        """That of a structure under the loads of effects; None where there is no load."""
        own = {name: one.loads(structure, values[name], values) for name, one in effects.items()}
        loads = _changed(effects, own, structure, values)
        if not loads:
            return None
        near = Reanalysis(structure)
        of_geometry = all(one.loads_by_geometry or not loading(one) for one in effects.values())
        return cls(near, own, loads, near.under(loads), coefficients(loads), of_geometry)

    def loads_on(
        self,
        structure: Structure,
        effects: Mapping[str, Effect],
        values: dict[str, Values],
        apart: bool,
    ) -> list[Load]:
        """Loads of all effects on a structure; those that are what they are here are known.

        Args:
            structure: with all effects.
            effects: those of the simulation, then others.
            values: of their parameters.
            apart: effects of the simulation have the values that they had here.
        """
        first = self.near.structure
        warms = (
            first.same_geometry(structure)
            and np.array_equal(first.alpha, structure.alpha)
            and np.array_equal(first.host, structure.host)
        )
        more = list(effects.values())[len(self.own) :]
        if apart and warms and self.of_geometry and not any(map(loading, more)):
            return self.loads
        known = self._known(effects, structure, warms) if apart else {}
        own = {
            name: known[name] if name in known else effect.loads(structure, values[name], values)
            for name, effect in effects.items()
        }
        return _changed(effects, own, structure, values)

    @cached_property
    def _places(self) -> dict[tuple[int, ...], int]:
        """Of the loads, by the identity of their patterns."""
        return {_identity(load): number for number, load in enumerate(self.loads)}

    def under(self, loads: list[Load]) -> tuple[FloatArray, Loaded]:
        """Coefficients of loads, and this structure under them; it knows most of them."""
        if loads is self.loads:
            return self.coefficients, self.loaded
        places = [self._places.get(_identity(load)) for load in loads]
        if places == list(range(len(self.loads))):
            return coefficients(loads), self.loaded
        new = [load for load, known in zip(loads, places, strict=True) if known is None]
        more = self.near.under(new) if new else None
        numbers = iter(range(len(self.loads), len(self.loads) + len(new)))
        chosen = [next(numbers) if known is None else known for known in places]
        return coefficients(loads), self.loaded.choose(more, chosen)

    def solved_anew(self, structure: Structure, loads: list[Load]) -> FloatArray:
        """A structure that is not near this one, float[rows, sensors] in SI units.

        Args:
            structure: itself.
            loads: on it, as `loads_on` has them.
        """
        if loads is not self.loads:
            few = _together(loads)
            return coefficients(few) @ respond(structure, few, structure.outputs)
        q, few_patterns = self._few_loads
        return q @ respond_to(structure, few_patterns, structure.outputs)

    @cached_property
    def _few_loads(self) -> tuple[FloatArray, LoadArrays]:
        """Coefficients and patterns of the loads, those that go together as one."""
        few = _together(self.loads)
        return coefficients(few), patterns(self.near.structure, few)

    def with_laws(
        self, structure: Structure, loads: list[Load], where: StiffnessDifference | None
    ) -> FloatArray | None:
        """A structure that differs by play or slack alone, float[rows, sensors] in SI units.

        None for any other.
        """
        if where is None or where:
            return None
        q, loaded = self.under(loads)
        linear = self.near.onto(loaded, *terms_of(structure))
        return None if linear is None else respond_with_laws(structure, linear, q)

    def with_friction(
        self, structure: Structure, effects: Mapping[str, Effect], values: dict[str, Values]
    ) -> FloatArray | None:
        """A structure that differs by friction in its bearings alone, float[rows, sensors] in SI.

        None for any other.

        Args:
            structure: itself.
            effects: as for `loads_on`; those of the simulation have the values that they had here.
            values: of their parameters.
        """
        where = self.near.differing(structure)
        if where is None or where or not structure.linear_but_friction:
            return None
        if self.loads_on(structure, effects, values, apart=True) is not self.loads:
            return None
        places = tuple((bearing.node, bearing.dof) for bearing in structure.bearings)
        if places not in self.frictionless:
            self.frictionless[places] = frictionless(structure, self.loads)
        return slid(structure, self.coefficients, self.frictionless[places])[0]

    def _known(
        self, effects: Mapping[str, Effect], structure: Structure, warms: bool
    ) -> dict[str, list[Load]]:
        """Loads that are on a structure what they are on this, by effect.

        Args:
            effects: of the structure.
            structure: itself.
            warms: its members are those of this one, and grow as much when it is warm.
        """
        first = self.near.structure
        points = first.arrays["coordinates"]
        if not np.array_equal(points, structure.arrays["coordinates"][: len(points)]):
            return {}
        return {
            name: loads
            for name, loads in self.own.items()
            if effects[name].loads_by_geometry
            and (warms or all(load.strain is None for load in loads))
        }


def _identity(load: Load) -> tuple[int, ...]:
    """That of the pattern of a load: what lives has a number of its own."""
    return tuple(map(id, load.pattern))


def loading(effect: Effect) -> bool:
    """True where an effect may have loads, or change others'."""
    return effect.overrides("loads") or effect.overrides("change_loads")


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
