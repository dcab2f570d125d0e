"""Numbers that a logger writes where it has no reading, such as -9999."""

import numpy as np

from rga.arrays import FloatArray
from rga.quantities import counted
from rga.records import Record

#: rows in which the same number must stand: noise repeats no reading so far away
AGAIN = 3
#: how many times as far from the middle as anything else that is read or simulated: no cause makes
#: a response so much larger, in a few rows, and exactly the same in each
FAR = 10.0
#: channels that a warning names; it counts the others
MOST_NAMED = 5


def missing_codes(record: Record, simulated: FloatArray) -> list[str]:
    """Warnings of numbers that stand for missing readings, one for each number.

    Args:
        record: as it was measured, the channels that are simulated.
        simulated: float[rows that are analysed, sensors].
    """
    found: dict[float, list[int]] = {}
    for number, (column, shown) in enumerate(zip(record.readings.T, simulated.T, strict=True)):
        code = _code(column[np.isfinite(column)], shown)
        if code is not None:
            found.setdefault(code, []).append(number)
    return [_words(record, code, channels) for code, channels in found.items()]


def _code(column: FloatArray, simulated: FloatArray) -> float | None:
    """The number that repeats far away from all else that a channel reads or should read.

    >>> readings = np.array([1.0, 2.0, -9999.0, 3.0, -9999.0, -9999.0, 1.5, 0.5])
    >>> _code(readings, np.arange(4.0)), _code(readings[:5], np.arange(4.0))
    (-9999.0, None)
    """
    if not len(column):
        return None
    middle = np.median(column)
    code = column[np.argmax(np.abs(column - middle))]
    others = column[column != code]
    if (column == code).sum() < AGAIN or not len(others):
        return None
    usual = max(np.ptp(others), np.ptp(simulated))
    return float(code) if abs(code - middle) > FAR * usual else None


def _words(record: Record, code: float, channels: list[int]) -> str:
    names = ", ".join(record.sensors[number] for number in channels[:MOST_NAMED])
    more = len(channels) - MOST_NAMED
    rows = counted(int((record.readings[:, channels] == code).any(1).sum()), "row")
    return (
        f"{code:g} stands in {rows} of {names}{f' and {more} more channels' * (more > 0)}, "
        "far away from all else that they read, as a logger's code for a missing reading does: "
        "name it under missing in import.toml, or leave these cells empty"
    )
