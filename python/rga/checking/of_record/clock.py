"""The clock of a record: gaps, steps of unequal length, times without a zone."""

from collections.abc import Iterator
from datetime import datetime

import numpy as np

from rga.checking.finding import Finding
from rga.checking.measured import Measured

#: a step so many times the usual one is a gap; share of the whole time that makes it a large one
GAP, LARGE = 5.0, 0.2
#: deviation of a step from the usual one, as a share, and share of steps that may deviate so
UNEQUAL, OFTEN = 0.1, 0.05


def clock(measured: Measured) -> Iterator[Finding]:
    """Gaps with their places, steps that vary, times that state no zone."""
    record = measured.record
    if isinstance(record.start, str) and datetime.fromisoformat(record.start).tzinfo is None:
        yield Finding(
            "note",
            "record, time",
            "the times state no time zone: they are taken as UTC",
            "state [time] zone in import.toml where onsets or zeros of the model have one",
        )
    steps = np.diff(record.time)
    if not len(steps):
        return
    usual = float(np.median(steps))
    gaps = np.flatnonzero(steps > GAP * usual)
    if len(gaps):
        longest = int(gaps[np.argmax(steps[gaps])])
        large = steps[longest] > LARGE * (record.time[-1] - record.time[0])
        yield Finding(
            "warning" if large else "note",
            "record, time",
            f"{len(gaps)} gap{'s' if len(gaps) > 1 else ''}: the longest of {steps[longest]:.6g} s "
            f"behind {measured.moment(longest)}, where steps are {usual:.6g} s as a rule",
            "nothing is interpolated; what changed meanwhile shows as a jump",
        )
    others = steps[steps <= GAP * usual]
    unequal = float((np.abs(others / usual - 1) > UNEQUAL).mean())
    if unequal > OFTEN:
        yield Finding(
            "note",
            "record, time",
            f"{unequal:.0%} of the steps differ from {usual:.6g} s, from {others.min():.6g} to "
            f"{others.max():.6g} s",
            "give [time] sampling_rate_hz in import.toml where the stamps are coarse",
        )
