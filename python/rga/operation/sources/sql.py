"""A table that somebody else writes to: its new rows, and those that become visible late.

Rows are found by a column that rises. A row whose transaction ends late becomes visible behind
others that are higher, so whoever reads on from the highest never sees it. On PostgreSQL the
place to read on from stays where it is until every transaction is over that was under way when
it was passed; everywhere, rows are looked for again a little behind it, and taken once.
"""

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from datetime import datetime
from decimal import Decimal
from pathlib import Path
from threading import Event
from typing import Any

from sqlalchemy import (
    Column,
    Connection,
    Float,
    Integer,
    MetaData,
    Numeric,
    Table,
    create_engine,
    select,
)
from sqlalchemy import text as statement
from sqlalchemy.engine import RowMapping, make_url
from sqlalchemy.exc import NoSuchModuleError, NoSuchTableError, SQLAlchemyError

from rga.errors import InputError
from rga.operation.packets.moments import moment_of_number, moment_of_stamp
from rga.operation.packets.readings import LONGEST_NAME, SensorReading
from rga.operation.sources.secrets import password_of
from rga.operation.sources.settings import SqlSource
from rga.operation.sources.source import Inlet
from rga.operation.sources.table_place import Position, TablePlace, behind, mark_of
from rga.operation.sources.written import payloads_of
from rga.records.record import LARGEST
from rga.records.times.zone import zone_of

#: rows that are kept together
MOST_ROWS = 5_000
#: rows behind the place to read on from, beyond which its transactions are waited for
MOST_WAITING = 200_000
#: the only part of the cursor
_PART = "table"
_SNAPSHOT = statement(
    "SELECT pg_snapshot_xmin(one)::text AS oldest, pg_snapshot_xmax(one)::text AS next "
    "FROM pg_current_snapshot() AS one"
)


