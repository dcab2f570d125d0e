"""A table that somebody else writes to: every row comes once, also one that commits late."""

import json
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path
from threading import Event
from typing import Any

import pytest
from sqlalchemy import Engine, create_engine, text

from rga.errors import InputError
from rga.operation.packets.native import read_packet
from rga.operation.packets.packet import EPOCH
from rga.operation.sources.settings import SqlSource
from rga.operation.sources.source import Outcome
from rga.operation.sources.sql import SqlTable
from stored_runs import server

__all__ = ["server"]

START = datetime.fromisoformat("2026-11-23T00:00:00+00:00")


class Readings:
    """Takes readings as a twin does, with the place in the table as text."""

    def __init__(self) -> None:
        self.found: list[tuple[str, int, float]] = []
        self.kept: dict[str, str] = {}
        self.full = False

    def receive(self, payloads: Any, cursor: Any = None) -> list[Outcome]:
        if self.full:
            raise InputError("the disk is full", "a test", "make room")
        start = (START - EPOCH) // timedelta(microseconds=1)
        for place, payload in payloads:
            packet = read_packet(payload, place)
            for k, name in enumerate(packet.channels):
                pairs = zip(packet.times, packet.values[:, k], strict=True)
                self.found += [
                    (name, int(time - start) // 1_000_000, float(one))
                    for time, one in pairs
                    if one == one
                ]
        self.kept |= {part: json.dumps(state) for part, state in (cursor or {}).items()}
        return []

    def receive_lines(self, where: str, head: bytes, lines: bytes, cursor: Any) -> list[Outcome]:
        raise AssertionError("no lines of files come here")

    def cursor(self) -> dict[str, Any]:
        return {part: json.loads(state) for part, state in self.kept.items()}

    def numbers(self) -> dict[str, Any]:
        return {}


class Database:
    """A table of readings, and a source that looks at it."""

    def __init__(self, url: str, engine: Engine, **more: Any) -> None:
        self.engine, self.url = engine, url
        self.readings = Readings()
        self._more = {"table": "reading", "position": "id", "overlap": 0.0} | more
        self._next = 0
        kind = "SERIAL" if engine.dialect.name == "postgresql" else "INTEGER"
        stamp = "TIMESTAMPTZ" if engine.dialect.name == "postgresql" else "TIMESTAMP"
        self.do(
            f"CREATE TABLE reading (id {kind} PRIMARY KEY, time {stamp}, "
            '"D1" DOUBLE PRECISION, "D2" NUMERIC, note TEXT)'
        )
        self.start()

    def start(self) -> None:
        """As when the service is started again."""
        settings = SqlSource(kind="sql", url=self.url, **self._more)
        self.source = SqlTable(settings, "UTC")

    def do(self, words: str, **values: Any) -> None:
        with self.engine.begin() as connection:
            connection.execute(text(words), values)

    def write(self, connection: Any = None) -> int:
        """Add a row, in a transaction of its own or in one that goes on; its number."""
        number = self._next = self._next + 1
        time = (START + timedelta(seconds=number)).isoformat(" ")
        if self.engine.dialect.name == "sqlite":
            time = time.removesuffix("+00:00") + ".000000"
        words = (
            'INSERT INTO reading (id, time, "D1", "D2", note) '
            "VALUES (:id, :time, :one, :two, 'x')"
        )
        values = {"id": number, "time": time, "one": number / 4, "two": -number}
        if connection is None:
            self.do(words, **values)
        else:
            connection.execute(text(words), values)
        return number

    def look(self) -> list[int]:
        """Numbers of the rows that are new."""
        before = len(self.readings.found)
        self.fault = self.source.look(self.readings, Event())
        new = self.readings.found[before:]
        numbers = [second for name, second, _ in new if name == "D1"]
        assert sorted(new) == sorted(
            one for n in numbers for one in (("D1", n, n / 4), ("D2", n, -float(n)))
        )
        return numbers


@pytest.fixture
def sqlite(tmp_path: Path) -> str:
    return f"sqlite:///{tmp_path / 'plant.sqlite'}"


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest) -> Iterator[Database]:
    kind = "sqlite" if request.param == "sqlite" else "server"
    url = request.getfixturevalue(kind)
    engine = create_engine(url.replace("postgresql://", "postgresql+psycopg://"))
    made = Database(url, engine)
    yield made
    made.source._engine.dispose()
    engine.dispose()


@pytest.fixture
def served(server: str) -> Iterator[Database]:
    engine = create_engine(server.replace("postgresql://", "postgresql+psycopg://"))
    made = Database(server, engine)
    yield made
    made.source._engine.dispose()
    engine.dispose()


def test_new_rows_come_once(database: Database) -> None:
    assert database.look() == []
    for _ in range(3):
        database.write()
    assert database.look() == [1, 2, 3]
    assert database.look() == []
    database.write()
    database.start()
    assert database.look() == [4]
    assert database.look() == []


