"""Records with so few rows under load that nothing can be decided by them."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Data

#: response of a row, as a share of the largest, from which on it counts as one under load
LOADED = 0.1


def too_short(data: Data, simulated: FloatArray, deviation: FloatArray) -> str | None:
    """In words: that a record is too short to decide; None where it is not.

    Args:
        data: of all rows.
        simulated: by the model as given, float[rows, sensors].
        deviation: of the noise of each sensor, float[sensors].
    """
    criteria = data.criteria.record
    rows, loaded = len(simulated), loaded_rows(simulated, deviation)
    if rows >= criteria.few_rows or loaded >= criteria.loaded_rows:
        return None
    return (
        f"the record is too short to decide: the loads move the readings in {loaded} of its {rows} "
        f"rows, and {criteria.loaded_rows} such rows are needed"
    )


def loaded_rows(simulated: FloatArray, deviation: FloatArray) -> int:
    """Number of rows in which a simulation leaves its usual level.

    >>> loaded_rows(np.array([[0.0], [0.0], [9.0], [0.1], [8.0]]), np.ones(1))
    2
    """
    moved = (simulated - np.median(simulated, axis=0)) / np.maximum(deviation, 1e-300)
    size = np.sqrt((moved**2).sum(1))
    return int((size > LOADED * size.max(initial=0.0)).sum())
