"""The structures that parameters of effects make of a model, row by row."""

from collections.abc import Callable
from contextlib import suppress
from functools import cache, cached_property

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.errors import InputError
from rga.model.effect import Values
from rga.model.schema import Model
from rga.model.structure import Load, Structure
from rga.simulation.dispatch import CondensedPaths, Request, variation_between
from rga.simulation.paths.friction_past import FrictionPast
from rga.simulation.paths.variation import Variation, VariationWithin

#: half widths of their ranges within which contexts are looked for, and a little more
BEYOND = 3.1


class Assembly:
    """Puts effects on a structure.

    Args:
        model: the structure with its effects.
        structure: before any of them.
        resolve: parameters of all effects, by contexts and time.

    Attributes:
        prepared: what was condensed for earlier contexts.
    """

    def __init__(
        self,
        model: Model,
        structure: Structure,
        resolve: Callable[[Values], dict[str, Values]],
    ) -> None:
        self._model, self._structure, self._resolve = model, structure, resolve
        self.prepared: list[CondensedPaths] = []

    def keys(self, values: dict[str, Values]) -> list[tuple[str, str]]:
        """Effect and parameter of all that changes the structure, as `resolve` gives them."""
        effects = self._model.effects.items()
        return [
            (name, key) for name, effect in effects if effect.structural for key in values[name]
        ]

    def parameters(self, values: dict[str, Values]) -> FloatArray:
        """Parameters that change the structure, float[rows, parameters]."""
        columns = [values[name][key] for name, key in self.keys(values)]
        if not columns:
            rows = next((len(one) for own in values.values() for one in own.values()), 0)
            return np.zeros((rows, 0))
        return np.column_stack(columns)

    def request(
        self, values: dict[str, Values], rows: int, friction: FrictionPast | None = None
    ) -> Request:
        """What parameters of all effects ask of the structure.

        Args:
            values: of the parameters, as `resolve` gives them.
            rows: how many there are.
            friction: where bearings stand after the rows before; None: there were none.
        """
        effects = self._model.effects
        structural = [name for name, effect in effects.items() if effect.structural]
        named = self.keys(values)
        states, state_of_row = np.zeros((1, 0)), np.zeros(rows, dtype=np.int64)
        if named:
            table = self.parameters(values)
            moving = (table != table[:1]).any(axis=0)
            if rows and not moving.any():
                states = table[:1]
            else:
                _, first, state_of_row = np.unique(
                    table[:, moving], axis=0, return_index=True, return_inverse=True
                )
                states = table[first]

        columns: dict[str, dict[str, int]] = {name: {} for name in structural}
        for column, (name, key) in enumerate(named):
            columns[name][key] = column

        def changed(structure: Structure, names: list[str], state: FloatArray) -> Structure:
            for name in names:
                own = {key: state[column] for key, column in columns[name].items()}
                effects[name].change_structure(structure, own)
            return structure

        # What comes before all that varies is put on the structure once.
        parts = [states[:, list(columns[name].values())] for name in structural]
        # Not by a difference: a stiffness may be infinite in every row.
        varies = [bool(part.max() > part.min()) for part in parts]
        steady = varies.index(True) if True in varies else len(structural)
        given = [k for name in structural[:steady] for k in columns[name].values()]

        @cache
        def begun() -> Structure:
            return changed(self._structure.copy(), structural[:steady], states[0])

        def change(state: FloatArray) -> Structure:
            if not structural:
                return self._structure
            if np.array_equal(state[given], states[0, given]):
                return changed(begun().copy(), structural[steady:], state)
            return changed(self._structure.copy(), structural, state)

        def loads(structure: Structure, chosen: IntArray) -> list[Load]:
            of_rows = {
                name: {key: column[chosen] for key, column in resolved.items()}
                for name, resolved in values.items()
            }
            return self.loads(structure, of_rows)

        fixed = all(
            effect.loads_by_geometry
            or not (effect.overrides("loads") or effect.overrides("change_loads"))
            for effect in effects.values()
        )
        return Request(
            states,
            state_of_row.ravel(),
            change,
            loads,
            fixed,
            self.prepared,
            lambda: self._over_ranges,
            friction or FrictionPast(),
        )

    @cached_property
    def _over_ranges(self) -> VariationWithin | None:
        effects = self._model.effects.values()
        structural = [effect for effect in effects if effect.structural]
        driving = set().union(*(effect.drivers() for effect in structural))
        moving = any(one.onset is not None or one.remembers for one in structural)
        others = any(
            one.overrides("change_contexts") or one.overrides("change_values") for one in effects
        )
        if not driving or moving or others:
            return None

        def wide() -> VariationWithin | None:
            # A kind of one's own need not know what it is so far out.
            with suppress(Exception), np.errstate(all="ignore"):
                return self._varied_within(driving, (1.0, BEYOND))
            return None

        return self._varied_within(driving, (1.0,), wide)

    def _varied_within(
        self,
        driving: set[str],
        reaches: tuple[float, ...],
        beyond: Callable[[], VariationWithin | None] = lambda: None,
    ) -> VariationWithin:
        """What varies where contexts reach so many half widths of their ranges.

        Args:
            driving: contexts that drive the structure.
            reaches: the farthest of them last.
            beyond: finds what varies within wider limits.
        """
        ranges = {name: one.range for name, one in self._model.context.items()}
        middle = {name: (low + high) / 2 for name, (low, high) in ranges.items()}
        ends = [
            {name: middle[name] + reach * (end - middle[name])}
            for reach in reaches
            for name in ranges
            if name in driving
            for end in ranges[name]
        ]
        rows: list[dict[str, float]] = [{}, *ends]
        table = {name: np.array([row.get(name, middle[name]) for row in rows]) for name in ranges}
        values = self._resolve({**table, "time": np.zeros(len(rows))})
        parameters = self.parameters(values)
        corners = []
        for count in range(1, len(reaches) + 1):
            within = parameters[: 1 + len(ends) * count // len(reaches)]
            corners += [within.min(axis=0), within.max(axis=0)]

        def varied() -> Variation | None:
            request = self.request(values, len(rows))
            # At the end of a range there may be no structure.
            missing = Exception if len(reaches) > 1 else InputError
            with suppress(missing), np.errstate(all="ignore"):
                if request.change(parameters[0]).linear:
                    return variation_between(request, np.vstack([parameters[0], *corners]))
            return None

        return VariationWithin(corners[-2], corners[-1], varied, beyond)

    def loads(self, structure: Structure, values: dict[str, Values]) -> list[Load]:
        """Load patterns on a structure, with a coefficient a row.

        Args:
            structure: as the effects have made it.
            values: of all parameters, as `resolve` gives them.
        """
        effects = self._model.effects
        loads = {
            name: effect.loads(structure, values[name], values) for name, effect in effects.items()
        }
        for name, effect in effects.items():
            effect.change_loads(loads, structure, values[name])
        return [load for of_effect in loads.values() for load in of_effect]
