"""A first guess of latent contexts: those that are a line in time, and those of each row.

For a line (where a train stands, how fast it goes) the guess must not lean on the size of the
response, since the model is wrong somewhere: each sensor is compared after the gain that suits it
best, by the share of its variance that is left. For contexts that are free in every row all rows
are searched over the ranges and then moved by Gauss-Newton steps of their own, because products of
contexts (how much load stands where) mislead a search that begins in the middle of the ranges.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize
from scipy.stats import qmc

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.data.observations import Data
from rga.simulation import Simulator

ROWS = 240
LEVELS = 161
RATES = 29
#: contexts tried for every row, Gauss-Newton steps from the best of them, and the difference that
#: their derivatives are taken over, in shares of the ranges
TRIALS, STEPS, DIFFERENCE = 256, 12, 1e-4
#: share of a sensor's spread by which the model may be off
MODEL_ERROR = 0.05


def guess_lines(simulator: Simulator, data: Data, progress: Callable[[float], None]) -> Data:
    """The data with latent lines moved to the best of a grid, then to the nearest optimum.

    Args:
        simulator: the simulation as it was given.
        data: readings and belief.
        progress: told the share that is done.
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
        found = minimize(left, start, method="Nelder-Mead", options={"initial_simplex": simplex}).x
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
    middle, width = ranges.mean(axis=1), np.ptp(ranges, axis=1)
    drawn = qmc.Sobol(len(names), scramble=True, rng=0).random(TRIALS) - 0.5
    typical = np.abs(data.predict(simulator)).max(axis=0, initial=0.0)
    stated = np.array([simulator.model.sensors[name].noise or 0.0 for name in data.sensors])
    scale = np.maximum(
        np.hypot(stated, MODEL_ERROR * data.readings.std(axis=0)), 1e-9 + typical / 1e6
    )

    def residual(shares: FloatArray) -> FloatArray:
        changes = dict(zip(names, (middle + width * shares).T, strict=True))
        off = (data.readings - data.predict(simulator, changes)) / scale
        return np.where(data.observed, off, 0.0)

    def cost(shares: FloatArray, off: FloatArray) -> FloatArray:
        # A context spread evenly over its range has the variance 1/12 in shares of it.
        return np.asarray((off**2).sum(axis=1) + 12 * (shares**2).sum(axis=1))

    rows = len(data.time)
    best = np.zeros((rows, len(names)))
    least = cost(best, residual(best))
    for trial in drawn:
        shares = np.tile(trial, (rows, 1))
        found = cost(shares, residual(shares))
        best[found < least] = trial
        least = np.minimum(least, found)
    damping = np.full(rows, 1e-3)
    for _ in range(STEPS):
        off = residual(best)
        columns = [
            (residual(best - DIFFERENCE * one) - residual(best + DIFFERENCE * one))
            / (2 * DIFFERENCE)
            for one in np.eye(len(names))
        ]
        slopes = np.stack(columns, axis=2)
        square = slopes.transpose(0, 2, 1) @ slopes + 12 * np.eye(len(names))
        square = square * (1 + damping[:, None, None] * np.eye(len(names)))
        along = np.einsum("tsk,ts->tk", slopes, off) - 12 * best
        moved = best + np.linalg.solve(square, along[:, :, None])[:, :, 0]
        found = cost(moved, residual(moved))
        better = found < least
        best[better], least = moved[better], np.minimum(least, found)
        damping = np.where(better, damping / 5, damping * 5)
    changes = dict(zip(names, (middle + width * best).T, strict=True))
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
