"""Where a repository is kept: files, folders, servers, and what is none of ours."""

import os
import sqlite3
import stat
import sys
from contextlib import nullcontext
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from sqlalchemy import Connection, text

from rga.errors import InputError
from rga.twin.repository import Repository, migrations, tables
from rga.twin.repository.database import database
from rga.twin.repository.proof import Proof
from stored_runs import IDENTITY, alter


def test_migrations_make_the_tables_of_the_code(place: str) -> None:
    Repository.open(place).close()
    opened = database(place, read_only=False)
    with opened.engine.begin() as connection:
        assert migrations.state(connection) == "current"
        migrations.upgrade(connection)
        context = MigrationContext.configure(connection, opts=migrations.OPTIONS)
        assert compare_metadata(context, tables.metadata) == []
        connection.execute(text("DROP TABLE kept"))
        assert compare_metadata(context, tables.metadata) != []
    opened.close()


def test_an_older_repository_is_brought_up_to_date_with_a_copy_beside_it(
    place: str, tmp_path: Path
) -> None:
    with Repository.open(place) as repository:
        run = repository.run(IDENTITY)
        for number in range(3):
            with run.step() as step:
                step.keep("synchrony", b"state %d" % number, number)
                step.keep("standing", b"{}", number)
                step.keep("learned", b"estimator %d" % number, number)
                step.keep("state 0", b"doubted %d" % number, number)
    for later in ("state_page", "proposal", "command"):
        alter(place, f"DROP TABLE {later}")
    for table in tables.OF_A_RUN:
        if table.name not in ("state_page", "proposal", "command"):
            alter(place, f"ALTER TABLE {table.name} DROP COLUMN checksum")
    alter(place, "DROP INDEX ix_message_run_id_kind_step")
    alter(place, "ALTER TABLE run RENAME COLUMN source TO record_sha256")
    alter(place, "UPDATE rga_repository SET version_num = '0001'")
    with pytest.raises(InputError, match="older than this rga"):
        Repository.open(place, read_only=True)
    with Repository.open(place) as repository:
        run = repository.run(IDENTITY)
        assert run.state("synchrony") == b"state 2"
        assert run.state("learned") == b"estimator 2"
        assert run.state("state 0") == b"doubted 2"
        assert run.state("standing") is None
        assert run.kept("standing") == b"{}"
        # 3 steps of 4 entries each, pages of 3 states, and the run itself.
        assert repository.check() == Proof(3 + 12 + 3 + 1, ())
    if "://" not in place:
        file = Path(place) / "twin.sqlite" if Path(place).is_dir() else Path(place)
        copy = file.with_name("twin.sqlite.revision-0001")
        with sqlite3.connect(copy) as held:
            assert held.execute("SELECT count(*) FROM kept").fetchone() == (12,)
            assert held.execute("SELECT version_num FROM rga_repository").fetchone() == ("0001",)
        assert not list(file.parent.glob("*.draft"))


