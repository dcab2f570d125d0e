"""What the files of one logger hold for a model, on one time axis."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from hashlib import sha256
from itertools import pairwise

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.records.channels import doubts_of, sources_of, told_of, unused_in, values_of
from rga.records.mapping import FileMapping
from rga.records.table import Table
from rga.records.times import Clock, read_clock


@dataclass(frozen=True)
class LoggerData:
    """Values of channels in the units of a model, and their time.

    Attributes:
        where: the file, or the first of several.
        clock: time of the rows.
        values: by sensor or context variable, float[n] each, NaN where one is missing.
        unused: channels that are left out, with the reason.
        notes: what was understood of the files, in words.
        warnings: what the reader should know of them, in words.
        sha256: hash of the files.
    """

    where: str
    clock: Clock
    values: dict[str, FloatArray]
    unused: dict[str, str]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]
    sha256: str


def measured(table: Table, mapping: FileMapping, model: Model) -> LoggerData:
    """A table in the units and names of a model.

    Raises:
        InputError: a time, a name, a value or a unit cannot be used as it stands.
    """
    clock = read_clock(table, mapping.time)
    sources = sources_of(table, mapping, model, clock.columns)
    values = {
        name: values_of(table, mapping, name, source, model) for name, source in sources.items()
    }
    named = [] if table.format == "plain text" else [f"{table.path.name} is read as {table.format}"]
    notes = (*named, *table.notes, *clock.notes, *told_of(table, mapping, sources, model))
    unused = unused_in(table, mapping, model)
    doubts = [f"column {column!r}: {why}" for column, why in doubts_of(sources).items()]
    warnings = (*table.warnings, *doubts)
    return LoggerData(str(table.path), clock, values, unused, notes, warnings, table.sha256)


def in_time(parts: Sequence[LoggerData]) -> LoggerData:
    """Files of one logger, one after the other; their order is that of their times.

    Raises:
        InputError: their times overlap, or are not written alike.
    """
    if len(parts) == 1:
        return parts[0]
    for part in parts[1:]:
        check_alike(parts[0], part)
    parts = sorted(parts, key=lambda part: since(parts[0].clock, part.clock))
    parts = [parts[0], *(_following(*pair) for pair in pairwise(parts))]
    first = parts[0].clock
    names = dict.fromkeys(name for part in parts for name in part.values)
    rows = [len(part.clock.seconds) for part in parts]
    warnings = [text for part in parts for text in part.warnings]
    for name in names:
        without = [part.where for part in parts if name not in part.values]
        warnings += [f"{name} is missing in {', '.join(without)}"] if without else []
    return LoggerData(
        where=parts[0].where,
        clock=replace(
            first,
            seconds=np.concatenate(
                [since(first, part.clock) + part.clock.seconds for part in parts]
            ),
        ),
        values={
            name: np.concatenate(
                [
                    part.values.get(name, np.full(count, np.nan))
                    for part, count in zip(parts, rows, strict=True)
                ]
            )
            for name in names
        },
        unused={name: reason for part in parts for name, reason in part.unused.items()},
        notes=(
            f"{len(parts)} files follow each other in time",
            *dict.fromkeys(note for part in parts for note in part.notes),
        ),
        warnings=tuple(dict.fromkeys(warnings)),
        sha256=sha256("".join(part.sha256 for part in parts).encode()).hexdigest(),
    )


def since(first: Clock, other: Clock) -> float:
    """From the first row of a clock to that of another [s]."""
    if isinstance(first.start, str) and isinstance(other.start, str):
        begin, end = (datetime.fromisoformat(one.start) for one in (first, other))  # type: ignore[arg-type]
        return (end - begin).total_seconds()
    return float(other.start) - float(first.start)


def later(clock: Clock, seconds: FloatArray) -> Clock:
    """The clock of rows at times that count from another clock's first row [s]."""
    start: str | float
    if isinstance(clock.start, str):
        moment = datetime.fromisoformat(clock.start) + timedelta(seconds=float(seconds[0]))
        start = moment.isoformat()
    else:
        start = clock.start + float(seconds[0])
    return replace(clock, seconds=seconds - seconds[0], start=start)


def check_alike(one: LoggerData, other: LoggerData, stated: str = "[time]") -> None:
    """Refuses times that cannot be set against each other.

    Args:
        stated: where import.toml says how their times are read.

    Raises:
        InputError: one counts seconds and the other has time stamps, or one has a zone.
    """
    kinds = [_kind(part.clock) for part in (one, other)]
    if kinds[0] != kinds[1]:
        raise InputError(
            f"the times of {one.where} are {kinds[0]}, those of {other.where} are {kinds[1]}",
            other.where,
            f"state columns, format or zone under {stated} in import.toml so that both are alike",
        )


def _kind(clock: Clock) -> str:
    if not isinstance(clock.start, str):
        return "seconds"
    zoned = datetime.fromisoformat(clock.start).tzinfo is not None
    return "time stamps with a zone" if zoned else "time stamps without a zone"


def _following(before: LoggerData, after: LoggerData) -> LoggerData:
    """A file that goes on where another ends; a row that both have is taken once.

    Raises:
        InputError: it begins before the other ends.
    """
    ends = before.clock.seconds[-1]
    begins = since(before.clock, after.clock)
    if begins > ends:
        return after
    same = all(
        np.array_equal(values[-1:], after.values.get(name, values)[:1], equal_nan=True)
        for name, values in before.values.items()
    )
    if begins == ends and same and len(after.clock.seconds) > 1:
        clock = later(after.clock, after.clock.seconds[1:])
        values = {name: column[1:] for name, column in after.values.items()}
        note = f"the first row of {after.where} repeats the last of the file before: taken once"
        return replace(after, clock=clock, values=values, notes=(*after.notes, note))
    if before.clock.time_format == "seconds":
        remedy = "give files whose seconds go on, or time stamps"
    else:
        remedy = "leave one out, or give each as a record of its own"
    raise InputError(
        f"{after.where} begins {ends - begins:g} s before {before.where} ends",
        after.where,
        remedy,
    )
