"""Proof that a repository holds what was written, or what of it is damaged."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Any

from sqlalchemy import Connection, Row, Table, select

from rga.twin.repository import tables
from rga.twin.repository.checksum import is_whole
from rga.twin.repository.faults import Damaged, named

Reading = Callable[[], AbstractContextManager[Connection]]
#: entries that are loaded at a time
BATCH = 64


@dataclass(frozen=True)
class Proof:
    """What was looked at.

    Attributes:
        entries: of all tables that could be read.
        damage: what is not as it was written, in words; empty: all is.
    """

    entries: int
    damage: tuple[str, ...]


def prove(reading: Reading) -> Proof:
    """Read every entry, and compare it with its checksum and its neighbours.

    Args:
        reading: opens a transaction to read in.
    """
    damage: list[str] = []
    reached: dict[int, int] = {}
    rows: dict[int, int] = {}
    count = 0
    for table in tables.OF_A_RUN:
        try:
            for entry in entries_of(reading, table):
                count += 1
                if not is_whole(entry._asdict()):
                    damage.append(f"{named(table, entry)} is not what was written")
                elif table is tables.step:
                    damage += _missing("step", reached, entry.run_id, entry.number, 1)
                elif table is tables.measured:
                    damage += _missing("row", rows, entry.run_id, entry.first_row, entry.length)
                elif "step" in table.c and entry.step >= reached.get(entry.run_id, 1):
                    damage.append(f"{named(table, entry)} is of a step that is missing")
        except Damaged as error:
            damage.append(f"{table.name} cannot be read: {error.what}")
    return Proof(count, tuple(damage))


def entries_of(reading: Reading, table: Table) -> Iterator[Row[Any]]:
    """All entries of a table, in the order of their keys, a few at a time.

    Raises:
        InputError: they cannot be read.
    """
    order = list(table.primary_key)
    statement = select(table).order_by(*order).execution_options(yield_per=BATCH)
    with reading() as connection:
        yield from connection.execute(statement)


def _missing(
    what: str, reached: dict[int, int], run: int, begun: int, length: int
) -> Iterator[str]:
    """What lies between the last of a run and one that begins somewhere, if anything does."""
    wanted = reached.get(run, 1 if what == "step" else 0)
    if begun > wanted:
        yield f"{what}s {wanted} to {begun - 1} of run {run} are missing"
    reached[run] = max(wanted, begun + length)
