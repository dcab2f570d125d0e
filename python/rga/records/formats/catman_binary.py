"""Binary files of HBM's catman (.bin).

Source: the layout as public readers and writers of such files describe it (APReader by L. Bohmann,
the structure VB_DB_CHANHEADER): a head, a head for each channel, and the channels one after the
other, each as 8-byte or 4-byte numbers, or as 2-byte ones between its smallest and its largest.
"""

import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.formats.blocks import chosen_block
from rga.records.formats.catman_text import OVERFLOW, TIME
from rga.records.formats.plain import twice
from rga.records.mapping import FileMapping
from rga.records.table import StatedTime, Table

_VERSIONS = range(5010, 5030)
_NOW = datetime(1899, 12, 30)
#: lengths of the extended head, and the place in it of the storage format
_EXTENDED, _STORAGE = 148, 140
#: bytes of a number by storage format
_WIDTHS = {0: 8, 1: 4, 2: 2}
#: channels, above which a head is damaged
_MOST = 10_000
_HARDWARE_TIME = re.compile(r".*hardware time.*|.*Hardwarezeit.*")


@dataclass(frozen=True)
class _Channel:
    name: str
    unit: str
    length: int
    numeric: bool
    start: float
    width: int


class _Bytes:
    """Bytes read one after the other."""

    def __init__(self, data: bytes, place: int = 0) -> None:
        self.data, self.place = data, place

    def number(self, kind: str) -> Any:
        (value,) = struct.unpack_from("<" + kind, self.data, self.place)
        self.place += struct.calcsize("<" + kind)
        return value

    def part(self, length: int) -> bytes:
        if length < 0 or self.place + length > len(self.data):
            raise struct.error
        self.place += length
        return self.data[self.place - length : self.place]

    def text(self, length_kind: str = "h") -> str:
        return self.part(self.number(length_kind)).decode("cp1252", "replace").strip()


def is_catman(data: bytes) -> bool:
    """Whether the first bytes are those of a catman file: its version, and where its data begins.

    >>> is_catman(bytes.fromhex("94130080000000000100")), is_catman(b"time,D1,S1")
    (True, False)
    """
    if len(data) < 10:
        return False
    version, begin, comment = struct.unpack_from("<hih", data)
    return version in _VERSIONS and begin > 8 + 32 * 2 and 0 <= comment < begin


def read_catman_binary(data: bytes, path: Path, mapping: FileMapping) -> Table:
    """Read a catman file: the channels of its first time, unless `block` is stated.

    Raises:
        InputError: it is damaged, cut off, or has no channel of numbers.
    """
    try:
        begin, channels = _heads(_Bytes(data))
        with np.errstate(over="ignore", invalid="ignore"):  # of what is damaged
            values = _values(_Bytes(data, begin), channels)
    except (struct.error, ValueError, OverflowError):
        raise InputError(
            "the catman file ends before its data do, or is damaged",
            str(path),
            "copy it again in full, or export it as ASCII from catman",
        ) from None
    numeric = [k for k, channel in enumerate(channels) if channel.numeric and channel.length > 0]
    groups = _groups([channels[k] for k in numeric])
    if not groups:
        raise InputError("no channel of numbers is in the file", str(path), "give another")
    said = [
        f"{len(group)} channels of {channels[numeric[group[0]]].length} rows" for group in groups
    ]
    group, notes = chosen_block(groups, said, mapping.block, path)
    own = [numeric[k] for k in group]
    names = [channels[k].name for k in own]
    if name := twice(names):
        raise InputError(
            f"the channel {name!r} stands twice", str(path), "give it another name in catman"
        )
    start, more = _start(channels[own[0]], path)
    timed = bool(TIME.fullmatch(names[0]))
    step: float | None = None
    warnings = []
    if not timed:
        step = 1.0
        what = "no channel is the time: rows are counted as seconds"
        warnings.append(f"{what}, unless import.toml has [time] sampling_rate_hz")
    return Table(
        path=path,
        frame=pl.DataFrame({channels[k].name: values[k] for k in own}),
        row_name="row",
        first=1,
        format="catman binary",
        units={channels[k].name: channels[k].unit for k in own if channels[k].unit},
        time=StatedTime(tuple(names[:1]) if timed else (), start=start, step=step),
        bookkeeping=tuple(name for name in names if _HARDWARE_TIME.fullmatch(name)),
        missing=(OVERFLOW,),
        warnings=tuple(warnings),
        notes=(*notes, *more, f"{OVERFLOW} is catman's overflow: missing"),
    )


