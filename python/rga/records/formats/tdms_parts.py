"""What the parts say in which a TDMS file was written, and whether their rows belong together.

Source: the layout that National Instruments publishes as "TDMS File Format Internal Structure".
npTDMS, which reads the values, knows of a property only what was said of it last.
"""

import re
import struct
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

from rga.errors import InputError
from rga.records.formats.bounds import most_values

#: scales of a channel, beyond which it was not measured
MOST_SCALES = 100
#: properties that say what the values of a channel mean
_MEANING = re.compile(
    r"wf_start_time|wf_start_offset|wf_increment|NI_Scal.*|NI_Number_Of_Scales|(?i:unit.*)|"
    r"NI_UnitDescription"
)
_SCALES = "NI_Number_Of_Scales"
#: bits of what a part says of itself
_HAS_OBJECTS, _LISTS_ANEW, _BY_ROWS, _OTHER_ORDER, _OF_CARDS = 2, 4, 32, 64, 128
_HEAD = 28
#: where the length of the last part stands, while it is written
_OPEN = 2**64 - 1
#: how values of a channel are told of: none, as before, by an acquisition card
_NO_VALUES, _AS_BEFORE, _CARDS = 2**32 - 1, 0, {0x1269: 20, 0x126A: 17}
_TEXT = 0x20
#: bytes of a property by its type
_LENGTHS = {
    1: 1, 2: 2, 3: 4, 4: 8, 5: 1, 6: 2, 7: 4, 8: 8, 9: 4, 10: 8, 0x19: 4, 0x1A: 8, 0x21: 1,
    0x44: 16,
}  # fmt: skip


class Values(NamedTuple):
    """How many values a channel has in each chunk of a part, and of what type."""

    length: int = 0
    kind: int = 0


@dataclass(frozen=True)
class TdmsPart:
    """What a part of a file says.

    Attributes:
        place: where it begins [bytes].
        flags: what it says of itself.
        rows: of every channel that has some, by its path.
        properties: that are stated here, by path: type and bytes, the least first.
    """

    place: int
    flags: int
    rows: Mapping[str, Values]
    properties: Mapping[str, Mapping[str, tuple[int, bytes]]]


def parts_of(data: bytes) -> Iterator[TdmsPart]:
    """The parts of a file, in their order.

    Raises:
        ValueError: it is damaged, or says that it holds far more than its size lets it.
    """
    place = 0
    rows: dict[str, Values] = {}
    known: dict[str, Values] = {}
    try:
        while place + _HEAD <= len(data):
            mark, flags = struct.unpack_from("<4sI", data, place)
            reader = _Reader(data, place + 12, "big" if flags & _OTHER_ORDER else "little")
            length, begin = reader.number(8), reader.number(8)
            if mark != b"TDSm":
                raise ValueError("a part does not begin as it should")
            if length == _OPEN or place + _HEAD + length > len(data):
                length = len(data) - place - _HEAD
                if begin > length:
                    return  # nothing of this part was written but what it was to be
            properties: dict[str, dict[str, tuple[int, bytes]]] = {}
            if flags & _HAS_OBJECTS:
                rows = {} if flags & _LISTS_ANEW else dict(rows)
                for _ in range(reader.number()):
                    path = reader.text()
                    values = reader.values(known.get(path, Values()))
                    if values is None:
                        rows.pop(path, None)
                    else:
                        rows[path] = known[path] = values
                    stated = {reader.text(): reader.value() for _ in range(reader.number())}
                    properties.setdefault(path, {}).update(stated)
                    if _most_scales(stated) > MOST_SCALES:
                        raise ValueError(f"{path} has more than {MOST_SCALES} scales")
                if max(rows.values(), default=Values()).length > most_values(len(data)):
                    raise ValueError("it says that it has far more values than it has bytes")
            yield TdmsPart(place, flags, rows if begin < length else {}, properties)
            place += _HEAD + length
    except (struct.error, KeyError):
        raise ValueError("its parts do not fit together") from None


