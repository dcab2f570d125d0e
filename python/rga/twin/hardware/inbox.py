"""What has arrived for a twin and was not taken in yet: rows and commands, in a file of its own.

It is a file beside the repository, so that nobody who sends waits for a recalibration: a twin
writes its repository in long transactions, and takes from here what it needs for each.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from sqlalchemy import (
    BigInteger,
    Boolean,
    Column,
    Connection,
    Float,
    Integer,
    LargeBinary,
    MetaData,
    Table,
    Text,
    delete,
    func,
    insert,
    select,
    update,
)

from rga.arrays import FloatArray
from rga.twin.hardware.interface import Packet, Station
from rga.twin.repository.faults import as_input_errors
from rga.twin.repository.sqlite import SQLite

#: name of the file
INBOX = "inbox.sqlite"

_metadata = MetaData()
# One line: the twin that rows are for.
_twin = Table(
    "twin",
    _metadata,
    Column("name", Text, nullable=False),
    Column("model", Text, nullable=False),
    Column("model_sha256", Text, nullable=False),
    Column("settings", Text, nullable=False),
    Column("seed", BigInteger, nullable=False),
)
# One line: what is mounted, rows that have ever arrived, the time of the last, and whether it is.
_station = Table(
    "station",
    _metadata,
    Column("station", Text, nullable=False),
    Column("rows", Integer, nullable=False),
    Column("last", Float(53), nullable=False),
    Column("ended", Boolean, nullable=False),
)
_row = Table(
    "row",
    _metadata,
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("time", Float(53), nullable=False),
    Column("values", LargeBinary, nullable=False),
)
_command = Table(
    "command",
    _metadata,
    Column("number", Integer, primary_key=True, autoincrement=True),
    Column("command", Text, nullable=False),
    sqlite_autoincrement=True,
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


class Inbox:
    """The rows and commands that wait for one twin.

    Threads and processes may put in and take out at the same time. What was put in is on the disk
    when the call returns.

    Args:
        directory: of the twin, where its file is or is made.

    Raises:
        InputError: the file cannot be written, or is none.
    """

    def __init__(self, directory: Path) -> None:
        self._database = SQLite(directory / INBOX, read_only=False)
        with self._writing() as connection:
            _metadata.create_all(connection)

    def close(self) -> None:
        """Close the file; it opens again where it is asked more."""
        self._database.engine.dispose()

    @property
    def addressee(self) -> Addressee | None:
        """The twin that rows are for; None before it is named."""
        with self._reading() as connection:
            known = connection.execute(select(_twin)).one_or_none()
        return None if known is None else Addressee(**known._mapping)

    def name(self, addressee: Addressee) -> Addressee:
        """Name the twin that rows are for, unless one is named already, which it gives then."""
        with self._writing() as connection:
            if connection.execute(select(_twin)).one_or_none() is None:
                connection.execute(insert(_twin).values(**asdict(addressee)))
        named = self.addressee
        assert named is not None
        return named

    @property
    def station(self) -> Station | None:
        """What is mounted on the structure; None before the first row."""
        with self._reading() as connection:
            text = connection.scalar(select(_station.c.station))
        return None if text is None else Station.from_json(text)

    @property
    def rows(self) -> int:
        """Rows that have ever arrived."""
        with self._reading() as connection:
            return connection.scalar(select(_station.c.rows)) or 0

    @property
    def ended(self) -> bool:
        """Whether no more rows will come."""
        with self._reading() as connection:
            return bool(connection.scalar(select(_station.c.ended)))

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
        with self._writing() as connection:
            known = connection.execute(select(_station)).one_or_none()
            if known is None:
                first, last = 0, -np.inf
                connection.execute(
                    insert(_station).values(
                        station=station.to_json(), rows=0, last=0.0, ended=False
                    )
                )
            else:
                if known.ended or known.station != station.to_json():
                    return None
                first, last = known.rows, known.last
            new = np.flatnonzero(time > last)
            if not len(new):
                return 0
            values = np.column_stack([readings, contexts])[new].astype("<f8")
            rows = [
                {"number": first + k, "time": float(time[one]), "values": values[k].tobytes()}
                for k, one in enumerate(new)
            ]
            connection.execute(insert(_row), rows)
            connection.execute(
                update(_station).values(rows=first + len(new), last=float(time[new[-1]]))
            )
        return len(new)

    def end(self) -> None:
        """No more rows will come."""
        with self._writing() as connection:
            connection.execute(update(_station).values(ended=True))

    def packet(self, station: Station, first: int, rows: int) -> Packet:
        """Of so many rows from a row on, those that are here."""
        c = _row.c
        with self._reading() as connection:
            chosen = (c.number >= first) & (c.number < first + rows)
            found = connection.execute(select(_row).where(chosen).order_by(c.number)).all()
        channels, measured = len(station.channels), len(station.measured)
        values = np.array([np.frombuffer(one.values, dtype="<f8") for one in found], dtype=float)
        values = values.reshape(len(found), channels + measured)
        time = np.array([one.time for one in found], dtype=float)
        begun = found[0].number if found else first
        return Packet(begun, time, values[:, :channels], values[:, channels:])

    def drop(self, rows: int) -> None:
        """Forget the first so many rows that have ever arrived."""
        with self._writing() as connection:
            connection.execute(delete(_row).where(_row.c.number < rows))

    def ask(self, command: str) -> int:
        """Keep a command, and give its number: numbers rise."""
        with self._writing() as connection:
            connection.execute(insert(_command).values(command=command))
            return int(connection.scalar(select(func.max(_command.c.number))) or 0)

    def commands(self, after: int) -> list[tuple[int, str]]:
        """Numbers and texts of the commands behind a number, in their order."""
        behind = select(_command).where(_command.c.number > after).order_by(_command.c.number)
        with self._reading() as connection:
            return [(one.number, one.command) for one in connection.execute(behind)]

    @contextmanager
    def _reading(self) -> Iterator[Connection]:
        with as_input_errors(self._database.where), self._database.engine.begin() as connection:
            yield connection

    @contextmanager
    def _writing(self) -> Iterator[Connection]:
        with self._reading() as connection:
            # Whoever reads before writing is refused when another has written meanwhile.
            connection.exec_driver_sql("PRAGMA user_version = 1")
            yield connection
