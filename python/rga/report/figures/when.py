"""Times as figures of a run say them."""

from rga.quantities import MINUS, duration, short
from rga.report.pages.cards import moment


def when(time: str | float) -> str:
    """A time as the record writes it; many seconds also in a unit that can be read.

    >>> when("2024-05-01T12:00:00"), when(172800.0).replace("\u00a0", " ")
    ('2024-05-01 12:00:00', '172\u202f800 s (48 h)')
    """
    said = moment(time)
    if isinstance(time, str):
        return said
    length, unit = duration(abs(time))
    return said if unit == "s" else f"{said} ({'' if time >= 0 else MINUS}{short(length)} {unit})"
