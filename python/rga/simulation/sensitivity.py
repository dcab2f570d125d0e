"""Derivatives of the sensors by the contexts.

Coefficients of loads and stiffnesses are straight in the contexts but for kinks, so that their
central differences have no truncation error; the response to them is differentiated exactly, along
the contexts (`jacobian`) or backwards from the sensors (`pull_back`). Where whole structures vary,
where friction remembers, or where displacements are large, the response itself is differenced.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from rga import _core
from rga.model.effect import Values
from rga.model.parameter import FloatArray
from rga.simulation.condensation import Condensation, DependentTerms
from rga.simulation.factorisation import Factorisation
from rga.simulation.plan import coefficients, linear_paths
from rga.simulation.variation import unvaried, variation

if TYPE_CHECKING:
    from rga.simulation.simulator import Response, Simulator

#: step of differences, as a share of the range of a context
STEP = 1e-4
SIGNS = (1.0, -1.0)


@dataclass(frozen=True)
class Sides:
    """A little ahead of the rows and a little behind, along each context that drives something.

    Attributes:
        columns: which contexts, among all of the model.
        steps: how far, in their units.
        tables, values: contexts and parameters of all effects, ahead and behind in turn.
    """

    columns: list[int]
    steps: FloatArray
    tables: list[Values]
    values: list[dict[str, Values]]


@dataclass(frozen=True)
class Tangent:
    """A linear path at the rows, and how fast what it depends on follows the contexts.

    Attributes:
        system: the path.
        coefficients, stiffness: float[rows, patterns] and float[rows, elements].
        coefficient_rates, stiffness_rates: their derivatives times the steps, float[rows, patterns,
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
    sides = _sides(simulator, table)
    if not sides.columns:
        return out
    response = simulator.respond(table)
    rates = None
    for tangent in _tangents(simulator, response, sides):
        try:
            found = tangent.system.differentiate(
                tangent.coefficients,
                tangent.stiffness,
                tangent.coefficient_rates,
                tangent.stiffness_rates,
            )
        except (_core.UnstableSample, DependentTerms):
            continue  # the next path decides
        rates = found * tangent.per_si[:, None]
        break
    shown = []
    for number, (one, of_one) in enumerate(zip(sides.tables, sides.values, strict=True)):
        if rates is None:
            shown.append(simulator.predict(one))
            continue
        moved = response.quantities + SIGNS[number % 2] * rates[:, :, number // 2]
        shown.append(
            simulator.read(replace(response, contexts=one, values=of_one, quantities=moved))
        )
    ahead, behind = np.stack(shown[::2], 2), np.stack(shown[1::2], 2)
    out[:, :, sides.columns] = (ahead - behind) / (2 * sides.steps)
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
    sides = _sides(simulator, table)
    if not sides.columns:
        return out
    if not simulator.reads_plainly:
        return _product(gradients, jacobian(simulator, table))
    response = simulator.respond(table)
    for tangent in _tangents(simulator, response, sides):
        try:
            found = tangent.system.pull_back(
                tangent.coefficients, tangent.stiffness, gradients * tangent.per_si
            )
        except (_core.UnstableSample, DependentTerms):
            continue  # the next path decides
        by_loads, by_stiffness = np.split(found, [tangent.coefficients.shape[1]], axis=1)
        along = _product(by_loads, tangent.coefficient_rates)
        along += _product(by_stiffness, tangent.stiffness_rates)
        out[:, sides.columns] = along / sides.steps
        return out
    return _product(gradients, jacobian(simulator, table))


def _sides(simulator: "Simulator", table: Values) -> Sides:
    columns, steps, tables = [], [], []
    for number, (name, variable) in enumerate(simulator.model.context.items()):
        if name in simulator.needed:
            step = STEP * (variable.range[1] - variable.range[0])
            columns.append(number)
            steps.append(step)
            tables += [{**table, name: table[name] + sign * step} for sign in SIGNS]
    return Sides(columns, np.array(steps), tables, [simulator.resolve(one) for one in tables])


def _tangents(simulator: "Simulator", response: "Response", sides: Sides) -> Iterator[Tangent]:
    """Linear paths at the rows, the cheapest first; none where there is no tangent."""
    rows = len(response.contexts["time"])
    middle = simulator.request(response.values, rows)
    around = [simulator.request(values, rows) for values in sides.values]
    states = np.unique(np.concatenate([one.states for one in (middle, *around)]), axis=0)
    start = middle.change(states[0])
    loads = middle.loads(start, np.arange(rows))
    if start.bearings or start.laws or start.nonlinear or not loads:
        return
    varied = unvaried(start, states.shape[1])
    if len(states) > 1:
        found = variation(middle.change, states)
        if found is None:
            return
        varied = found
    first, slope = varied.elements[0], varied.slope
    ends = np.stack([coefficients(one.loads(start, np.arange(rows))) for one in around], 2)
    moved = np.stack([one.of_rows @ slope for one in around], 2)
    for _, system in linear_paths(middle.prepared, varied, loads):
        yield Tangent(
            system,
            coefficients(loads),
            first + (middle.of_rows - states[0]) @ slope,
            _halves(ends),
            _halves(moved),
            start.per_si,
        )


def _product(gradients: FloatArray, derivatives: FloatArray) -> FloatArray:
    # A faulty sensor says nothing; its derivative must not spoil the others' sum.
    return np.asarray(np.einsum("ts,tsc->tc", gradients, np.nan_to_num(derivatives)))


def _halves(sides: FloatArray) -> FloatArray:
    return np.ascontiguousarray((sides[:, :, ::2] - sides[:, :, 1::2]) / 2)