class SqlTable:
    """A table that is looked at again and again.

    Args:
        settings: of the source.
        zone: of times without one, as import.toml says it.

    Raises:
        InputError: the password or the driver is missing, or there is no such zone.
    """

    def __init__(self, settings: SqlSource, zone: str | None) -> None:
        url = make_url(settings.url)
        if settings.password is not None:
            url = url.set(password=password_of(settings.password))
        if url.drivername == "postgresql":
            url = url.set(drivername="postgresql+psycopg")
        self._where = f"{settings.table} of {url.render_as_string(hide_password=True)}"
        self._settings = settings
        self._zone = None if zone is None else zone_of(zone, self._where)
        try:
            self._engine = create_engine(url, pool_pre_ping=True)
        except (NoSuchModuleError, ModuleNotFoundError) as error:
            raise InputError(
                f"its driver is missing: {error}", self._where, "install it beside rga"
            ) from None
        self._table: Table | None = None
        self._unread = 0

    def look(self, inlet: Inlet, ending: Event) -> str | None:
        """Give new rows to an inlet; what is wrong with the table, in words.

        Raises:
            InputError: the database is away, or the table is not as it is stated to be.
        """
        self._unread = 0
        place = TablePlace.from_json(inlet.cursor().get(_PART))
        while not ending.is_set():
            with self._connected() as connection:
                rows, moved, more = self._new_rows(connection, place)
            points = [point for row in rows for point in self._points_of(row)]
            payloads = payloads_of(points, self._where)
            if moved != place:
                placed = [(self._settings.table, one) for one in payloads]
                inlet.receive(placed, {_PART: moved.to_json()})
            if more and not rows:
                return "a transaction has been open for long: rows wait until it is over"
            place = moved
            if not more:
                break
        return f"{self._unread} rows have no time that can be read" if self._unread else None

    @contextmanager
    def _connected(self) -> Iterator[Connection]:
        """A transaction that sees one state of the database, and changes nothing."""
        self._check_is_there()
        options: dict[str, Any] = {}
        if self._is_postgresql:
            options = {"isolation_level": "REPEATABLE READ", "postgresql_readonly": True}
        try:
            with self._engine.connect().execution_options(**options) as connection:
                yield connection
        except NoSuchTableError:
            raise InputError(
                "there is no such table", self._where, "correct table, or what its user may read"
            ) from None
        except SQLAlchemyError as error:
            self._table = None
            said = str(getattr(error, "orig", None) or error).strip().splitlines()
            raise InputError(
                f"the database says: {said[0] if said else type(error).__name__}",
                self._where,
                "it is tried again",
            ) from None

    def _check_is_there(self) -> None:
        """Whether there is a file, where the database is one: it would be made else.

        Raises:
            InputError: there is none.
        """
        url = self._engine.url
        is_file = url.get_backend_name() == "sqlite" and url.database not in (None, "", ":memory:")
        if is_file and not Path(str(url.database)).is_file():
            raise InputError("there is no such file", self._where, "correct url; it is tried again")

    @property
    def _is_postgresql(self) -> bool:
        return self._engine.dialect.name == "postgresql"

    def _new_rows(
        self, connection: Connection, place: TablePlace
    ) -> tuple[list[RowMapping], TablePlace, bool]:
        """Rows that have not come, the place behind them, and whether there are more."""
        oldest = following = None
        if self._is_postgresql:
            snapshot = connection.execute(_SNAPSHOT).one()
            oldest, following = int(snapshot.oldest), int(snapshot.next)
        table = self._table = self._table if self._table is not None else self._read(connection)
        position = self._column(table, self._settings.position)
        chosen = select(*self._columns(table)).order_by(position)
        if place.floor is not None:
            chosen = chosen.where(position >= behind(place.floor, self._settings.overlap))
        rows: list[RowMapping] = []
        taken, passed, more = dict(place.taken), place.passed, False
        for row in connection.execution_options(yield_per=1000).execute(chosen).mappings():
            at = _position_of(row[self._settings.position], self._where)
            mark = mark_of(row.values())
            if mark in taken:
                continue
            beyond = place.passed is None or at > place.passed  # type: ignore[operator]
            if beyond and (len(rows) >= MOST_ROWS or len(taken) >= MOST_WAITING):
                more = True
                break
            rows.append(row)
            taken[mark] = at
            passed = at if passed is None else max(passed, at)
        moved = place.moved(passed, taken, oldest, following)
        return rows, moved.pruned(self._settings.overlap), more

    def _read(self, connection: Connection) -> Table:
        schema, _, name = self._settings.table.rpartition(".")
        return Table(name, MetaData(), schema=schema or None, autoload_with=connection)

    def _column(self, table: Table, name: str) -> "Column[Any]":
        if name not in table.c:
            raise InputError(
                f"there is no column {name!r}",
                self._where,
                f"it has {', '.join(table.c.keys())}",
            )
        return table.c[name]

    def _columns(self, table: Table) -> "list[Column[Any]]":
        """The columns that are read: where a row is of all channels, all that hold numbers."""
        settings = self._settings
        names = dict.fromkeys([settings.position, settings.time])
        if settings.channel is not None and settings.value is not None:
            names |= dict.fromkeys([settings.channel, settings.value])
        else:
            names |= dict.fromkeys(
                one.name for one in table.c if isinstance(one.type, (Integer, Numeric, Float))
            )
        return [self._column(table, name) for name in names]

    def _points_of(self, row: RowMapping) -> Iterable[SensorReading]:
        settings = self._settings
        try:
            moment = self._moment_of(row[settings.time])
        except InputError:
            self._unread += 1
            return
        if settings.channel is not None and settings.value is not None:
            pairs = [(str(row[settings.channel]), row[settings.value])]
        else:
            pairs = [
                (name, value)
                for name, value in row.items()
                if name not in (settings.time, settings.position)
            ]
        for name, value in pairs:
            number = _number_of(value)
            if number is not None and 0 < len(name) <= LONGEST_NAME:
                yield SensorReading(str(name), moment, number)

    def _moment_of(self, time: Any) -> int:
        if isinstance(time, datetime):
            return moment_of_stamp(time.isoformat(), self._zone, self._where)
        if isinstance(time, str):
            return moment_of_stamp(time, self._zone, self._where)
        if isinstance(time, (int, float, Decimal)):
            number = int(time) if time == int(time) else float(time)
            return moment_of_number(number, self._where)
        raise InputError(f"{time!r} is no time", self._where, "name another column as time")


def _number_of(value: Any) -> float | None:
    """A reading; None: it is missing, or none."""
    if isinstance(value, (int, float, Decimal)) and not isinstance(value, bool):
        number = float(value)
        return number if abs(number) <= LARGEST else None
    return None


def _position_of(value: Any, where: str) -> Position:
    if isinstance(value, datetime):
        return value
    if isinstance(value, (int, float, Decimal)) and not isinstance(value, bool):
        return int(value) if value == int(value) else float(value)
    raise InputError(
        f"the position {str(value)[:40]!r} is no number and no time",
        where,
        "name a column as position that rises from row to row",
    )
