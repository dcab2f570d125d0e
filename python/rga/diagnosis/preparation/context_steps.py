"""How coarsely contexts are given, and what channels show of it."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Data
from rga.records import Record
from rga.simulation import Simulator

#: share of a step by which values may lie beside whole numbers of it
BESIDE = 1e-3
#: levels of a context that is given in steps; a switch has two
FEWEST = 3
#: steps between two levels, beyond which they are none
MOST = 1e9


def step_of(values: FloatArray) -> float:
    """The step of which all values lie whole numbers apart; 0 where there is none.

    Args:
        values: of a context, float[rows], NaN where missing.

    >>> step_of(np.array([5.0, 15.0, np.nan, 10.0, 25.0])), step_of(np.array([1.0, 1.3, 2.718]))
    (5.0, 0.0)
    >>> step_of(np.array([0.0, 1e-300, 1e300]))
    0.0
    """
    levels = np.unique(values[np.isfinite(values)])
    if len(levels) < FEWEST:
        return 0.0
    apart = np.diff(levels)
    step = float(apart.min())
    if step * MOST < apart.max():
        return 0.0
    whole = apart / step
    return step if np.abs(whole - np.round(whole)).max() < BESIDE else 0.0


def shown_by_steps(
    simulator: Simulator, data: Data, record: Record, simulated: FloatArray
) -> FloatArray:
    """What channels may show of contexts that were rounded to steps, float[sensors].

    A value that was rounded lies anywhere within half a step: what that does to a channel, as a
    standard deviation. All contexts are taken as rounded independently.

    Args:
        simulator: of the model.
        data: of the record.
        record: holds contexts as they were given.
        simulated: float[rows, sensors], at these contexts.
    """
    variance = np.zeros(len(data.sensors))
    for name, values in record.contexts.items():
        if name in data.belief.spread and (step := step_of(values)) > 0.0:
            moved = data.predict(simulator, {name: data.belief.table[name] + step / 2})
            variance += ((moved - simulated) ** 2).mean(axis=0) / 3.0
    return np.sqrt(variance)
