"""The length of the rows that a twin was begun with: its calibration is about such rows."""

from sqlalchemy import inspect

from rga.errors import InputError
from rga.operation.inbox import tables
from rga.operation.packets.packet import MICROSECONDS
from rga.operation.settings_types import in_words
from rga.twin.hardware.inbox import Inbox
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import only_entry, put


def keep_length(inbox: Inbox, every: int, where: str) -> None:
    """Keep the length of rows [µs], unless it is known.

    Args:
        inbox: of the twin.
        every: length of a row, as it is stated.
        where: it is kept, for an error.

    Raises:
        InputError: rows of another length are kept, or nothing can be written.
    """
    check_length(inbox, every, where)
    with inbox.writing() as connection:
        if only_entry(connection, tables.length) is None:
            put(connection, tables.length, [with_checksum(every=every)])


def check_length(inbox: Inbox, every: int, where: str) -> None:
    """Whether the rows that are kept, if there are any, are as long as those that are stated.

    Raises:
        InputError: they are not, or the inbox cannot be read.
    """
    with inbox.reading() as connection:
        known = None
        if inspect(connection).has_table(tables.length.name):
            known = only_entry(connection, tables.length)
    if known is not None and known["every"] != every:
        length, stated = (in_words(one / MICROSECONDS) for one in (known["every"], every))
        raise InputError(
            f"a live twin of rows of {length} is here, and rows.every is {stated}",
            where,
            f"state rows of {length}, or take another directory: it is calibrated on such rows",
        )
