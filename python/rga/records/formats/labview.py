"""LabVIEW measurement files (.lvm).

Source: National Instruments, "Specification for the LabVIEW Measurement File (.lvm)": a head of
keys, then segments, each of keys by channel, names and rows.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.formats.blocks import chosen_block
from rga.records.formats.encoding import Text
from rga.records.formats.plain import checked_names
from rga.records.formats.rows import read_rows
from rga.records.mapping import FileMapping
from rga.records.numbers import Notation, notation_of
from rga.records.table import StatedTime, Table

MARK = "LabVIEW Measurement"
_END = "***End_of_Header***"
_SEPARATORS = {"Tab": "\t", "Comma": ",", "Semicolon": ";"}
_X, _COMMENT = "X_Value", "Comment"
#: column of the time, which the keys of a segment give
TIME = "time [s]"
Keys = Mapping[str, Sequence[str]]


@dataclass(frozen=True)
class _Segment:
    """Keys by channel, names, and the lines of the names and below the last row."""

    keys: Keys
    names: tuple[str, ...]
    header: int
    end: int

    @property
    def channels(self) -> list[str]:
        return [name for name in self.names if name and name not in (_X, _COMMENT)]

    def of_channels(self, key: str) -> dict[str, str]:
        """What a key says, by channel; its cells stand above the names."""
        cells = ["", *self.keys.get(key, [])]
        named = zip(self.names, cells, strict=False)
        return {name: cell for name, cell in named if name in self.channels and cell}

    def numbers(self, key: str) -> list[float]:
        """Values of a key for the channels that wrote any samples."""
        samples = self.of_channels("Samples")
        return [
            _number(cell)
            for name, cell in self.of_channels(key).items()
            if _number(samples.get(name, "1")) > 0
        ]


def read_labview(text: Text, mapping: FileMapping) -> Table:
    """Read an .lvm file; segments with the same channels follow each other in time.

    Raises:
        InputError: its head does not end, or a row does not fit it.
    """
    lines = text.lines()
    separator = "\t" if "\t" in "".join(lines[1:4]) else ","
    head, below = _keys(lines, 0, separator, text)
    separator = _SEPARATORS.get(_first(head, "Separator"), separator)
    decimal = mapping.decimal or _first(head, "Decimal_Separator") or None
    segments = _segments(lines, below, separator, text)
    notes: list[str] = []
    if mapping.block is not None or len({one.names for one in segments}) > 1:
        said = [f"{len(one.channels)} channels from line {one.header + 2} on" for one in segments]
        chosen, notes = chosen_block(segments, said, mapping.block, text.path)
        segments = [chosen]
    starts = [_start(head, one, text) for one in segments]
    tables = [_rows(text, lines, one, separator) for one in segments]
    cells = (cell for table in tables for column in table for cell in column.head(99).drop_nulls())
    notation = notation_of(cells, decimal, mapping.thousands)
    frames, warnings = [], list(text.warnings)
    for segment, start, frame in zip(segments, starts, tables, strict=True):
        since = (start - starts[0]).total_seconds() if start and starts[0] else 0.0
        time = since + _elapsed(text, segment, frame, notation)
        frames.append(frame.select(segment.channels + [c for c in frame.columns if c == _COMMENT])
                      .insert_column(0, pl.Series(TIME, time)))  # fmt: skip
        warnings += _doubts(segment, frame.height)
    first = segments[0]
    units = first.of_channels("Y_Unit_Label")
    notes += [] if units else ["the file states no units"]
    if said_in_file := " ".join(first.keys.get("Notes", [])).strip():
        notes.append(f"a note in the file: {said_in_file}")
    return Table(
        path=text.path,
        frame=pl.concat(frames, how="vertical"),
        row_name="line",
        first=first.header + 2,
        format="LabVIEW text (.lvm)",
        units=units,
        time=StatedTime((TIME,), start=starts[0].isoformat() if starts[0] else None),
        bookkeeping=(_COMMENT,),
        notation=notation,
        notes=(*text.notes, *notes),
        warnings=tuple(warnings),
    )


def _keys(lines: Sequence[str], first: int, separator: str, text: Text) -> tuple[Keys, int]:
    """Keys and their values up to the end of a head, and the line below it."""
    keys: dict[str, list[str]] = {}
    for number in range(first, len(lines)):
        cells = [cell.strip() for cell in lines[number].split(separator)]
        if cells[0].startswith(_END):
            return keys, number + 1
        if cells[0]:
            keys[cells[0]] = cells[1:]
    raise InputError(
        f"the head does not end with {_END}", str(text.path), "copy the file again in full"
    )


def _first(keys: Keys, key: str) -> str:
    return next(iter(keys.get(key, [])), "")


def _segments(lines: Sequence[str], below: int, separator: str, text: Text) -> list[_Segment]:
    """Segments below the head of the file; a blank line or the next head ends one."""
    headed = any(line.startswith(_END) for line in lines[below:])
    segments: list[_Segment] = []
    place = below
    while (place := _filled(lines, place)) < len(lines):
        keys: Keys = {}
        if headed:
            keys, place = _keys(lines, place, separator, text)
        if place >= len(lines):
            break
        names = tuple(name.strip() for name in lines[place].split(separator))
        end = place + 1
        while end < len(lines) and lines[end].strip() and not _is_head(lines[end], separator):
            end += 1
        segments.append(_Segment(keys, names, place, end))
        place = end
    if not segments:
        raise InputError("there are no rows below the head", str(text.path), "give at least one")
    return segments


def _filled(lines: Sequence[str], place: int) -> int:
    while place < len(lines) and not lines[place].strip():
        place += 1
    return place


def _is_head(line: str, separator: str) -> bool:
    return line.startswith((f"Channels{separator}", f"Notes{separator}", _END))


def _rows(text: Text, lines: Sequence[str], segment: _Segment, separator: str) -> pl.DataFrame:
    # Every channel may have an X_Value of its own.
    names = [f"{_X} {n}" if name == _X and n else name for n, name in enumerate(segment.names)]
    names = checked_names(names, text, segment.header)
    body = "\n".join(lines[segment.header + 1 : segment.end]).encode()
    place = segment.header + 1
    frame, _ = read_rows(body, separator, names, text.path, place, segment.header, ragged=True)
    return frame


def _elapsed(text: Text, segment: _Segment, frame: pl.DataFrame, notation: Notation) -> FloatArray:
    """Time since the start of a segment [s]: its first column, or counted by Delta_X."""
    if _X in frame.columns and frame[_X].is_not_null().all() and frame.height:
        table = Table(text.path, frame, "line", segment.header + 2, notation=notation)
        return table.numbers(_X)
    x0 = next(iter(segment.numbers("X0")), 0.0)
    step = next(iter(segment.numbers("Delta_X")), 1.0)
    return np.asarray(x0 + step * np.arange(frame.height, dtype=float))


def _doubts(segment: _Segment, rows: int) -> list[str]:
    """What does not fit between the keys and the rows, in words."""
    warnings = []
    said = sorted({int(count) for count in segment.numbers("Samples")} - {rows})
    if said:
        counts = " or ".join(map(str, said))
        warnings.append(f"the head says {counts} samples for each channel, {rows} are there")
    if any(
        len(set(segment.numbers(key))) > 1
        for key in (
            "X0",
            "Delta_X",
        )
    ):
        warnings.append("channels have times of their own: those of the first are taken")
    return warnings


def _number(cell: str) -> float:
    try:
        return float(cell.replace(",", "."))
    except ValueError:
        return 0.0


def _start(head: Keys, segment: _Segment, text: Text) -> datetime | None:
    """Start of a segment, else of the file; None where it is not said."""
    stated = ((_first(keys, "Date"), _first(keys, "Time")) for keys in (segment.keys, head))
    day, clock = next(((day, clock) for day, clock in stated if day and clock), ("", ""))
    if not day:
        return None
    whole, _, decimals = clock.replace(",", ".").partition(".")
    written = f"{day} {whole}.{decimals[:6] or '0'}"
    for date in ("%Y/%m/%d", "%d.%m.%Y", "%Y-%m-%d"):
        try:
            return datetime.strptime(written, f"{date} %H:%M:%S.%f")
        except ValueError:
            continue
    raise InputError(
        f"the start {day} {clock} cannot be read", str(text.path), "write it as 2024/01/31"
    )
