"""What has arrived for a twin and was not taken in yet: rows and commands, in a file of its own.

It is a file beside the repository, so that nobody who sends waits for a recalibration: a twin
writes its repository in long transactions, and takes from here what it needs for each.
"""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import (
    Boolean,
    Column,
    Connection,
    Float,
    Integer,
    MetaData,
    Table,
    delete,
    func,
    insert,
    select,
    update,
)

from rga.arrays import FloatArray
from rga.twin.hardware.interface import Packet, Station
from rga.twin.repository.checksum import is_whole, with_checksum
from rga.twin.repository.columns import blob, checksum, large_number, text
from rga.twin.repository.faults import named, whole
from rga.twin.repository.proof import Proof, entries_of
from rga.twin.repository.table_file import TableFile, only_entry, values_of

#: name of the file
INBOX = "inbox.sqlite"
#: a time later than any
LATEST = 1e308

_metadata = MetaData()
# One line: the twin that rows are for.
_twin = Table(
    "twin",
    _metadata,
    text("name"),
    text("model"),
    text("model_sha256"),
    text("settings"),
    large_number("seed"),
    checksum(),
)
# One line: what is mounted, rows that have ever arrived, the time of the last, and whether it is.
_station = Table(
    "station",
    _metadata,
    text("station"),
    Column("rows", Integer, nullable=False),
    Column("last", Float(53), nullable=False),
    Column("ended", Boolean, nullable=False),
    checksum(),
)
_row = Table(
    "row",
    _metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("time", Float(53), nullable=False),
    blob("values"),
    checksum(),
)
_command = Table(
    "command",
    _metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    text("command"),
    checksum(),
)


@dataclass(frozen=True)
class Addressee:
    """The twin that rows are for.

    Attributes:
        name: of it.
        model: as it was given, the text of a model file.
        model_sha256: hash of the file that it was read from.
        settings: of its run, as JSON text.
        seed: of everything random.
    """

    name: str
    model: str
    model_sha256: str
    settings: str
    seed: int