def _heads(file: _Bytes) -> tuple[int, list[_Channel]]:
    """Where the data begin, and the channels."""
    file.number("h")
    begin = file.number("i")
    file.text()
    for _ in range(32):
        file.text()
    count = file.number("h")
    if not 0 <= count <= _MOST:
        raise ValueError
    file.number("i")
    file.part(4 * count)
    file.number("i")
    return begin, [_head(file) for _ in range(count)]


def _head(file: _Bytes) -> _Channel:
    file.number("h")
    length = file.number("i")
    name, unit = file.text(), file.text()
    file.text()
    kind = file.number("h")
    file.number("h")
    now = file.number("d")
    extended = file.part(file.number("i"))
    start, width = now, 8
    if len(extended) >= _EXTENDED:
        start = struct.unpack_from("<d", extended)[0] or now
        width = _WIDTHS.get(extended[_STORAGE], 8)
    file.part(2)
    file.part(8 * file.number("B"))
    file.part(2)
    file.text()
    file.text("i")
    if length < 0:
        raise ValueError
    return _Channel(name, unit, length, kind == 0, start, width)


def _values(file: _Bytes, channels: Sequence[_Channel]) -> list[FloatArray]:
    found = []
    for channel in channels:
        if not channel.numeric:
            file.part(channel.length * channel.width)
            found.append(np.zeros(0))
        elif channel.width == 2:
            low, high = file.number("d"), file.number("d")
            steps = np.frombuffer(file.part(2 * channel.length), "<u2")
            found.append(low + (high - low) / 32767 * steps)
        else:
            kind = f"<f{channel.width}"
            held = np.frombuffer(file.part(channel.width * channel.length), kind)
            found.append(held.astype(float))
    return found


def _groups(channels: Sequence[_Channel]) -> list[list[int]]:
    """Numbers of the channels of each time: it goes before them, and is as long as they are."""
    number = 0
    marked = []
    for k, channel in enumerate(channels):
        number += bool(TIME.fullmatch(channel.name))
        marked.append((number, channel.length, k))
    return [
        [k for *_, k in group] for _, group in groupby(marked, key=lambda one: (one[0], one[1]))
    ]


def _start(channel: _Channel, path: Path) -> tuple[str | None, list[str]]:
    """The start with its zone: from the test file of the same name, else from the head."""
    notes = []
    start: datetime | None = None
    try:
        start = _NOW + timedelta(seconds=round(channel.start * 86400, 3))
    except (OverflowError, ValueError):
        notes.append("the head has no start: seconds are taken")
    zone = ""
    beside = next((p for end in (".TST", ".tst") if (p := path.with_suffix(end)).is_file()), None)
    if beside is not None:
        said = beside.read_bytes()[: 1 << 16].decode("cp1252", "replace")
        if found := re.search(r"Start time=(\d{4}/\d\d/\d\d \d\d:\d\d:\d\d)", said):
            start = datetime.strptime(found[1], "%Y/%m/%d %H:%M:%S")
        if found := re.search(r"Time zone=.*\(UTC(?:([+-])(\d{1,2}):(\d\d))?\)", said):
            zone = f"{found[1] or '+'}{int(found[2] or 0):02d}:{found[3] or '00'}"
        notes.append(f"start and zone are those of {beside.name}")
    elif start is not None:
        notes.append("the start has no time zone")
    return (start.isoformat() + zone if start is not None else None), notes
