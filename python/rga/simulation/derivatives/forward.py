"""Derivatives of the sensors by the contexts.

Coefficients of loads and stiffnesses are straight in the contexts but for kinks, so that their
central differences have no truncation error (1e-7 of them where a context is a logarithm); the
response to them is differentiated exactly, along the contexts (`jacobian`) or backwards from the
sensors (`pull_back`). Where whole structures vary, where friction remembers, or where displacements
are large, the response itself is differenced.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rga import _core
from rga._core import Condensation, DependentTerms
from rga.arrays import FloatArray
from rga.model.effect import Values
from rga.simulation.dispatch import coefficients, linear_paths, variation_under
from rga.simulation.paths.factorisation import Factorisation
from rga.simulation.paths.variation import unvaried

if TYPE_CHECKING:
    from rga.simulation.simulator import Simulator

#: step of differences, as a share of the range of a context, and its least: nearer to an end of
#: the range than that, the difference is taken to the other side alone
STEP, LEAST = 1e-4, 1e-6
#: what a linear path cannot do, or names no row and place of
LEFT_TO_OTHERS = (
    _core.UnstableSample,
    DependentTerms,
    _core.UnstableStructure,
    _core.InvalidInput,
)


@dataclass(frozen=True)
class Sides:
    """A little ahead of the rows and a little behind, along some contexts.

    Attributes:
        columns: which contexts, among all of the model.
        ahead, behind: how far, in their units, float[rows, contexts].
        tables: contexts of all rows, ahead and behind in turn.
        values: parameters of all effects in all these tables, one behind the other.
    """

    columns: list[int]
    ahead: FloatArray
    behind: FloatArray
    tables: list[Values]
    values: dict[str, Values]

    def of(self, number: int, rows: int) -> dict[str, Values]:
        """Parameters in one of the tables."""
        own = slice(number * rows, (number + 1) * rows)
        return {
            name: {key: column[own] for key, column in values.items()}
            for name, values in self.values.items()
        }


@dataclass(frozen=True)
class Tangent:
    """A linear path at the rows, and how fast what it depends on follows the contexts.

    Attributes:
        system: the path.
        coefficients, stiffness: float[rows, patterns] and float[rows, elements].
        coefficient_rates, stiffness_rates: their derivatives by the contexts, float[rows, patterns,
            contexts] and float[rows, elements, contexts].
        per_si: units of the sensors, float[sensors].
    """

    system: Condensation | Factorisation
    coefficients: FloatArray
    stiffness: FloatArray
    coefficient_rates: FloatArray
    stiffness_rates: FloatArray
    per_si: FloatArray


def jacobian(simulator: "Simulator", table: Values) -> FloatArray:
    """Derivatives, float[rows, sensors, contexts].

    Args:
        simulator: of a model.
        table: contexts and time, checked, float[rows] each.
    """
    model = simulator.model
    out = np.zeros((len(table["time"]), len(model.sensors), len(model.context)))
    if not (contexts := _followed(simulator)):
        return out
    values = simulator.resolve(table)
    columns = _columns(simulator, contexts)
    rates = None
    for tangent in _tangents(simulator, table, values, contexts):
        try:
            found = tangent.system.differentiate(
                tangent.coefficients,
                tangent.stiffness,
                tangent.coefficient_rates,
                tangent.stiffness_rates,
            )
        except LEFT_TO_OTHERS:
            continue  # the next path decides
        rates = found * tangent.per_si[:, None]
        break
    if rates is not None and simulator.reads_plainly:
        out[:, :, columns] = rates
        return out
    response, sides, shown = (
        simulator.respond(table),
        _sides(simulator, table, values, contexts),
        [],
    )
    for number, one in enumerate(sides.tables):
        if rates is None:
            shown.append(simulator.predict(one))
            continue
        way = -sides.behind if number % 2 else sides.ahead
        along = rates[:, :, number // 2] * way[:, [number // 2]]
        moved = response.quantities + along
        own = sides.of(number, len(moved))
        shown.append(simulator.read(replace(response, contexts=one, values=own, quantities=moved)))
    ahead, behind = np.stack(shown[::2], 2), np.stack(shown[1::2], 2)
    out[:, :, columns] = (ahead - behind) / (sides.ahead + sides.behind)[:, None]
    return out


def pull_back(simulator: "Simulator", table: Values, gradients: FloatArray) -> FloatArray:
    """Derivatives of the sum of the sensors times gradients, float[rows, contexts].

    The adjoint: its cost does not grow with the number of contexts. Where sensors show more than
    the structure tells, and where there is no linear path, the Jacobian takes its place.

    Args:
        simulator, table: as for `jacobian`.
        gradients: float[rows, sensors].
    """
    model = simulator.model
    out = np.zeros((len(table["time"]), len(model.context)))
    if not (contexts := _followed(simulator)):
        return out
    if not simulator.reads_plainly:
        return _product(gradients, jacobian(simulator, table))
    for tangent in _tangents(simulator, table, simulator.resolve(table), contexts):
        try:
            found = tangent.system.pull_back(
                tangent.coefficients, tangent.stiffness, gradients * tangent.per_si
            )
        except LEFT_TO_OTHERS:
            continue  # the next path decides
        by_loads, by_stiffness = np.split(found, [tangent.coefficients.shape[1]], axis=1)
        along = _product(by_loads, tangent.coefficient_rates)
        along += _product(by_stiffness, tangent.stiffness_rates)
        out[:, _columns(simulator, contexts)] = along
        return out
    return _product(gradients, jacobian(simulator, table))


def _followed(simulator: "Simulator") -> list[str]:
    """Contexts that drive something."""
    return [name for name in simulator.model.context if name in simulator.driven]


def _columns(simulator: "Simulator", contexts: list[str]) -> list[int]:
    """Numbers of contexts among all of the model."""
    place = {name: number for number, name in enumerate(simulator.model.context)}
    return [place[name] for name in contexts]


def _of_structure_alone(simulator: "Simulator", contexts: list[str]) -> list[str]:
    """Those of the contexts that change the structure, and nothing else, of their row alone."""
    effects = simulator.model.effects
    others = set()
    for name, one in effects.items():
        if one.overrides("change_contexts") or one.overrides("change_values"):
            return []
        loading = one.overrides("loads") or one.overrides("change_loads")
        if loading or not one.structural or one.remembers or one.of_all_rows:
            others.add(name)
    return [name for name in contexts if others.isdisjoint(simulator.driven[name])]


def _sides(
    simulator: "Simulator", table: Values, own: dict[str, Values], contexts: list[str]
) -> Sides:
    model = simulator.model
    ahead, behind, tables = [], [], []
    for name in contexts:
        here = table[name]
        up, down = _steps(here, *model.context[name].range)
        ahead.append(up)
        behind.append(down)
        tables += [{**table, name: here + up}, {**table, name: here - down}]
    if any(effect.remembers for effect in model.effects.values()):
        apart = [simulator.resolve(one) for one in tables]
        values = {
            name: {key: np.concatenate([one[name][key] for one in apart]) for key in keys}
            for name, keys in own.items()
        }
    else:
        values = simulator.resolve(
            {name: np.concatenate([one[name] for one in tables]) for name in table}
        )
        for name, effect in model.effects.items():
            for key in effect.of_all_rows:
                values[name][key] = np.tile(own[name][key], len(tables))
    columns = _columns(simulator, contexts)
    return Sides(columns, np.stack(ahead, 1), np.stack(behind, 1), tables, values)


def _steps(value: FloatArray, low: float, high: float) -> tuple[FloatArray, FloatArray]:
    """How far to go ahead and behind inside the range: at its end there may be no stiffness."""
    width = high - low
    room = np.minimum(value - low, high - value) / 2
    inside = (room >= 0) & (room < LEAST * width)
    middle = np.where(room < 0, STEP * width, np.minimum(STEP * width, room))
    at_low = inside & (value - low < high - value)
    ahead = np.where(inside, np.where(at_low, LEAST * width, 0.0), middle)
    behind = np.where(inside, np.where(at_low, 0.0, LEAST * width), middle)
    return ahead, behind


def _tangents(
    simulator: "Simulator", table: Values, values: dict[str, Values], contexts: list[str]
) -> Iterator[Tangent]:
    """Linear paths at the rows, the cheapest first; none where there is no tangent."""
    rows = len(table["time"])
    middle = simulator.assembly.request(values, rows)
    alone = _of_structure_alone(simulator, contexts)
    along, low, high = _structure_along(simulator, table, values, contexts, alone)
    of_loads = [number for number, name in enumerate(contexts) if name not in alone]
    if of_loads:
        sides = _sides(simulator, table, values, [contexts[number] for number in of_loads])
        moved = simulator.assembly.parameters(sides.values)
        along[:, :, of_loads] = _rates(moved, sides)
        low, high = np.minimum(low, moved.min(axis=0)), np.maximum(high, moved.max(axis=0))
    states = np.vstack([middle.states, low, high])
    start = middle.change(middle.states[0])
    if start.bearings or start.laws or start.nonlinear:
        return
    varied = unvaried(start, states.shape[1])
    if (states != states[0]).any():
        found = variation_under(middle, states)
        if found is None:
            return
        varied, start = found, found.start
    loads = middle.loads(start, np.arange(rows))
    if not loads:
        return
    by_loads = np.zeros((rows, len(loads), len(contexts)))
    if of_loads:
        ends = coefficients(simulator.assembly.loads(start, sides.values))
        by_loads[:, :, of_loads] = _rates(ends, sides)
    for _, system in linear_paths(middle.prepared, varied, loads):
        yield Tangent(
            system,
            coefficients(loads),
            varied.at(middle.of_rows),
            by_loads,
            varied.rates(middle.of_rows, along),
            start.per_si,
        )


def _structure_along(
    simulator: "Simulator",
    table: Values,
    values: dict[str, Values],
    contexts: list[str],
    alone: list[str],
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """How structural parameters follow contexts that change the structure alone.

    Returns:
        Derivatives, float[rows, parameters, contexts], which of other contexts are zero, and
        smallest and largest of each parameter on both sides of the rows, float[parameters] each.
    """
    model = simulator.model
    rows, here = len(table["time"]), simulator.assembly.parameters(values)
    along = np.zeros((rows, here.shape[1], len(contexts)))
    low, high = here.min(axis=0), here.max(axis=0)
    columns = {one: number for number, one in enumerate(simulator.assembly.keys(values))}
    for name in alone:
        up, down = _steps(table[name], *model.context[name].range)
        tables = {**table, name: table[name] + up}, {**table, name: table[name] - down}
        for of in simulator.driven[name]:
            ahead, behind = (model.effects[of].values(one, rows) for one in tables)
            for key in ahead:
                column, ends = columns[of, key], np.stack([ahead[key], behind[key]])
                moved = _difference(ahead[key], behind[key])
                along[:, column, contexts.index(name)] = moved / (up + down)
                low[column] = min(low[column], ends.min())
                high[column] = max(high[column], ends.max())
    return along, low, high


def _product(gradients: FloatArray, derivatives: FloatArray) -> FloatArray:
    # A faulty sensor says nothing; its derivative must not spoil the others' sum.
    return np.asarray(np.einsum("ts,tsc->tc", gradients, np.nan_to_num(derivatives)))


def _rates(entries: FloatArray, sides: Sides) -> FloatArray:
    """Derivatives of what is known on all sides, float[rows, entries, contexts]."""
    rows, contexts = sides.ahead.shape
    apart = entries.reshape(contexts, 2, rows, entries.shape[1])
    far = (sides.ahead + sides.behind).T[:, :, None]
    moved = _difference(apart[:, 0], apart[:, 1])
    return np.asarray((moved / far).transpose(1, 2, 0))


def _difference(ahead: FloatArray, behind: FloatArray) -> FloatArray:
    """Ahead less behind; a stiffness may be infinite on both sides."""
    zero = np.zeros_like(ahead)
    return np.asarray(np.subtract(ahead, behind, out=zero, where=ahead != behind))