def test_many_rows_come_in_parts(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rga.operation.sources.sql.MOST_ROWS", 7)
    for _ in range(50):
        database.write()
    assert database.look() == list(range(1, 51))
    assert database.look() == []
    # What is remembered of rows does not grow with the table.
    database.write()
    database.look()
    database.look()
    assert len(database.readings.cursor()["table"]["taken"]) < 20


def test_what_cannot_be_kept_comes_again(database: Database) -> None:
    database.write()
    database.readings.full = True
    with pytest.raises(InputError, match="the disk is full"):
        database.look()
    database.readings.full = False
    assert database.look() == [1]


def test_a_row_that_commits_late_is_not_skipped(served: Database) -> None:
    with served.engine.connect() as slow:
        first = served.write(slow)
        for _ in range(3):
            served.write()
            served.look()
        assert [one[1] for one in served.readings.found if one[0] == "D1"] == [2, 3, 4]
        served.start()
        assert served.look() == []
        slow.commit()
    assert served.look() == [first]
    served.write()
    assert served.look() == [5]
    assert served.look() == []
    # Once all are over, the rows before are looked for no more.
    served.write()
    served.look()
    served.look()
    assert served.readings.cursor()["table"]["floor"] >= 5


def test_a_row_that_is_taken_back_is_not_waited_for(served: Database) -> None:
    with served.engine.connect() as slow:
        served.write(slow)
        served.write()
        assert served.look() == [2]
        slow.rollback()
    served.write()
    assert served.look() == [3]
    assert served.look() == []


def test_rows_wait_behind_a_transaction_that_is_open_for_long(
    served: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.operation.sources.sql.MOST_WAITING", 4)
    with served.engine.connect() as slow:
        served.write(slow)
        for _ in range(10):
            served.write()
        assert served.look() == [2, 3, 4, 5]
        assert served.fault is not None
        assert "open for long" in served.fault
        slow.commit()
    found = [n for _ in range(5) for n in served.look()]
    assert found == [1, *range(6, 12)]
    assert served.fault is None


def test_elsewhere_rows_are_looked_for_again_within_the_overlap(sqlite: str) -> None:
    for overlap, comes in ((5.0, True), (0.0, False)):
        engine = create_engine(sqlite)
        database = Database(sqlite, engine, overlap=overlap)
        for number in (1, 2, 4):
            database._next = number - 1
            database.write()
        assert database.look() == [1, 2, 4]
        database._next = 2
        database.write()
        assert database.look() == ([3] if comes else [])
        assert database.look() == []
        database.do("DROP TABLE reading")
        engine.dispose()


def test_times_may_be_positions(sqlite: str) -> None:
    engine = create_engine(sqlite)
    database = Database(sqlite, engine, position="time", overlap=30.0)
    # The number is a channel now, as any column of numbers is.
    for number in (1, 40, 80):
        database._next = number - 1
        database.write()
    database.source.look(database.readings, Event())
    # Of two that come late, one lies within the overlap.
    for number in (30, 60):
        database._next = number - 1
        database.write()
    database.source.look(database.readings, Event())
    found = [second for name, second, _ in database.readings.found if name == "D1"]
    assert found == [1, 40, 80, 60]
    engine.dispose()


def test_a_row_may_be_one_reading(sqlite: str) -> None:
    engine = create_engine(sqlite)
    with engine.begin() as connection:
        connection.execute(text("CREATE TABLE log (n INTEGER, at INTEGER, tag TEXT, v REAL)"))
        for row in ("1, 1795392000, 'D1', 1.5", "2, 1795392001000, 'D2', 2.5",
                    "3, 1795392002, 'D1', NULL", "4, NULL, 'D1', 1", "5, 1795392003, '', 1",
                    "6, 1795392003, 'D1', 9e99"):  # fmt: skip
            connection.execute(text(f"INSERT INTO log VALUES ({row})"))
    more = {"table": "log", "time": "at", "position": "n", "channel": "tag", "value": "v"}
    readings = Readings()
    source = SqlTable(SqlSource(kind="sql", url=sqlite, **more), None)
    told = source.look(readings, Event())
    assert readings.found == [("D1", 0, 1.5), ("D2", 1, 2.5)]
    assert told == "1 rows have no time that can be read"
    engine.dispose()


def test_what_is_wrong_is_told_in_a_line(sqlite: str, tmp_path: Path) -> None:
    engine = create_engine(sqlite)
    Database(sqlite, engine)
    for more, words in (
        ({"table": "missing"}, "no such table"),
        ({"position": "missing"}, "no column 'missing'"),
        ({"time": "missing"}, "no column 'missing'"),
        ({"url": f"sqlite:///{tmp_path}/no/where.sqlite"}, "there is no such file"),
    ):
        stated = {"url": sqlite, "table": "reading", "position": "id"} | more
        with pytest.raises(InputError, match=words):
            SqlTable(SqlSource(kind="sql", **stated), None).look(Readings(), Event())
    with pytest.raises(InputError, match="driver is missing"):
        SqlTable(SqlSource(kind="sql", url="what://x/y", table="a", position="b"), None)
    (tmp_path / "secret").write_text("a\nb\n", "utf-8")
    for name in ("secret", "nowhere"):
        stated = {"url": sqlite, "table": "a", "position": "b", "password": tmp_path / name}
        with pytest.raises(InputError, match=name):
            SqlTable(SqlSource(kind="sql", **stated), None)
    engine.dispose()


def test_a_password_is_not_told(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("hunter2\n", "utf-8")
    url = "postgresql://rga@127.0.0.1:1/plant?connect_timeout=2"
    stated = {"url": url, "table": "a", "position": "b", "password": tmp_path / "secret"}
    source = SqlTable(SqlSource(kind="sql", **stated), None)
    with pytest.raises(InputError) as refused:
        source.look(Readings(), Event())
    assert "hunter2" not in str(refused.value)
    assert "the database says" in str(refused.value)
