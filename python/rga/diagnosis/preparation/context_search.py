"""A first guess of latent contexts: those that are a line in time, and those of each row.

For a line (where a train stands, how fast it goes) the guess must not lean on the size of the
response, since the model is wrong somewhere: each sensor is compared after the gain that suits it
best, by the share of its variance that is left. For contexts that are free in every row all rows
are searched over the ranges and then moved by Gauss-Newton steps of their own, because products of
contexts (how much load stands where) mislead a search that begins at the centre of the ranges.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import scipy

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.diagnosis.data.observations import Data
from rga.inference.map.standard_units import EDGE, standard
from rga.numerics.gauss_newton import minimise
from rga.simulation import Simulator

ROWS = 240
LEVELS = 161
RATES = 29
#: contexts tried for every row, and steps from the best of them; gain of a step [chi square] below
#: which a row rests; what derivatives are taken over, in standard units
TRIALS, STEPS, GAIN, DIFFERENCE = 256, 12, 1e-3, 3e-4
#: share of a sensor's spread by which the model may be off
MODEL_ERROR = 0.05


def guess_lines(simulator: Simulator, data: Data, progress: Callable[[float], None]) -> Data:
    """The data with latent lines moved to the best of a grid, then to the nearest optimum.

    Args:
        simulator: the simulation as it was given.
        data: readings and belief.
        progress: called with the share that is done.
    """
    for name in data.belief.lines:
        variable = simulator.model.context[name]
        few = data.rows(_thinned(len(data.time)))
        middle = data.belief.middle
        low, high = variable.range
        levels = np.linspace(low, high, LEVELS)
        rates = np.zeros(1)
        if variable.law == "linear" and variable.rate is not None:
            rates = np.linspace(*variable.rate, RATES)
        clock = few.time - middle

        def left(
            line: FloatArray, name: str = name, few: Data = few, clock: FloatArray = clock
        ) -> float:
            return _variance_left(few, few.predict(simulator, {name: line[0] + line[1] * clock}))

        best = (np.inf, 0.0, 0.0)
        for number, rate in enumerate(rates):
            for level in levels:
                best = min(best, (left(np.array([level, rate])), float(level), float(rate)))
            progress((number + 1) / len(rates))
        start = np.array(best[1:])
        steps = np.array([(high - low) / LEVELS, float(np.ptp(rates)) / RATES])
        simplex = start + np.array([[0, 0], [steps[0], 0], [0, steps[1]]])
        found = scipy.optimize.minimize(
            left, start, method="Nelder-Mead", options={"initial_simplex": simplex}
        ).x
        line = found[0] + found[1] * (data.time - middle)
        data = replace(data, belief=data.belief.with_values({name: line}))
    return data


def guess_rows(simulator: Simulator, data: Data) -> Data:
    """The data with contexts that are latent in every row moved to where each row puts them.

    Args:
        simulator: the simulation as it was given.
        data: readings and belief.
    """
    names = [name for name in simulator.model.context if name in data.belief.latent]
    if not names:
        return data
    ranges = np.array([simulator.model.context[name].range for name in names])
    middle, scale = standard(ranges)
    typical = np.abs(data.predict(simulator)).max(axis=0, initial=0.0)
    stated = np.array([simulator.model.sensors[name].noise or 0.0 for name in data.sensors])
    noise = np.maximum(
        np.hypot(stated, MODEL_ERROR * data.readings.std(axis=0)), 1e-9 + typical / 1e6
    )

    def residual(z: FloatArray, of: IntArray) -> FloatArray:
        few = data.rows(of)
        changes = dict(zip(names, (middle + scale * z).T, strict=True))
        off = (few.predict(simulator, changes) - few.readings) / noise
        return np.where(few.observed, off, 0.0)

    def slope(z: FloatArray, of: IntArray) -> FloatArray:
        columns = [
            (residual(z + DIFFERENCE * one, of) - residual(z - DIFFERENCE * one, of))
            / (2 * DIFFERENCE)
            for one in np.eye(len(names))
        ]
        return np.stack(columns, axis=2)

    rows = np.arange(len(data.time))
    start = np.zeros((len(rows), len(names)))
    least = (residual(start, rows) ** 2).sum(axis=1)
    for trial in scipy.stats.qmc.Sobol(len(names), scramble=True, rng=0).random(TRIALS):
        z = np.tile(EDGE * (2.0 * trial - 1.0), (len(rows), 1))
        found = (residual(z, rows) ** 2).sum(axis=1) + (z**2).sum(axis=1)
        start[found < least] = z[0]
        least = np.minimum(least, found)
    # A range is where contexts are likely to be, but a load may be greater.
    best = middle + scale * minimise(residual, slope, start, np.inf, STEPS, GAIN).z
    changes = dict(zip(names, best.T, strict=True))
    # The range is no prior for all rows at once: a long event beyond it would make the structure
    # look stiff. What is free in every row is free about its own guess.
    belief = replace(data.belief, centre={**data.belief.centre, **changes})
    return replace(data, belief=belief.with_values(changes))


def _thinned(rows: int) -> BoolArray:
    chosen = np.zeros(rows, dtype=bool)
    chosen[np.linspace(0, rows - 1, min(ROWS, rows)).astype(int)] = True
    return chosen


def _variance_left(data: Data, simulated: FloatArray) -> float:
    """Mean over the sensors of the share of variance that the best gain leaves."""
    measured = np.where(data.observed, data.readings, 0.0)
    own = np.where(data.observed, simulated, 0.0)
    total = np.maximum((measured**2).sum(0), 1e-300)
    together = np.maximum((measured * own).sum(0), 0.0) ** 2 / np.maximum((own**2).sum(0), 1e-300)
    return float(np.mean(1 - together / total))
