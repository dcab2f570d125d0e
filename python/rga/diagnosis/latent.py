"""A first guess of latent contexts that are a line in time: where a train stands, how fast it goes.

The model is wrong somewhere, so the guess must not lean on the size of its response: each sensor
is compared after the gain that suits it best, by the share of its variance that is left.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from rga.diagnosis.covariance import BoolArray
from rga.diagnosis.data import Data
from rga.model.parameter import FloatArray
from rga.simulation import Simulator

ROWS = 240
LEVELS = 161
RATES = 29


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
