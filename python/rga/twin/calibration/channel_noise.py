"""The noise of each channel, before anything is known of the contexts."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.numerics.robust_spread import robust_spread


def noise_of(
    stated: list[float | None], readings: FloatArray, stuck: NDArray[np.bool_]
) -> FloatArray:
    """Standard deviation of each channel's noise: as stated, else from steps between rows.

    Half the variance of first differences is the variance of white noise on a slow signal
    (von Neumann, 1941); their median makes it robust. A channel that is stuck, or mostly repeats
    itself where no noise is stated, has none to be measured by: NaN.

    Args:
        stated: by the model, one a channel.
        readings: of rows that follow one another, float[rows, channels].
        stuck: channels that stand still, bool[channels].
    """
    steps = np.abs(np.diff(readings, axis=0))
    found = np.full(len(stated), np.nan)
    for column, known in enumerate(stated):
        own = steps[np.isfinite(steps[:, column]), column]
        rough = robust_spread(own) / 2**0.5
        if (known or rough) and not stuck[column]:
            found[column] = known or rough
    return found
