"""What a year takes of the disk of a service, and how long there is room."""

from collections.abc import Iterable
from dataclasses import dataclass

from rga.operation.configuration import TwinSettings

DAY = 86_400.0
YEAR = 365.25 * DAY
#: bytes of a value of a sensor or context: measured, simulated or inferred with how far it is off,
#: and what its samples were beside their mean
VALUE = 44
#: bytes of a step of a twin beside its rows
STEP = 4_000
#: what helps where a year does not fit
MAKE_ROOM = "make room, make fewer rows (rows.every), or keep packets shorter (retention.raw)"


@dataclass(frozen=True)
class YearlyGrowth:
    """What a twin takes of the disk in a year.

    Attributes:
        rows: bytes for rows and steps.
        packets: bytes for packets that are kept; 0: too few have come to tell.
    """

    rows: float
    packets: float

    @property
    def total(self) -> float:
        """Bytes of all."""
        return self.rows + self.packets


def yearly_growth(
    twin: TwinSettings, values: int, packet: int, bytes_a_second: float
) -> YearlyGrowth:
    """What a twin takes of the disk in a year.

    Args:
        twin: its settings.
        values: sensors and contexts in a row.
        packet: rows of a step.
        bytes_a_second: that its sources send.
    """
    rows = YEAR / twin.rows.every
    kept = min(YEAR, twin.retention.raw or YEAR)
    return YearlyGrowth(rows * (VALUE * values + STEP / packet), bytes_a_second * kept)


@dataclass(frozen=True)
class DiskForecast:
    """How long the disk of a service has room.

    Attributes:
        free: bytes that are free.
        free_share: share of the disk that is [-].
        year: what one twin takes of it.
        year_of_all: bytes that all twins of the service take in a year.
        days: for which there is room.
    """

    free: int
    free_share: float
    year: YearlyGrowth
    year_of_all: float
    days: float

    @property
    def lasts_a_year(self) -> bool:
        """Whether there is room for a year."""
        return self.days * DAY >= YEAR


def disk_forecast(
    free: int, free_share: float, twin: YearlyGrowth, others: Iterable[YearlyGrowth]
) -> DiskForecast:
    """How long a disk has room for a twin and for others beside it."""
    of_all = twin.total + sum(one.total for one in others)
    return DiskForecast(free, free_share, twin, of_all, free / of_all * YEAR / DAY)