class Inbox(TableFile):
    """The rows and commands that wait for one twin.

    Threads and processes may put in and take out at the same time. What was put in is on the disk
    when the call returns.

    Args:
        directory: of the twin, where its file is or is made.
        read_only: nothing is put in or taken out; the file must be there.

    Raises:
        InputError: the file cannot be written, or is none.
    """

    def __init__(self, directory: Path, *, read_only: bool = False) -> None:
        super().__init__(directory / INBOX, _metadata, read_only=read_only)

    @property
    def addressee(self) -> Addressee | None:
        """The twin that rows are for; None before it is named."""
        known = self._only(_twin)
        return None if known is None else Addressee(**known)

    def name(self, addressee: Addressee) -> Addressee:
        """Name the twin that rows are for, unless one is named already, which it gives then."""
        with self.writing() as connection:
            if connection.execute(select(_twin)).one_or_none() is None:
                connection.execute(insert(_twin).values(**with_checksum(**asdict(addressee))))
        named = self.addressee
        assert named is not None
        return named

    @property
    def station(self) -> Station | None:
        """What is mounted on the structure; None before the first row."""
        known = self._only(_station)
        return None if known is None else Station.from_json(known["station"])

    @property
    def rows(self) -> int:
        """Rows that have ever arrived."""
        known = self._only(_station)
        return 0 if known is None else int(known["rows"])

    @property
    def ended(self) -> bool:
        """Whether no more rows will come."""
        known = self._only(_station)
        return known is not None and bool(known["ended"])

    def put(
        self, station: Station, time: FloatArray, readings: FloatArray, contexts: FloatArray
    ) -> int | None:
        """Keep rows that are later than all before; others were here already.

        Args:
            station: what is mounted; it counts with the first rows.
            time: seconds since the first row of all, float[n], rising.
            readings, contexts: float[n, channels], float[n, measured contexts].

        Returns:
            How many rows were new; None: nothing is kept, for another has named another station
            or the end meanwhile.
        """
        with self.writing() as connection:
            return self.put_within(connection, station, time, readings, contexts)

    def put_within(
        self,
        connection: Connection,
        station: Station,
        time: FloatArray,
        readings: FloatArray,
        contexts: FloatArray,
    ) -> int | None:
        """As `put`, within a transaction that `writing` has begun."""
        found = connection.execute(select(_station)).one_or_none()
        if found is None:
            known: dict[str, Any] = {
                "station": station.to_json(),
                "rows": 0,
                "last": -LATEST,
                "ended": False,
            }
            connection.execute(insert(_station).values(**with_checksum(**known)))
        else:
            known = values_of(_station, found)
        if known["ended"] or known["station"] != station.to_json():
            return None
        new = np.flatnonzero(time > known["last"])
        if not len(new):
            return 0
        first, values = known["rows"], np.column_stack([readings, contexts])[new].astype("<f8")
        rows = [
            with_checksum(number=first + k, time=float(time[one]), values=values[k].tobytes())
            for k, one in enumerate(new)
        ]
        connection.execute(insert(_row), rows)
        known |= {"rows": first + len(new), "last": float(time[new[-1]])}
        connection.execute(update(_station).values(**with_checksum(**known)))
        return len(new)

    def end(self) -> None:
        """No more rows will come."""
        with self.writing() as connection:
            known = values_of(_station, connection.execute(select(_station)).one())
            ended = with_checksum(**known | {"ended": True})
            connection.execute(update(_station).values(**ended))

    def packet(self, station: Station, first: int, rows: int) -> Packet:
        """Of so many rows from a row on, those that are here."""
        c = _row.c
        with self.reading() as connection:
            chosen = (c.number >= first) & (c.number < first + rows)
            found = [
                whole(_row, one)
                for one in connection.execute(select(_row).where(chosen).order_by(c.number))
            ]
        channels, measured = len(station.channels), len(station.measured)
        values = np.array([np.frombuffer(one.values, dtype="<f8") for one in found], dtype=float)
        values = values.reshape(len(found), channels + measured)
        time = np.array([one.time for one in found], dtype=float)
        begun = found[0].number if found else first
        return Packet(begun, time, values[:, :channels], values[:, channels:])

    def check(self) -> Proof:
        """Read all that is in the file, and prove that it is what was put in.

        Raises:
            InputError: it cannot be read at all.
        """
        here = MetaData()
        with self.reading() as connection:
            here.reflect(connection)
        tables = here.sorted_tables
        found = [(table, one) for table in tables for one in entries_of(self.reading, table)]
        damage = [
            f"{named(table, one)} of the inbox is not what was put in"
            for table, one in found
            if not is_whole(one._asdict())
        ]
        return Proof(len(found), tuple(damage))

    def drop(self, rows: int) -> None:
        """Forget the first so many rows that have ever arrived."""
        with self.writing() as connection:
            connection.execute(delete(_row).where(_row.c.number < rows))

    def ask(self, command: str) -> int:
        """Keep a command, and give its number: numbers rise."""
        with self.writing() as connection:
            return self.ask_within(connection, command)

    def ask_within(self, connection: Connection, command: str) -> int:
        """As `ask`, within a transaction that `writing` has begun."""
        number = 1 + int(connection.scalar(select(func.max(_command.c.number))) or 0)
        entry = with_checksum(number=number, command=command)
        connection.execute(insert(_command).values(**entry))
        return number

    def commands(self, after: int) -> list[tuple[int, str]]:
        """Numbers and texts of the commands behind a number, in their order."""
        behind = select(_command).where(_command.c.number > after).order_by(_command.c.number)
        with self.reading() as connection:
            return [
                (one.number, whole(_command, one).command) for one in connection.execute(behind)
            ]

    def _only(self, table: Table) -> dict[str, Any] | None:
        with self.reading() as connection:
            return only_entry(connection, table)