def test_a_repository_that_cannot_be_filled_is_not_begun(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def half(connection: Connection) -> None:
        connection.execute(text("CREATE TABLE run (id INTEGER)"))
        # As a disk that is full; of a log of writing nothing would be seen.
        connection.execute(text("PRAGMA max_page_count = 2"))
        for number in range(9):
            connection.execute(text(f"CREATE TABLE more{number} (id INTEGER)"))

    monkeypatch.setattr(migrations, "upgrade", half)
    with pytest.raises(InputError, match="full"):
        Repository.open(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_newer_repository_is_refused(place: str) -> None:
    Repository.open(place).close()
    alter(place, "UPDATE rga_repository SET version_num = 'later'")
    for read_only in (True, False):
        with pytest.raises(InputError, match="newer than this rga"):
            Repository.open(place, read_only=read_only)


def test_tables_of_something_else_are_no_repository(place: str) -> None:
    alter(place, "CREATE TABLE photos (id INTEGER)")
    for read_only in (True, False):
        with pytest.raises(InputError, match="no repository"):
            Repository.open(place, read_only=read_only)


def test_a_directory_holds_twin_sqlite(tmp_path: Path) -> None:
    Repository.open(tmp_path).close()
    assert (tmp_path / "twin.sqlite").is_file()
    Repository.open(tmp_path / "twin.sqlite", read_only=True).close()


@pytest.mark.parametrize("damaged", [False, True])
def test_a_reader_leaves_nothing_behind(damaged: bool, tmp_path: Path) -> None:
    path = tmp_path / "twin.sqlite"
    Repository.open(path).close()
    if damaged:
        content = bytearray(path.read_bytes())
        content[100:130] = bytes(30)
        path.write_bytes(content)
    before = {one.name: one.read_bytes() for one in tmp_path.iterdir()}
    with pytest.raises(InputError) if damaged else nullcontext():
        Repository.open(path, read_only=True).close()
    assert {one.name: one.read_bytes() for one in tmp_path.iterdir()} == before


def test_a_reader_leaves_what_is_a_writers(tmp_path: Path) -> None:
    path = tmp_path / "twin.sqlite"
    with Repository.open(path, read_only=False) as writer:
        reader = Repository.open(path, read_only=True)
        writer.run(IDENTITY)
        log = tmp_path / "twin.sqlite-wal"
        length = log.stat().st_size
        reader.close()
        assert log.stat().st_size == length > 0


def test_sqlite_is_durable(tmp_path: Path) -> None:
    opened = database(tmp_path, read_only=False)
    with opened.engine.connect() as connection:
        assert connection.scalar(text("PRAGMA journal_mode")) == "wal"
        assert connection.scalar(text("PRAGMA synchronous")) == 2
    opened.close()


def test_a_file_that_is_no_database(tmp_path: Path) -> None:
    path = tmp_path / "twin.sqlite"
    path.write_text("time,D1\n" * 200)
    for read_only in (True, False):
        with pytest.raises(InputError, match="no repository"):
            Repository.open(path, read_only=read_only)
    assert path.read_text() == "time,D1\n" * 200


def test_a_missing_or_empty_file_cannot_be_read(tmp_path: Path) -> None:
    path = tmp_path / "twin.sqlite"
    with pytest.raises(InputError, match="no such file"):
        Repository.open(path, read_only=True)
    path.touch()
    with pytest.raises(InputError, match="no repository"):
        Repository.open(path, read_only=True)
    Repository.open(path).close()
    Repository.open(path, read_only=True).close()


def test_a_locked_file(tmp_path: Path) -> None:
    path = tmp_path / "twin.sqlite"
    Repository.open(path).close()
    other = sqlite3.connect(path, isolation_level=None)
    other.execute("PRAGMA locking_mode = EXCLUSIVE")
    other.execute("BEGIN EXCLUSIVE")
    with pytest.raises(InputError, match="locked by another process"):
        Repository.open(path)
    other.close()


def test_a_directory_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        Repository.open(tmp_path / "absent" / "twin.sqlite")


def test_a_directory_for_reading_only(tmp_path: Path) -> None:
    path = tmp_path / "twin.sqlite"
    Repository.open(path).close()
    path.chmod(stat.S_IRUSR)
    tmp_path.chmod(stat.S_IRUSR | stat.S_IXUSR)
    try:
        if os.access(path, os.W_OK):
            pytest.skip("this user may write everywhere")
        with pytest.raises(InputError, match="cannot be written"):
            Repository.open(path)
        with Repository.open(path, read_only=True) as repository:
            assert repository.runs() == ()
    finally:
        tmp_path.chmod(stat.S_IRWXU)


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("mysql://user:secret@host/base", "no repository is kept in 'mysql'"),
        ("postgresql://user@host:port/base", "URL cannot be read"),
        ("postgresql://user:secret@localhost:1/base?connect_timeout=5", "the server says"),
    ],
)
def test_urls_that_lead_nowhere(url: str, words: str) -> None:
    pytest.importorskip("psycopg")
    with pytest.raises(InputError, match=words) as refused:
        Repository.open(url)
    assert "secret" not in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_missing_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(InputError, match=r"rga\[postgres\]"):
        Repository.open("postgresql://user@host/base")
