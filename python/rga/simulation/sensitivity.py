"""Derivatives of the sensors by the contexts.

Coefficients of loads and stiffnesses are straight in the contexts but for kinks, so that their
central differences have no truncation error; the response to them is differentiated exactly
(`condensation`). Where whole structures vary, where friction remembers, or where displacements are
large, the response itself is differenced.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rga.model.effect import Values
from rga.model.parameter import FloatArray
from rga.simulation.condensation import DependentTerms
from rga.simulation.plan import MOST_TERMS, NOTHING, Request, coefficients, condensed
from rga.simulation.variation import variation

if TYPE_CHECKING:
    from rga.simulation.simulator import Simulator

#: step of differences, as a share of the range of a context
STEP = 1e-4
SIGNS = (1.0, -1.0)


def jacobian(simulator: "Simulator", table: Values) -> FloatArray:
    """Derivatives, float[rows, sensors, contexts].

    Args:
        simulator: of a model.
        table: contexts and time, checked, float[rows] each.
    """
    variables, rows = simulator.model.context, len(table["time"])
    out = np.zeros((rows, len(simulator.model.sensors), len(variables)))
    columns, tables, steps = [], [], []
    for number, (name, variable) in enumerate(variables.items()):
        if name in simulator.needed:
            step = STEP * (variable.range[1] - variable.range[0])
            columns.append(number)
            steps.append(step)
            tables += [{**table, name: table[name] + sign * step} for sign in SIGNS]
    if not columns:
        return out
    response = simulator.respond(table)
    values = [simulator.resolve(one) for one in tables]
    rates = _rates(
        simulator.request(response.values, rows), [simulator.request(one, rows) for one in values]
    )
    shown = []
    for number, (one, of_one) in enumerate(zip(tables, values, strict=True)):
        if rates is None:
            shown.append(simulator.predict(one))
            continue
        moved = response.quantities + SIGNS[number % 2] * rates[:, :, number // 2]
        shown.append(
            simulator.read(replace(response, contexts=one, values=of_one, quantities=moved))
        )
    out[:, :, columns] = (np.stack(shown[::2], 2) - np.stack(shown[1::2], 2)) / (
        2 * np.array(steps)
    )
    return out


def _rates(middle: Request, sides: Sequence[Request]) -> FloatArray | None:
    """Half the differences of the sensors between sides, along the tangents in the middle.

    Args:
        middle: where to take the tangents.
        sides: one ahead and one behind for each direction, in turn.

    Returns:
        float[rows, sensors, directions] in the sensors' units; None where there is no tangent.
    """
    states = np.unique(np.concatenate([one.states for one in (middle, *sides)]), axis=0)
    rows = np.arange(len(middle.state_of_row))
    start = middle.change(states[0])
    if start.bearings or start.laws or start.nonlinear:
        return None
    loads = middle.loads(start, rows)
    if not loads:
        return np.zeros((len(rows), len(start.per_si), len(sides) // 2))
    ends = np.stack([coefficients(one.loads(start, rows)) for one in sides], 2)
    members = springs = NOTHING
    slope = np.zeros((states.shape[1], 0))
    stiffness = np.zeros((len(rows), 0))
    if len(states) > 1:
        varied = variation(middle.change, states)
        if varied is None or len(varied.first) > MOST_TERMS:
            return None
        members, springs, slope = varied.members, varied.springs, varied.slope
        stiffness = varied.stiffness[0] + (middle.of_rows - states[0]) @ slope
    moved = np.stack([one.of_rows @ slope for one in sides], 2)
    try:
        found = condensed(middle.prepared, start, loads, members, springs)
    except DependentTerms:
        return None
    rates = found.differentiate(coefficients(loads), stiffness, _halves(ends), _halves(moved))
    return np.asarray(rates * start.per_si[:, None])


def _halves(sides: FloatArray) -> FloatArray:
    return np.ascontiguousarray((sides[:, :, ::2] - sides[:, :, 1::2]) / 2)
