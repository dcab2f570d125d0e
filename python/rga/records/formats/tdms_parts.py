"""Parts in which a TDMS file was written: whether their rows belong together."""

import re
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rga.errors import InputError

if TYPE_CHECKING:
    from nptdms import TdmsChannel

#: properties that tell when rows were taken
_TIMES = {b"wf_start_time": "starts", b"wf_increment": "steps of time"}
#: bytes of a value by its type: whole numbers, numbers, and a time
_LENGTHS = {1: 1, 2: 2, 3: 4, 4: 8, 5: 1, 6: 2, 7: 4, 8: 8, 9: 4, 10: 8, 0x44: 16}


def rows_of_parts(data: bytes) -> list[dict[tuple[str, str], int]]:
    """Rows of each channel, by its group and name, for each part that a file was written in."""
    from nptdms import TdmsFile

    with TdmsFile.open(BytesIO(data)) as file:
        return [
            {
                (group.name, channel.name): len(channel)
                for group in part.groups()
                for channel in group.channels()
            }
            for part in file.data_chunks()
        ]


def check_parts(
    parts: Sequence[dict[tuple[str, str], int]], chosen: "Sequence[TdmsChannel]", path: Path
) -> None:
    """Refuse channels of as many rows that were not written side by side.

    Raises:
        InputError: one has rows in a part in which another has none, or fewer.
    """
    for number, part in enumerate(parts, 1):
        rows = {(one.group_name, one.name): 0 for one in chosen}
        rows |= {channel: count for channel, count in part.items() if channel in rows}
        fewest, most = min(rows, key=rows.__getitem__), max(rows, key=rows.__getitem__)
        if rows[fewest] < rows[most]:
            raise InputError(
                f"part {number} of the file has {rows[fewest]} rows of {'/'.join(fewest)!r} and "
                f"{rows[most]} of {'/'.join(most)!r}: they were not taken at the same times",
                str(path),
                "export it as CSV, with the time of every row",
            )


def check_restarts(data: bytes, stated: Sequence[Mapping[str, Any]], path: Path) -> None:
    """Refuse waveforms that begin again, or change their step, from one part to the next.

    Args:
        data: the file.
        stated: properties of the file, its groups and its channels, as they are at its end.
        path: the file.

    Raises:
        InputError: more starts or steps are written than there are at its end.
    """
    for key, what in _TIMES.items():
        values = set()
        for found in re.finditer(re.escape(key) + b"(.{4})(.{1,16})", data, re.DOTALL):
            # The type is a number in either order of bytes. The last eight of a start, which it
            # is compared by, are its seconds.
            values.add(found[2][: _LENGTHS.get(max(found[1]), 0)][-8:])
        if len(values) > len({str(one[key.decode()]) for one in stated if key.decode() in one}):
            raise InputError(
                f"parts of the file state other {what} than its last part does",
                str(path),
                "export it as CSV, with the time of every row",
            )
