"""The historical repository: what is stored comes back, as it stood, and survives a kill."""

import json
import os
import random
import signal
import sqlite3
import stat
import subprocess
import sys
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from alembic.autogenerate import compare_metadata
from alembic.migration import MigrationContext
from numpy.testing import assert_array_equal
from sqlalchemy import create_engine, text

from rga.errors import InputError
from rga.twin.history import Event
from rga.twin.repository import Identity, Repository, Run, StoredFindings, migrations, tables
from rga.twin.repository.database import database

SERVER = os.environ.get("RGA_TEST_POSTGRES", "")
IDENTITY = Identity("a" * 64, "b" * 64, 3, json.dumps({"level": "C"}))
KILLS = 25


@pytest.fixture(params=["sqlite", "postgresql"])
def place(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[str]:
    """An empty place for a repository: a file, or a schema of its own on a server."""
    if request.param == "sqlite":
        yield str(tmp_path / "twin.sqlite")
        return
    if not SERVER:
        pytest.skip("RGA_TEST_POSTGRES names no server")
    schema = f"rga_{uuid.uuid4().hex}"
    address = SERVER.replace("postgresql://", "postgresql+psycopg://", 1)
    engine = create_engine(address, isolation_level="AUTOCOMMIT")
    with engine.connect() as connection:
        connection.execute(text(f"CREATE SCHEMA {schema}"))
        yield f"{SERVER}{'&' if '?' in SERVER else '?'}options=-csearch_path%3D{schema}"
        connection.execute(text(f"DROP SCHEMA {schema} CASCADE"))
    engine.dispose()


@pytest.fixture
def repository(place: str) -> Iterator[Repository]:
    with Repository.open(place) as repository:
        yield repository


@pytest.fixture
def run(repository: Repository) -> Run:
    return repository.run(IDENTITY)


def noisy(*shape: int, seed: int = 0) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Numbers with NaN among them."""
    generator = np.random.default_rng(seed)
    values = generator.normal(size=shape)
    values[generator.random(shape) < 0.2] = np.nan
    return values


def version(number: int, row: int) -> dict[str, Any]:
    return {
        "number": number,
        "row": row,
        "model_json": json.dumps({"name": f"model {number}"}),
        "model_sha256": str(number) * 64,
        "causes_json": "{}",
        "gain": None if number == 1 else 12.5,
        "gain_ci90": None if number == 1 else (10.0, 14.0),
        "status": "given" if number == 1 else "accepted",
    }


def test_measured_rows_come_back(run: Run) -> None:
    time, readings, contexts = np.arange(3000.0) * 60, noisy(3000, 5), noisy(3000, 2, seed=1)
    for first in (0, 7):
        end = 7 if first == 0 else 3000
        with run.step() as step:
            rows = slice(first, end)
            step.measured(first, time[rows], readings[rows], contexts[rows])
    whole = run.measured()
    assert_array_equal(whole.rows, np.arange(3000))
    assert_array_equal(whole.time, time)
    assert_array_equal(whole.readings, readings)
    assert_array_equal(whole.contexts, contexts)
    part = run.measured(first=1020, end=2060)
    assert_array_equal(part.rows, np.arange(1020, 2060))
    assert_array_equal(part.readings, readings[1020:2060])
    assert len(run.measured(first=3000).rows) == 0
    assert run.row == 2999


def test_a_record_without_measured_contexts(run: Run) -> None:
    with run.step() as step:
        step.measured(4, [240.0, 300.0], noisy(2, 5), np.zeros((2, 0)))
    assert_array_equal(run.measured().rows, [4, 5])
    assert run.measured().contexts.shape == (2, 0)


def test_nothing_stored_is_read_as_nothing(run: Run) -> None:
    assert (run.steps, run.row) == (0, -1)
    assert run.measured().readings.shape == (0, 0)
    assert len(run.simulated(within=([0, 0, 0], [1, 1, 1]))) == 0
    assert run.count_simulated() == run.count_simulated(within=([0, 0, 0], [1, 1, 1])) == 0
    assert run.version_in_force() is None
    assert run.kept("network") is None
    assert run.events() == run.messages() == run.findings() == run.versions() == ()


def test_simulations_by_version_origin_and_box(run: Run) -> None:
    contexts, readings = np.random.default_rng(0).random((2500, 3)), noisy(2500, 5)
    with run.step() as step:
        step.simulated(1, "design", 0, contexts, readings)
    with run.step() as step:
        step.simulated(1, "novel", 40, contexts[:1] + 5, readings[:1])
        falling = np.arange(20) % 2 == 1
        step.simulated(2, "requested", 50, contexts[:20], readings[:20], falling)
    everything = run.simulated()
    assert len(everything) == run.count_simulated() == 2521
    assert_array_equal(everything.contexts[:2500], contexts)
    assert_array_equal(everything.readings[:2500], readings)
    assert_array_equal(everything.falling, [False] * 2501 + [False, True] * 10)
    assert_array_equal(everything.version, [1] * 2501 + [2] * 20)
    assert_array_equal(everything.row, [0] * 2500 + [40] + [50] * 20)
    assert list(everything.origin[2499:2502]) == ["design", "novel", "requested"]

    assert run.count_simulated(version=2) == len(run.simulated(version=2)) == 20
    assert run.count_simulated(origin="novel") == len(run.simulated(origin="novel")) == 1
    box = ([0.2, 0.0, 0.5], [0.8, 1.0, 1.0])
    inside = ((contexts >= box[0]) & (contexts <= box[1])).all(axis=1)
    found = run.simulated(version=1, origin="design", within=box)
    assert_array_equal(found.readings, readings[inside])
    assert run.count_simulated(1, "design", box) == inside.sum() == len(found)


def test_a_later_entry_for_a_row_is_read_and_the_earlier_one_kept(run: Run) -> None:
    mean, spread, simulated, gaps = noisy(10, 2), noisy(10, 2), noisy(10, 5), noisy(10, 5) ** 2
    with run.step() as step:
        step.inferred(0, mean, spread, version=1)
        step.gaps(0, simulated, gaps, version=1)
    with run.step() as step:
        step.inferred(4, mean[4:] + 1, spread[4:], version=2)
        step.gaps(4, simulated[4:] + 1, gaps[4:], version=2)
    inferred, latest = run.inferred(), run.gaps()
    for entry in (inferred, latest):
        assert_array_equal(entry.rows, np.arange(10))
        assert_array_equal(entry.version, [1] * 4 + [2] * 6)
    assert_array_equal(inferred.contexts, np.concatenate([mean[:4], mean[4:] + 1]))
    assert_array_equal(inferred.spread, spread)
    assert_array_equal(latest.simulated, np.concatenate([simulated[:4], simulated[4:] + 1]))
    assert_array_equal(run.gaps(version=1).simulated, simulated)
    assert_array_equal(run.gaps(5, 8, version=1).gaps, gaps[5:8])
    assert_array_equal(run.inferred(2, 6).rows, [2, 3, 4, 5])
    assert_array_equal(run.inferred(version=2).rows, np.arange(4, 10))


def test_versions_and_which_is_in_force(run: Run) -> None:
    with run.step() as step:
        step.version(**version(1, 0))
        step.in_force(1, 0)
    with run.step() as step:
        step.version(**version(2, 30))
        step.in_force(2, 31)
    with run.step() as step:
        step.in_force(1, 45)
    first, second = run.versions()
    assert (first.number, first.gain, first.gain_ci90) == (1, None, None)
    assert (second.gain, second.gain_ci90, second.status) == (12.5, (10.0, 14.0), "accepted")
    assert second.model == json.dumps({"name": "model 2"})
    assert run.in_force() == ((0, 1), (31, 2), (45, 1))
    assert run.version_in_force() == run.version_in_force(row=30) == first
    assert run.version_in_force(row=44) == second


def test_words_come_back(run: Run) -> None:
    event = Event("alarm", 8, "2024-05-01T00:00:00", "D1 leaves", ("D1", "§2"), 3.5, None)
    body = {"held": 3, "missing": [1.5, None], "words": "größer"}
    with run.step() as step:
        step.message(kind="Q2", row=8, time=120.0, body={})
        step.message(kind="R2", row=8, body=body)
        step.findings(8, '{"verdict": "named"}')
        step.event(**vars(event))
        step.event("calibration", 9, 0.1, "done")
    with run.step() as step:
        step.message(kind="Q2", row=9, time="2024-05-01T00:01:00", body={})
    query, response, later = run.messages()
    assert (query.sequence, query.kind, query.row, query.time) == (1, "Q2", 8, 120.0)
    assert (response.body, response.time) == (body, None)
    assert later.time == "2024-05-01T00:01:00"
    assert later.written_at >= query.written_at >= run.begun_at
    assert [message.sequence for message in run.messages(kind="Q2")] == [1, 3]
    assert run.findings() == (StoredFindings(8, '{"verdict": "named"}'),)
    assert run.events() == (event, Event("calibration", 9, 0.1, "done"))


def test_the_last_checkpoint_of_a_name_is_read(run: Run) -> None:
    for row, weights in enumerate((b"\x00\x01", b"\xff" * 3000)):
        with run.step() as step:
            step.keep("network", weights, row)
            step.keep("detector", b"window", row)
    assert run.kept("network") == b"\xff" * 3000
    assert run.kept("detector") == b"window"
    assert run.as_of(row=0).kept("network") == b"\x00\x01"


def test_a_run_as_it_stood(run: Run) -> None:
    with run.step() as step:
        step.version(**version(1, 0))
        step.in_force(1, 0)
        step.simulated(1, "design", 0, noisy(4, 2), noisy(4, 5))
    for packet in range(4):
        first = 10 * packet
        with run.step() as step:
            step.measured(first, 60.0 * np.arange(first, first + 10), noisy(10, 5), noisy(10, 1))
            step.gaps(first, noisy(10, 5), noisy(10, 5), version=1)
            step.message(kind="Q5", row=first + 9, body={})
            if packet == 2:
                step.event("version", 29, 1740.0, "version 2 is in force")
                step.version(**version(2, 29))
                step.in_force(2, 29)
                step.gaps(0, noisy(30, 5), noisy(30, 5), version=2)
                step.findings(29, "{}")
    assert run.row == 39

    then = run.as_of(row=19)
    assert (then.steps, then.row) == (3, 19)
    assert_array_equal(then.measured().rows, np.arange(20))
    assert set(then.gaps().version) == {1}
    assert then.version_in_force() == run.versions()[0]
    assert (then.versions(), then.events(), then.findings()) == (run.versions()[:1], (), ())
    assert [message.sequence for message in then.messages()] == [1, 2]

    for view in (run.as_of(row=29), run.as_of(row=38), run.as_of(time=60.0 * 29 + 1)):
        assert_array_equal(view.measured().rows, np.arange(30))
        assert view.version_in_force() == run.versions()[1]
        assert set(view.gaps().version) == {2}
        assert len(view.findings()) == len(view.events()) == 1
    assert run.as_of(time=19 * 60.0).row == 19
    assert run.as_of(time=-1.0).steps == 0
    assert run.as_of(row=0).count_simulated() == 4
    assert len(run.as_of(row=0).measured().rows) == 0
    assert run.as_of(time=1e9).steps == run.as_of(row=39).steps == run.steps == 5
    assert run.as_of(row=19).as_of(row=39).steps == 3
    with pytest.raises(TypeError, match="either"):
        run.as_of()


def test_a_step_that_fails_leaves_nothing(run: Run) -> None:
    with run.step() as step:
        step.keep("state", b"before", 0)

    def fail() -> None:
        with run.step() as step:
            step.keep("state", b"after", 1)
            step.measured(0, [0.0], [[1.0]], [[2.0]])
            assert run.kept("state") == b"after"
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert (run.steps, run.row, run.kept("state")) == (1, 0, b"before")
    with run.step() as step:
        step.keep("state", b"again", 1)
    assert (step.number, step.row) == (2, 1)
    with pytest.raises(RuntimeError, match="ended"):
        step.keep("state", b"late", 1)


def test_arrays_that_do_not_fit_are_refused(run: Run) -> None:
    with pytest.raises(ValueError, match="differ in length"), run.step() as step:
        step.measured(0, [0.0], [[1.0], [2.0]], [[1.0]])
    with pytest.raises(ValueError, match="one or two axes"), run.step() as step:
        step.inferred(0, np.zeros((1, 1, 1)), np.zeros((1, 1, 1)), 1)
    with pytest.raises(ValueError, match="JSON"), run.step() as step:
        step.message(kind="R1", row=0, body={"gap": float("nan")})
    assert run.steps == 0


def test_the_same_identity_resumes_and_another_begins_a_new_run(place: str) -> None:
    other = Identity("a" * 64, "b" * 64, 4, IDENTITY.settings)
    for _ in range(2):
        with Repository.open(place) as repository:
            run = repository.run(IDENTITY)
            with run.step() as step:
                step.keep("state", b"", step.number)
            run.close()
            repository.run(other)
    with Repository.open(place, read_only=True) as repository:
        resumed, begun = repository.runs()
    assert (resumed.identity, begun.identity) == (IDENTITY, other)
    assert (resumed.steps, begun.steps) == (2, 0)


def test_reading_writes_nothing_and_needs_no_lock(place: str, run: Run) -> None:
    with Repository.open(place, read_only=True) as reader:
        (view,) = reader.runs()
        with run.step() as step:
            step.keep("state", b"new", 0)
            assert view.kept("state") is None
        assert view.kept("state") == b"new"
        with pytest.raises(InputError, match="open it for writing"):
            reader.run(IDENTITY)


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
    opened.engine.dispose()


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


def test_one_writer_at_a_time(place: str) -> None:
    Repository.open(place).close()
    holder = subprocess.Popen(
        [sys.executable, __file__, "hold", place], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    with holder, Repository.open(place) as second:
        assert holder.stdout is not None
        assert holder.stdout.readline() == b"held\n"
        with pytest.raises(InputError, match="another process writes"):
            second.run(IDENTITY)
        assert len(second.runs()) == 1
        holder.kill()
        holder.wait()
        assert second.run(IDENTITY).steps == 0


def test_what_is_acknowledged_survives_a_kill(place: str) -> None:
    generator = random.Random(1)
    helper = subprocess.Popen(
        [sys.executable, __file__, "kill", place],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    steps = 0
    with helper:
        assert helper.stdin is not None
        assert helper.stdout is not None
        for kill in range(KILLS):
            # Every other time while the repository is being opened, perhaps for the first time.
            acknowledged = "opening" if kill % 2 == 0 else "writing"
            print(acknowledged, generator.uniform(0, 0.06), file=helper.stdin, flush=True)
            steps = check_whole(place, max(steps, int(helper.stdout.readline())))
        helper.stdin.close()
    assert steps >= KILLS // 2


def check_whole(place: str, acknowledged: int) -> int:
    """The number of steps that are there, each of them whole."""
    if acknowledged:
        with Repository.open(place, read_only=True) as repository:
            assert repository.runs()[0].steps >= acknowledged
    if "://" not in place:
        with sqlite3.connect(place) as connection:
            assert connection.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
            assert connection.execute("PRAGMA foreign_key_check").fetchall() == []
        connection.close()
    with Repository.open(place) as repository:
        run = repository.run(IDENTITY)
        steps = run.steps
        assert acknowledged <= steps <= acknowledged + 1
        if steps:
            measured, simulated = run.measured(), run.simulated()
            assert_array_equal(measured.rows, np.arange(3 * steps))
            assert_array_equal(measured.readings[:, 83], np.repeat(np.arange(1, steps + 1), 3))
            assert_array_equal(simulated.contexts[:, 1], np.repeat(np.arange(1, steps + 1), 2))
            assert_array_equal(run.gaps().rows, np.arange(3 * steps))
            assert [message.body["step"] for message in run.messages()] == [*range(1, steps + 1)]
            assert run.kept("state") == b"%d" % steps
            assert run.row == 3 * steps - 1
        return steps


def test_a_directory_holds_twin_sqlite(tmp_path: Path) -> None:
    Repository.open(tmp_path).close()
    assert (tmp_path / "twin.sqlite").is_file()
    Repository.open(tmp_path / "twin.sqlite", read_only=True).close()


def test_sqlite_is_durable(tmp_path: Path) -> None:
    opened = database(tmp_path, read_only=False)
    with opened.engine.connect() as connection:
        assert connection.scalar(text("PRAGMA journal_mode")) == "wal"
        assert connection.scalar(text("PRAGMA synchronous")) == 2
    opened.engine.dispose()


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
    with pytest.raises(InputError, match=words) as told:
        Repository.open(url)
    assert "secret" not in str(told.value)
    assert "\n" not in str(told.value)


def test_a_missing_driver(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(InputError, match=r"rga\[postgres\]"):
        Repository.open("postgresql://user@host/base")


def alter(place: str, statement: str) -> None:
    """Change the database behind the repository's back."""
    opened = database(place, read_only=False)
    with opened.engine.begin() as connection:
        connection.execute(text(statement))
    opened.engine.dispose()


def hold(place: str) -> None:
    """Be the writer until the end."""
    Repository.open(place).run(IDENTITY)
    print("held", flush=True)  # noqa: T201
    sys.stdin.read()


def write_steps(place: str, acknowledged: int) -> None:
    """Write steps, and the number of each into a pipe once it is acknowledged."""
    run = Repository.open(place).run(IDENTITY)
    while True:
        with run.step() as step:
            n, first = step.number, 3 * (step.number - 1)
            step.message(kind="Q5", row=first, body={"step": n})
            step.measured(first, np.arange(first, first + 3), np.full((3, 84), n), np.zeros((3, 1)))
            step.simulated(1, "novel", first, np.full((2, 3), n), np.zeros((2, 84)))
            step.gaps(first, np.zeros((3, 84)), np.zeros((3, 84)), version=1)
            step.keep("state", b"%d" % n, first)
        os.write(acknowledged, b"%d\n" % n)


def kill_writers(place: str) -> None:
    """For each line "opening | writing, delay": kill a writer, and print its last step."""
    import time

    for line in sys.stdin:
        when, delay = line.split()
        receiving, sending = os.pipe()
        writer = os.fork()
        if not writer:
            write_steps(place, sending)
        os.close(sending)
        with os.fdopen(receiving) as pipe:
            first = pipe.readline() if when == "writing" else ""
            time.sleep(float(delay))
            os.kill(writer, signal.SIGKILL)
            os.waitpid(writer, 0)
            steps = [first, *pipe]
        print(max((int(step) for step in steps if step), default=0), flush=True)  # noqa: T201


if __name__ == "__main__":
    {"hold": hold, "kill": kill_writers}[sys.argv[1]](sys.argv[2])
