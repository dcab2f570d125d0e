"""A row of values without the names of its columns, which are stated once for all."""

import csv
import io
from collections.abc import Sequence
from datetime import timedelta

from rga.errors import InputError
from rga.operation.packets.packet import EPOCH
from rga.operation.packets.readings import check_size

_DELIMITERS = (",", ";", "\t")


def file_of_row(
    payload: bytes,
    where: str,
    arrived: int,
    columns: Sequence[str],
    times: Sequence[str],
    delimiter: str | None,
    decimal: str | None = None,
) -> tuple[bytes, bool]:
    r"""A file of the rows, with the names of their columns above them.

    Args:
        payload: a row, or several.
        where: it came from, for an error.
        arrived: their time where no column has it, microseconds since 1970 (UTC).
        columns: their names.
        times: names of those that hold the time.
        delimiter: between the values; None: found.
        decimal: sign of numbers; None: found.

    Returns:
        The file, and whether the time is the logger's.

    Raises:
        InputError: the rows do not have the columns.

    >>> file_of_row(b"1.5;2.5", "a test", 0, ["D1", "D2"], ["time"], None)
    (b'time;D1;D2\n1970-01-01T00:00:00+00:00;1.5;2.5\n', False)
    """
    check_size(payload, where)
    text = payload.decode("utf-8", "replace").strip("\r\n")
    lines = text.splitlines()
    signs = [one for one in _DELIMITERS if one != decimal] if delimiter is None else [delimiter]
    for sign in signs:
        rows = list(csv.reader(lines, delimiter=sign))
        if rows and all(len(row) == len(columns) for row in rows):
            break
    else:
        raise InputError(
            f"a row has not the {len(columns)} columns that are stated",
            where,
            "state columns of the source as the logger sends them",
        )
    names, timed = list(columns), bool(set(times) & set(columns))
    if not timed:
        if len(rows) > 1:
            raise InputError(
                f"{len(rows)} rows have no times", where, "send one row, or a column of the time"
            )
        now = (EPOCH + timedelta(microseconds=arrived)).isoformat()
        names, rows = [times[0] if times else "time", *names], [[now, *row] for row in rows]
    file = io.StringIO()
    csv.writer(file, delimiter=sign, lineterminator="\n").writerows([names, *rows])
    return file.getvalue().encode(), timed
