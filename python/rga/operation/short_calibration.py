"""Whether a calibration has seen what days differ by."""

from rga.model import Model
from rga.operation.sources.clock import DAY

#: of a calibration that has [s]
LEAST_CALIBRATED = 3 * DAY


def is_short(model: Model, rows: int, every: float) -> bool:
    """Whether a calibration is over before it has seen the contexts of a few days.

    Args:
        model: of the twin.
        rows: of its calibration.
        every: length of a row [s].
    """
    return bool(model.context) and rows * every < LEAST_CALIBRATED
