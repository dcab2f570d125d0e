"""The noise of each channel, before anything is known of the contexts."""

import numpy as np

from rga.arrays import FloatArray
from rga.twin.row_buffer import RowBuffer


def noise_of(stated: list[float | None], ledger: RowBuffer, rows: int) -> FloatArray:
    """Standard deviation of each channel's noise: as stated, else from steps between rows.

    Half the variance of first differences is the variance of white noise on a slow signal
    (von Neumann, 1941); their median makes it robust. A channel that is stuck, or mostly repeats
    itself where no noise is stated, has none to be measured by: NaN.

    Args:
        stated: by the model, one a channel.
        ledger: rows of a run.
        rows: how many of its first ones tell.
    """
    steps = np.abs(np.diff(ledger.readings[:rows], axis=0))
    found = np.full(len(stated), np.nan)
    for column, known in enumerate(stated):
        own = steps[np.isfinite(steps[:, column]), column]
        rough = 1.4826 * float(np.median(own)) / np.sqrt(2) if len(own) else 0.0
        if (known or rough) and not ledger.stuck[column]:
            found[column] = known or rough
    return found
