"""A first mapping of loggers' files to the channels of a model."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from os.path import relpath
from pathlib import Path

import numpy as np

from rga.errors import InputError
from rga.model import Model
from rga.records.drafting.doubts import codes_in, gaps_in, readable, still_value
from rga.records.drafting.matching import Match, matches
from rga.records.drafting.toml import key, listed, text
from rga.records.load import load_record
from rga.records.mapping import TimeColumns, mapping_of
from rga.records.read import read_table
from rga.records.table import Table
from rga.records.times import Clock, read_clock

#: days of a spreadsheet between which numbers are taken for dates, 1982 to 2064
_DAYS = (30_000, 60_000)


@dataclass(frozen=True)
class MappingDraft:
    """A first mapping.

    Attributes:
        toml: what `import.toml` is to hold.
        matched: columns that are taken for channels.
        doubts: what a reader should look at, in words.
        fault: why the record is not read by it as it stands; None: it is.
    """

    toml: str
    matched: list[Match]
    doubts: list[str]
    fault: str | None = None


@dataclass
class _Logger:
    """Files with the same columns, which follow each other in time."""

    tables: list[Table]
    clock: Clock | None = None
    time_lines: list[str] = field(default_factory=list)
    time: TimeColumns = field(default_factory=TimeColumns)
    doubts: list[str] = field(default_factory=list)

    @property
    def first(self) -> Table:
        return self.tables[0]

    @property
    def taken(self) -> list[str]:
        """Columns that are no channels."""
        times = self.clock.columns if self.clock else self.time.columns
        return [*self.first.bookkeeping, *times]

    @cached_property
    def empty(self) -> list[str]:
        """Columns without any number."""
        read = {column: readable(self.first, column) for column in self.first.frame.columns}
        return [one for one, values in read.items() if values is None or np.isnan(values).all()]


def draft_mapping(files: Sequence[Path], model: Model, folder: Path) -> MappingDraft:
    """Look at files, and write a first mapping of them.

    Args:
        files: of one logger or of several.
        model: names the sensors and contexts.
        folder: where the mapping is to stand.

    Raises:
        InputError: a file cannot be read.
    """
    known = {*model.sensors, *model.context}
    loggers = _loggers([read_table(path, None, known) for path in files])
    for logger in loggers:
        _look_at_time(logger)
    found = matches(
        [one.first for one in loggers], model, [one.taken + one.empty for one in loggers]
    )
    sensors = [sum(m.group == k and m.name in model.sensors for m in found)
               for k in range(len(loggers))]  # fmt: skip
    main = max(range(len(loggers)), key=lambda k: (sensors[k], loggers[k].first.frame.height))
    lines, doubts = _main_lines(loggers, main, found, model, folder)
    content = "\n".join(lines) + "\n"
    fault = _fault(content, folder, model)
    if fault is not None:
        content = f"# TO FILL IN: as it stands the record is not read: {fault}\n{content}"
    return MappingDraft(content, found, doubts, fault)


def _fault(content: str, folder: Path, model: Model) -> str | None:
    try:
        mapping = mapping_of(content, folder / "import.toml")
        load_record(folder / "import.toml", model, mapping)
    except InputError as error:
        return " ".join(str(error).split())
    return None


def _loggers(tables: Sequence[Table]) -> list[_Logger]:
    loggers: dict[tuple[str, ...], _Logger] = {}
    for table in tables:
        columns = (table.format, *table.frame.columns)
        loggers.setdefault(columns, _Logger([])).tables.append(table)
    return list(loggers.values())


def _look_at_time(logger: _Logger) -> None:
    """The time of a logger's first file, or what is to be filled in."""
    table = logger.first
    try:
        logger.clock = read_clock(table, TimeColumns())
    except InputError as error:
        dated = [c for c in table.frame.columns if _is_days(table, c)]
        if dated:
            logger.time = TimeColumns(columns=dated[:1], format="excel")
            logger.clock = read_clock(table, logger.time)
            logger.time_lines = [
                f"columns = {listed(dated[:1])}",
                'format = "excel"  # numbers like the days of a spreadsheet',
            ]
            logger.doubts.append(f"{dated[0]!r} is taken as day numbers of a spreadsheet")
        else:
            logger.time = TimeColumns(columns=[], sampling_rate_hz=1)
            logger.time_lines = [
                f"# FILL IN: {error.what}",
                '# columns = ["..."]',
                '# format = "%d.%m.%Y %H:%M:%S"  # or sampling_rate_hz = ... to count rows',
            ]
            logger.doubts.append(f"the time: {error.what}")
    clock = logger.clock
    if clock is None:
        return
    if isinstance(clock.start, str) and datetime.fromisoformat(clock.start).tzinfo is None:
        logger.time_lines.append('# zone = "Europe/Berlin"  # the stamps have none: state it')
        logger.doubts.append("the time stamps have no zone")
    if clock.time_format == "seconds":
        logger.doubts.append("the time is counted in seconds, the date is not known")
    if (gap := gaps_in(clock)) is not None:
        logger.doubts.append(gap)


def _is_days(table: Table, column: str) -> bool:
    values = readable(table, column)
    named = table.names.get(column, column).lower()
    dated = any(word in named for word in ("date", "datum", "time", "zeit", "day", "tag"))
    return values is not None and dated and bool(((values > _DAYS[0]) & (values < _DAYS[1])).all())


