"""The time axis of a file: time stamps or seconds, checked to increase."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import partial
from typing import Literal

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.mapping import TimeColumns
from rga.records.modal.columns import FREQUENCY
from rga.records.numbers import numbers_of
from rga.records.table import StatedTime, Table
from rga.records.times.counted import COMPACT, COUNTED, SECONDS, looks_like
from rga.records.times.written import moments_by, possible_formats, without_late_midnights
from rga.records.times.zone import first_repeated, in_zone, zone_of
from rga.records.units import contradict, name_and_unit, unit_of


@dataclass(frozen=True)
class Clock:
    """Time of the rows.

    Attributes:
        seconds: float[n], since the first row.
        start: the first time stamp, ISO 8601 text or seconds.
        time_format: "iso" or "seconds".
        columns: that hold it.
        notes: what was understood of it, in words.
    """

    seconds: FloatArray
    start: str | float
    time_format: Literal["iso", "seconds"]
    columns: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()


def read_clock(table: Table, time: TimeColumns) -> Clock:
    """The time axis of a table.

    Args:
        table: the file's columns.
        time: which columns hold the time, and how; what it leaves out is as the format says.

    Raises:
        InputError: a column or a time is missing, a time cannot be read, two notations are mixed,
            or time repeats or runs backwards.
    """
    notes: list[str] = []
    stated = _stated(table, time, notes)
    for column in stated.columns:
        if column not in table.frame.columns:
            raise InputError(
                f"there is no time column {column!r}",
                f"{table.path}, columns {_listed(table.frame.columns)}",
                "name it 'time', or give [time] columns (and the delimiter) in import.toml",
            )
    refused = time.repeated_hour == "refused"
    clock = _Reading(table, stated, time.zone or stated.zone, notes, refused).clock()
    rows = np.arange(table.frame.height, dtype=float)
    if time.sampling_rate_hz is not None:
        return replace(clock, seconds=np.asarray(rows / time.sampling_rate_hz))
    if not stated.columns:
        step = stated.step or 0.0
        if not SHORTEST_STEP <= step <= LONGEST_STEP:
            raise InputError(
                f"the file says that {step:g} s lie between its rows",
                str(table.path),
                "state [time] sampling_rate_hz in import.toml",
            )
        return replace(clock, seconds=np.asarray(rows * step))
    _check_order(clock, table, " + ".join(stated.columns))
    return clock


def _stated(table: Table, time: TimeColumns, notes: list[str]) -> StatedTime:
    """What is stated of the time, by import.toml or by the format."""
    own = table.time
    if "columns" not in time.model_fields_set and own is not None:
        if table.format == "plain text" and own.columns:
            notes.append("the time stands in " + " and ".join(map(repr, own.columns)))
        return replace(own, format=time.format or own.format)
    columns = tuple(time.columns)
    if "columns" not in time.model_fields_set and time.sampling_rate_hz is not None:
        columns = tuple(column for column in columns if column in table.frame.columns)
    for column in columns:
        named, said = name_and_unit(column)[1], table.units.get(column)
        if named and said and contradict(named, said):
            raise InputError(
                f"the name of {column!r} says {named!r}, the line of units says {said!r}",
                str(table.path),
                "correct one of them",
            )
    unit = unit_of(table.units.get(columns[0], "")) if len(columns) == 1 else None
    size = unit.size if unit is not None and unit.dimension == "time" else 1.0
    if own is not None and own.columns == columns:
        return replace(own, format=time.format or own.format)
    return StatedTime(columns, time.format, unit=size)


#: types of columns that tell no time of a row
NO_TIMES = (pl.Time, pl.Boolean, pl.Binary)
#: span of a record, below which no row can be told from another [s]
SHORTEST = 1e-6
#: steps of rows that are counted, within which loggers take them [s]
SHORTEST_STEP, LONGEST_STEP = 1e-9, 1e9


@dataclass(frozen=True)
class _Reading:
    """Time columns on their way to a clock; their rows may be in any order."""

    table: Table
    stated: StatedTime
    zone: str | None
    notes: list[str]
    refuses_repeated: bool

    @property
    def where(self) -> str:
        return " + ".join(self.stated.columns)

    def clock(self) -> Clock:
        stated = self.stated
        if not stated.columns:
            return self._elapsed(np.zeros(self.table.frame.height))
        series = [self.table.frame[column] for column in stated.columns]
        for column, values in zip(stated.columns, series, strict=True):
            if values.is_null().any():
                raise InputError(
                    "the time is missing",
                    self.table.where(int(values.is_null().arg_true()[0]), column),
                    "give every row its time, or take the row out",
                )
        if unfit := [one for one in series if one.dtype.is_nested() or one.dtype in NO_TIMES]:
            raise InputError(
                f"a column of {unfit[0].dtype} holds no times",
                self.table.where(0, unfit[0].name),
                "give dates with their time of day, or seconds",
            )
        if len(series) == 1 and series[0].dtype == pl.Duration:
            return self._elapsed(series[0].dt.total_microseconds().to_numpy() / 1e6)
        if len(series) == 1 and series[0].dtype.is_temporal():
            return self._temporal(series[0])
        if stated.format in COUNTED:
            return self._counted(series[0], *COUNTED[stated.format])
        if stated.format == SECONDS:
            return self._elapsed(self._seconds(series[0]))
        texts = [values.cast(pl.String).to_list() for values in series]
        joined = [" ".join(parts) for parts in zip(*texts, strict=True)]
        if stated.format is None and len(series) == 1 and self._is_number(series[0]):
            return self._numbered(series[0])
        joined, late = without_late_midnights(joined)
        if late:
            said = f"24:00 is midnight at the end of the day: {joined[late[0]]} and a day"
            self.notes.append(f"{said}, in {len(late)} rows")
        if stated.format is not None:
            return self._written(joined, stated.format, late)
        wanted = "ISO 8601 like the first row, or seconds throughout"
        # A row that counts for the next day says nothing of the order of days.
        telling = (
            [one for row, one in enumerate(joined) if row not in set(late)] if late else joined
        )
        formats = [] if _is_iso(joined[0]) else possible_formats(telling or joined)
        if len(formats) == 1:
            self.notes.append(f"times are read as {formats[0]}")
            return self._written(joined, formats[0], late)
        if formats:
            parts = "day, month and year" if "%y" in formats[0] else "day and month"
            choices = " or ".join(f'"{one}"' for one in formats)
            raise InputError(
                f"{parts} of {joined[0]!r} cannot be told apart",
                self.table.where(0, self.where),
                f"state [time] format = {choices} in import.toml",
            )
        clock = self._placed(self._moments(joined, datetime.fromisoformat, wanted), late)
        return clock if self.zone or 0 in late else replace(clock, start=joined[0])

    def _temporal(self, series: pl.Series) -> Clock:
        moments = series.cast(pl.Datetime("us", getattr(series.dtype, "time_zone", None)))
        if self.zone is not None:
            return self._placed(moments.to_list())
        stamps = np.array(moments.to_physical().to_numpy(), dtype=float) / 1e6
        return self._clock(stamps - stamps[0], moments[0].isoformat())

    def _numbered(self, series: pl.Series) -> Clock:
        """The clock of numbers, which are seconds unless they look like something else."""
        numbers = self._seconds(series)
        unit = self.table.units.get(series.name) or name_and_unit(series.name)[1] or ""
        known = unit_of(unit)
        if self.stated.start is not None or (known is not None and known.dimension == "time"):
            return self._elapsed(numbers * self.stated.unit)
        meant = looks_like(numbers)
        if meant == COMPACT[14]:
            self.notes.append(f"times are read as {meant}")
            return self._written([f"{number:.0f}" for number in numbers], meant)
        if meant == "unix":
            self.notes.append(
                'times are taken as seconds; state [time] format = "unix" if they count from 1970'
            )
        elif meant is not None:
            choice = f'"{meant}"' if meant else '"excel", "unix_ms"'
            raise InputError(
                f"the times hardly are seconds: {series[0]} is the first",
                self.table.where(0, self.where),
                f'state [time] format = {choice} in import.toml, or "{SECONDS}" if they are',
            )
        return self._elapsed(numbers * self.stated.unit)

    def _counted(self, series: pl.Series, unit: float, zero: datetime) -> Clock:
        stamps = self._seconds(series) * unit
        return self._clock(stamps - stamps[0], self._after(zero, float(stamps[0])))

    def _written(self, joined: list[str], pattern: str, late: Sequence[int] = ()) -> Clock:
        moments = moments_by(joined, pattern)
        if moments is None:
            parse = partial(_by_format, pattern=pattern)
            moments = self._moments(joined, parse, f"written as {pattern}")
        return self._placed(moments, late)

    def _elapsed(self, stamps: FloatArray) -> Clock:
        """Time since what the format says is the start, or on a scale that it does not name."""
        if self.stated.start is None:
            return self._clock(stamps - stamps[0], float(stamps[0]))
        try:
            zero = datetime.fromisoformat(self.stated.start)
        except ValueError:
            raise InputError(
                f"the start {self.stated.start!r} cannot be read",
                str(self.table.path),
                "export the file again",
            ) from None
        return self._clock(stamps - stamps[0], self._after(zero, float(stamps[0])))

    def _after(self, zero: datetime, seconds: float) -> str:
        """The time stamp that lies some seconds after another, in the zone if one is stated."""
        try:
            moment = zero + timedelta(seconds=round(seconds, 6))
        except OverflowError:
            raise InputError(
                f"{seconds:g} s after {zero} is none of the years 1 to 9999",
                self.table.where(0, self.where),
                "correct the time, or [time] format in import.toml",
            ) from None
        if self.zone is not None and moment.tzinfo is None:
            moment = moment.replace(tzinfo=zone_of(self.zone, str(self.table.path)))
        return moment.isoformat()

    def _a_day_after(self, moment: datetime, row: int) -> datetime:
        try:
            return moment + timedelta(days=1)
        except OverflowError:
            raise InputError(
                f"the day after {moment} is none of the years 1 to 9999",
                self.table.where(row, self.where),
                "correct the time",
            ) from None

    def _placed(self, moments: list[datetime], late: Sequence[int] = ()) -> Clock:
        """The clock of moments as they are written; those of late rows are of the next day."""
        for row in late:
            moments[row] = self._a_day_after(moments[row], row)
        if self.zone is None or moments[0].tzinfo is not None:
            elapsed = np.array([(moment - moments[0]).total_seconds() for moment in moments])
            if moments[0].tzinfo is None and self.stated.columns != ("time",):
                self.notes.append("time stamps have no zone")
            return self._clock(elapsed, moments[0].isoformat())
        zone = zone_of(self.zone, str(self.table.path))
        twice = first_repeated(pl.Series(moments), zone) if self.refuses_repeated else None
        if twice is not None:
            raise InputError(
                f"the time {moments[twice]} exists twice in {self.zone}: summer time ends there",
                self.table.where(twice, self.where),
                "send times with their offset, or in UTC",
            )
        stamps, gap = in_zone(pl.Series(moments), zone, self.notes)
        if gap is not None:
            raise InputError(
                f"the time {moments[gap]} does not exist in {self.zone}: summer time begins there",
                self.table.where(gap, self.where),
                'give the zone that the logger keeps to, such as zone = "+01:00"',
            )
        first = datetime(1970, 1, 1, tzinfo=UTC) + timedelta(microseconds=int(stamps[0]))
        start = first.astimezone(zone)
        return self._clock((stamps - stamps[0]) / 1e6, start.isoformat())

    def _clock(self, seconds: FloatArray, start: str | float) -> Clock:
        if len(seconds) > 1 and 0 < np.ptp(seconds) < SHORTEST:
            raise InputError(
                f"all rows lie within {np.ptp(seconds):g} s",
                self.table.where(0, self.where),
                "give times in seconds, or state their unit in import.toml",
            )
        kind: Literal["iso", "seconds"] = "iso" if isinstance(start, str) else "seconds"
        return Clock(seconds, start, kind, self.stated.columns, tuple(self.notes))

    def _moments(
        self, texts: Sequence[str], parse: Callable[[str], datetime], wanted: str
    ) -> list[datetime]:
        moments: list[datetime] = []
        for row, text in enumerate(texts):
            try:
                moments.append(parse(text))
            except ValueError:
                raise InputError(
                    f"the time {text!r} cannot be read",
                    self.table.where(row, self.where),
                    f"give it {wanted}",
                ) from None
            if (moments[row].tzinfo is None) != (moments[0].tzinfo is None):
                raise InputError(
                    "some times have a time zone and some have none",
                    self.table.where(row, self.where),
                    "write all times alike",
                )
        return moments

    def _seconds(self, series: pl.Series) -> FloatArray:
        read, bad = numbers_of(series, self.table.notation)
        wrong = bad | ~np.isfinite(read)
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(
                f"the time {str(series[row])!r} is not in seconds as in the first row",
                self.table.where(row, self.where),
                "write all times in seconds, or all in ISO 8601",
            )
        return read

    def _is_number(self, series: pl.Series) -> bool:
        read, bad = numbers_of(series.head(1), self.table.notation)
        return len(read) > 0 and not bad[0] and bool(np.isfinite(read[0]))


def _by_format(text: str, pattern: str) -> datetime:
    return datetime.strptime(text, pattern)


def _is_iso(text: str) -> bool:
    try:
        datetime.fromisoformat(text)
    except ValueError:
        return False
    return True


def _check_order(clock: Clock, table: Table, where: str) -> None:
    step = np.diff(clock.seconds)
    wrong = ~(step > 0)
    if not wrong.any():
        return
    row = int(np.argmax(wrong)) + 1
    if step[row - 1] == 0:
        what = "the time is the same as in the row before"
        remedy = "take the double row out, or give [time] sampling_rate_hz where stamps are coarse"
        if FREQUENCY in table.frame.columns:
            remedy = f"is this a table of modes, one in each row? Give it as --modal; else {remedy}"
    else:
        what, remedy = "the time runs backwards", "sort the rows by time"
        # An autumn night: the hour of summer time comes again.
        if clock.time_format == "iso" and -3600 <= step[row - 1] < 0:
            remedy += ', or state [time] zone = "..." where summer time ends here'
    raise InputError(what, table.where(row, where), remedy)


def _listed(names: list[str]) -> str:
    shown = ", ".join(names[:6])
    return shown if len(names) <= 6 else f"{shown}, ... ({len(names)} in all)"
