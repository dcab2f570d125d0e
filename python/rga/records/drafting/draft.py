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
from rga.quantities import counted
from rga.records.channels import quoted
from rga.records.drafting.candidates import candidate_lines
from rga.records.drafting.doubts import codes_in, gaps_in, readable, still_value
from rga.records.drafting.matching import Match, matches
from rga.records.drafting.told import Doubts
from rga.records.drafting.toml import key, listed, text
from rga.records.load import load_record
from rga.records.mapping import TO_CHECK, TimeColumns, mapping_of
from rga.records.read import read_table
from rga.records.table import Table
from rga.records.times import Clock, read_clock

#: days of a spreadsheet between which numbers are taken for dates, 1982 to 2064
_DAYS = (30_000, 60_000)
#: likeness from which a match is no doubt: the same name, or the same place and kind
SURE = 0.9


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
    def name(self) -> str:
        """The names of its files."""
        names = [table.path.name for table in self.tables]
        return ", ".join(names) if len(names) < 4 else f"{names[0]} .. {names[-1]}"

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
        InputError: a file cannot be read, or no column of any holds a number.
    """
    known = {*model.sensors, *model.context}
    loggers = _loggers([read_table(path, None, known) for path in files])
    for logger in loggers:
        _look_at_time(logger)
    _some_numbers(loggers)
    found, unsure = matches(
        [one.first for one in loggers], model, [one.taken + one.empty for one in loggers]
    )
    sensors = [sum(m.group == k and m.name in model.sensors for m in found)
               for k in range(len(loggers))]  # fmt: skip
    main = max(range(len(loggers)), key=lambda k: (sensors[k], loggers[k].first.frame.height))
    doubts = Doubts()
    lines = _all_lines(loggers, main, found, model, folder, doubts)
    for doubt in unsure:
        doubts.add(doubt)
    content = "\n".join(lines) + "\n"
    fault = _fault(content, folder, model)
    if fault is not None:
        content = f"# TO FILL IN: as it stands the record is not read: {fault}\n{content}"
    return MappingDraft(content, found, doubts.told(), fault)


def _some_numbers(loggers: Sequence[_Logger]) -> None:
    """See that some column may be a channel."""
    if any({*one.first.frame.columns} - {*one.taken, *one.empty} for one in loggers):
        return
    frame = loggers[0].first.frame
    rows, names = counted(frame.height, "row"), quoted(frame.columns)
    raise InputError(
        f"no column beside the time holds a number: {rows} were read of the columns {names}",
        ", ".join(one.name for one in loggers),
        "give a logger's file with readings; where columns or rows are found wrongly, write "
        "delimiter, header_line and data_line into an import.toml",
    )


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
        logger.time_lines.append(
            '# zone = "+01:00"  # the stamps have none: hours ahead of UTC, or a place such as '
            '"Europe/Berlin" if the clock changes to summer time there'
        )
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


def _all_lines(
    loggers: Sequence[_Logger],
    main: int,
    found: Sequence[Match],
    model: Model,
    folder: Path,
    doubts: Doubts,
) -> list[str]:
    """The lines of the mapping."""
    lines = ["# How these files are read: a first guess of `rga import-record`, to be checked."]
    matched = {one.name for one in found}
    lacking = [name for name in model.sensors if name not in matched]
    contexts = [name for name in model.context if name not in matched]
    for match in found:
        if match.likeness < SURE:
            one = f"{{}} ({match.why})"
            said = f"{match.name} is taken from {match.column!r}"
            doubts.add(one, one, said)
    order = [main, *(number for number in range(len(loggers)) if number != main)]
    for number in order:
        logger = loggers[number]
        theirs = [one for one in found if one.group == number]
        prefix = "" if number == main else "beside."
        where = logger.name if len(loggers) > 1 else ""
        if number != main:
            lines += ["", "[[beside]]", *_matching_lines(loggers[main], logger)]
        if not theirs:
            doubts.add("no column is like a channel: its lines are remarks", where=logger.name)
        open_ones = [*lacking, *contexts]
        lines += _file_lines(logger, theirs, open_ones, model, folder, prefix, doubts, where)
        if number == main:
            lines += [f'{key(name)} = "{TO_CHECK}: no column has a name like it"'
                      for name in lacking]  # fmt: skip
    for name in lacking:
        doubts.add(
            "no column is like the sensor {}: it is left out",
            "no columns are like the sensors {}: they are left out",
            repr(name),
        )
    for name in contexts:
        doubts.add(
            "no column is like the context {}: it is taken as not measured",
            "no columns are like the contexts {}: they are taken as not measured",
            repr(name),
        )
    return lines


def _matching_lines(main: _Logger, other: _Logger) -> list[str]:
    """How the rows of another logger are matched."""
    steps = [
        float(np.median(np.diff(one.clock.seconds)))
        if one.clock is not None and len(one.clock.seconds) > 1
        else 0.0
        for one in (main, other)
    ]
    rates = f"a row each {steps[1]:g} s, and each {steps[0]:g} s in the files above"
    if steps[0] == steps[1]:
        return [f'match = "nearest"  # {rates}; or "interpolate", "mean"']
    why = 'its value at the time of a row; "mean" where the files above hold means themselves'
    return [f'match = "interpolate"  # {why}; {rates}']


def _file_lines(
    logger: _Logger,
    found: Sequence[Match],
    lacking: Sequence[str],
    model: Model,
    folder: Path,
    prefix: str,
    doubts: Doubts,
    where: str,
) -> list[str]:
    """Keys of one logger; the lines end within its table of unused channels."""
    table = logger.first
    names = [Path(relpath(one.path, folder)).as_posix() for one in logger.tables]
    lines = [f"files = {listed(names)}"]
    lines += [f"# {table.format}: {note}" for note in (*table.notes, *table.warnings)]
    for doubt in (*table.warnings, *logger.doubts):
        doubts.add(doubt, where=where)
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
    if not found:
        lines += candidate_lines(table, left, lacking, model)
    lines += ["", f"[{prefix}unused]"]
    for column in left:
        reason = _reason(table, column)
        lines.append(f"{key(column)} = {text(reason)}")
        doubts.add(
            f"column {{}} is left out: {reason}",
            f"columns {{}} are left out: {reason}",
            repr(column),
            where,
        )
    return lines


def _channel_line(match: Match, table: Table, model: Model, doubts: Doubts) -> str:
    parts = [f"column = {text(match.column)}"]
    unit = table.units.get(match.column)
    sensor = model.sensors.get(match.name)
    wanted = sensor.unit if sensor else model.context[match.name].unit
    if unit is None:
        said = f"no unit is stated: {wanted} is taken"
        parts.append(f"unit = {text(wanted)}")
        stated = "no unit is stated for {}: the model's is taken"
        doubts.add(stated, stated, f"{match.name} ({wanted})")
    else:
        said = f"in {unit}" if unit == wanted else f"in {unit}, converted to {wanted}"
        said = said.removeprefix(f"in {unit}, ") if match.why.endswith(f"in {unit}") else said
    values = readable(table, match.column)
    if values is not None and (still := still_value(values)) is not None:
        doubts.add(
            f"{{}} reads {still:g} throughout: does it work?",
            f"{{}} read {still:g} throughout: do they work?",
            match.name,
        )
    return f"{key(match.name)} = {{ {', '.join(parts)} }}  # {match.why}, {said}"


def _reason(table: Table, column: str) -> str:
    values = readable(table, column)
    if values is None:
        return f"{TO_CHECK}: it holds text or times, no numbers"
    if np.isnan(values).all():
        return "it holds no value"
    still = still_value(values)
    if still is not None:
        return f"{TO_CHECK}: it reads {still:g} throughout"
    return f"{TO_CHECK}: no channel of the model has a name like it"


def _missing_lines(logger: _Logger, doubts: Doubts, where: str) -> list[str]:
    codes: dict[float, dict[str, int]] = {}
    for table in logger.tables:
        for column in table.frame.columns:
            values = readable(table, column) if column not in logger.taken else None
            for code, rows in (codes_in(values) if values is not None else {}).items():
                of_code = codes.setdefault(code, {})
                of_code[column] = of_code.get(column, 0) + rows
    if not codes:
        return []
    for code, columns in codes.items():
        shown = ", ".join(
            f"{column} ({counted(rows, 'row')})" for column, rows in list(columns.items())[:5]
        )
        more = f" and {len(columns) - 5} more columns" if len(columns) > 5 else ""
        doubts.add(f"{code:g} stands in {shown}{more}: is it a missing value?", where=where)
    stated = listed([f"{code:g}" for code in codes])
    return [
        f"# missing = {stated}  # far from all else: take the # away if they are missing values"
    ]
