"""The noise of each channel, before anything is known of the contexts."""

import numpy as np

from rga.arrays import FloatArray


def noise_of(stated: list[float | None], readings: FloatArray) -> FloatArray:
    """Standard deviation of each channel's noise: as stated, else from steps between rows.

    Half the variance of first differences is the variance of white noise on a slow signal
    (von Neumann, 1941); their median makes it robust. A channel that mostly repeats itself has no
    noise to be measured by: NaN.

    Args:
        stated: by the model, one a channel.
        readings: float[rows, channels], NaN where missing.
    """
    steps = np.abs(np.diff(readings, axis=0))
    found = np.full(len(stated), np.nan)
    for column, known in enumerate(stated):
        own = steps[np.isfinite(steps[:, column]), column]
        rough = 1.4826 * float(np.median(own)) / np.sqrt(2) if len(own) else 0.0
        if known or rough:
            found[column] = known or rough
    return found
