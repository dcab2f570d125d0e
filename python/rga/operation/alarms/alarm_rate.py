"""How often the monitor raises an alarm without a change, as far as that is known."""

from rga.model import Model
from rga.operation.short_calibration import is_short
from rga.operation.sources.clock import in_words
from rga.quantities import counted
from rga.twin.settings import Settings


def rate_words(settings: Settings, every: float, model: Model) -> str:
    """How rare an alarm is without a change, in words; of the paper's rule nothing is known.

    Args:
        settings: of the run of the twin.
        every: length of a row [s].
        model: of the twin.
    """
    if settings.detector != "monitor":
        return ""
    calibrated = settings.pace(None).calibration_rows
    if is_short(model, calibrated, every):
        return (
            "how often such an alarm comes without a change is not known: the calibration took "
            f"{in_words(calibrated * every)}, and what later days bring is new to the twin"
        )
    apart = in_words(settings.arl0 * every)
    return (
        f"without a change such an alarm comes once in {counted(round(settings.arl0), 'row')} "
        f"({apart}) on average"
    )