@dataclass
class _Reader:
    """Numbers and texts, one after the other."""

    data: bytes
    place: int
    order: Literal["little", "big"]

    def number(self, length: int = 4) -> int:
        return int.from_bytes(self.part(length), self.order)

    def part(self, length: int) -> bytes:
        self.place += length
        if self.place > len(self.data):
            raise struct.error
        return self.data[self.place - length : self.place]

    def text(self) -> str:
        return self.part(self.number()).decode("utf-8", "replace")

    def value(self) -> tuple[int, bytes]:
        kind = self.number()
        if kind == _TEXT:
            return kind, self.part(self.number())
        value = self.part(_LENGTHS[kind])
        return kind, value if self.order == "little" else value[::-1]

    def values(self, before: Values) -> Values | None:
        """Those of a channel; None where it has none in this part.

        Args:
            before: those of the last part that had some.
        """
        told = self.number()
        if told == _NO_VALUES:
            return None
        if told == _AS_BEFORE:
            return before
        kind, _, length = self.number(), self.number(), self.number(8)
        if told in _CARDS:
            self.part(_CARDS[told] * self.number())
            self.part(4 * self.number())
        elif kind == _TEXT:
            self.number(8)
        return Values(length, kind)


def _most_scales(stated: Mapping[str, tuple[int, bytes]]) -> int:
    kind, value = stated.get(_SCALES, (_TEXT, b""))
    return 0 if kind == _TEXT else int.from_bytes(value, "little")


def with_rows_together(data: bytes, parts: Collection[TdmsPart]) -> bytes:
    """The same file, with chunks of one value of each channel as the rows that they are.

    npTDMS reads rows at once, and chunks one by one.
    """
    chunked = [
        part
        for part in parts
        if part.rows
        and not part.flags & _OF_CARDS
        and all(one.length == 1 and one.kind != _TEXT for one in part.rows.values())
    ]
    if not chunked:
        return data  # a large file is not copied for nothing
    copy = bytearray(data)
    for part in chunked:
        copy[part.place + 4 : part.place + 8] = (part.flags | _BY_ROWS).to_bytes(4, "little")
    return bytes(copy)


def check_parts(parts: Collection[TdmsPart], chosen: Mapping[str, str], path: Path) -> None:
    """Refuse channels of as many rows that were not written side by side, or change their meaning.

    Args:
        parts: of the file.
        chosen: what channels are called, by their paths.
        path: the file.

    Raises:
        InputError: one has rows in a part in which another has none, or fewer; its start, step,
            unit or scale is another than that of rows before.
    """
    remedy = "export it as CSV, with the time of every row"
    begun: set[str] = set()
    last: Mapping[str, Values] = {}
    known: dict[tuple[str, str], tuple[int, bytes]] = {}
    for number, part in enumerate(parts, 1):
        for channel, stated in part.properties.items():
            for name, value in stated.items():
                if channel not in chosen or not _MEANING.fullmatch(name):
                    continue
                if known.get((channel, name), value) != value and channel in begun:
                    raise InputError(
                        f"part {number} of the file states another {name} of "
                        f"{chosen[channel]!r} than before",
                        str(path),
                        remedy,
                    )
                known[channel, name] = value
        if part.rows is last:
            continue
        last = part.rows
        rows = {channel: last.get(channel, Values()).length for channel in chosen}
        fewest, most = min(rows, key=rows.__getitem__), max(rows, key=rows.__getitem__)
        if rows[fewest] < rows[most]:
            raise InputError(
                f"part {number} of the file has {rows[fewest]} rows of {chosen[fewest]!r} beside "
                f"{rows[most]} of {chosen[most]!r}: they were not taken at the same times",
                str(path),
                remedy,
            )
        begun.update(channel for channel in chosen if rows[channel])