def _main_lines(
    loggers: Sequence[_Logger], main: int, found: Sequence[Match], model: Model, folder: Path
) -> tuple[list[str], list[str]]:
    """The lines of the mapping, and the doubts."""
    lines = ["# How these files are read: a first guess of `rga import-record`, to be checked."]
    doubts: list[str] = []
    own = [one for one in found if one.group == main]
    lines += _file_lines(loggers[main], own, model, folder, "", doubts)
    matched = {one.name for one in found}
    lacking = [name for name in model.sensors if name not in matched]
    for name in lacking:
        lines.append(f'{key(name)} = "TO CHECK: no column has a name like it"')
        doubts.append(f"no column is like the sensor {name!r}: it is left out")
    doubts += [
        f"no column is like the context {name!r}: it is taken as not measured"
        for name in model.context
        if name not in matched
    ]
    for number, logger in enumerate(loggers):
        if number == main:
            continue
        theirs = [one for one in found if one.group == number]
        names = ", ".join(table.path.name for table in logger.tables)
        if not theirs:
            lines += ["", f"# {names}: no column is like a channel of the model"]
            doubts.append(f"{names}: no column is like a channel of the model")
            continue
        lines += ["", "[[beside]]", *_matching_lines(loggers[main], logger)]
        lines += _file_lines(logger, theirs, model, folder, "beside.", doubts)
    return lines, doubts


def _matching_lines(main: _Logger, other: _Logger) -> list[str]:
    """How the rows of another logger are matched."""
    steps = [
        float(np.median(np.diff(one.clock.seconds)))
        if one.clock is not None and len(one.clock.seconds) > 1
        else 0.0
        for one in (main, other)
    ]
    rates = f"# a row each {steps[1]:g} s, and each {steps[0]:g} s in the files above"
    way = "mean" if steps[1] < steps[0] else ("interpolate" if steps[1] > steps[0] else "nearest")
    return [f'match = "{way}"  {rates}; "nearest", "interpolate" or "mean"']


def _file_lines(
    logger: _Logger,
    found: Sequence[Match],
    model: Model,
    folder: Path,
    prefix: str,
    doubts: list[str],
) -> list[str]:
    """Keys of one logger; the lines end within its table of unused channels."""
    table = logger.first
    names = [Path(relpath(one.path, folder)).as_posix() for one in logger.tables]
    said = ", ".join(Path(name).name for name in names)
    lines = [f"files = {listed(names)}"]
    lines += [f"# {table.format}: {note}" for note in (*table.notes, *table.warnings)]
    where = "" if not prefix else f"{said}: "
    doubts += [f"{where}{doubt}" for doubt in (*table.warnings, *logger.doubts)]
    lines += _missing_lines(logger, doubts, where)
    if logger.clock is not None and logger.clock.columns:
        lines += [f"# {note}" for note in logger.clock.notes]
    if logger.time_lines:
        lines += ["", f"[{prefix}time]", *logger.time_lines]
    lines += ["", f"[{prefix}channels]"]
    for match in found:
        lines.append(_channel_line(match, table, model, doubts))
    columns = {one.column for one in found}
    left = [c for c in table.frame.columns if c not in columns and c not in logger.taken]
    lines += ["", f"[{prefix}unused]"]
    for column in left:
        lines.append(f"{key(column)} = {text(_reason(table, column))}")
        doubts.append(f"{where}column {column!r} is left out: {_reason(table, column)}")
    return lines


def _channel_line(match: Match, table: Table, model: Model, doubts: list[str]) -> str:
    parts = [f"column = {text(match.column)}"]
    unit = table.units.get(match.column)
    sensor = model.sensors.get(match.name)
    wanted = sensor.unit if sensor else model.context[match.name].unit
    if unit is None:
        said = f"no unit is stated: {wanted} is taken"
        parts.append(f"unit = {text(wanted)}")
        doubts.append(f"{match.name}: {said}, as in the model")
    else:
        said = f"in {unit}" if unit == wanted else f"in {unit}, converted to {wanted}"
    if match.likeness < 1:
        doubts.append(f"{match.name} is taken from {match.column!r} ({match.why})")
    values = readable(table, match.column)
    if values is not None and (still := still_value(values)) is not None:
        doubts.append(f"{match.name} reads {still:g} throughout: does it work?")
    return f"{key(match.name)} = {{ {', '.join(parts)} }}  # {match.why}, {said}"


def _reason(table: Table, column: str) -> str:
    values = readable(table, column)
    if values is None:
        return "TO CHECK: it holds text or times, no numbers"
    if np.isnan(values).all():
        return "it holds no value"
    still = still_value(values)
    if still is not None:
        return f"TO CHECK: it reads {still:g} throughout"
    return "TO CHECK: no channel of the model has a name like it"


def _missing_lines(logger: _Logger, doubts: list[str], where: str) -> list[str]:
    codes: dict[float, list[str]] = {}
    for table in logger.tables:
        for column in table.frame.columns:
            values = readable(table, column) if column not in logger.taken else None
            if values is not None:
                for code, rows in codes_in(values).items():
                    place = f"{rows} rows of {column} in {table.path.name}"
                    codes.setdefault(code, []).append(place)
    if not codes:
        return []
    for code, places in codes.items():
        doubts.append(f"{where}{code:g} stands in {', '.join(places[:5])}: is it a missing value?")
    stated = listed([f"{code:g}" for code in codes])
    return [
        f"# missing = {stated}  # far from all else: take the # away if they are missing values"
    ]
