"""A folder of a Campbell logger: the rows of a twin are those of its files, whatever happens."""

import json
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Event, Thread
from typing import Any

import numpy as np
import pytest

from live_streams import SETTINGS
from rga.operation.configuration import read_configuration
from rga.operation.inbox.account import Account
from rga.operation.inbox.refused import refused_packets
from rga.operation.served_twin import ServedTwin
from rga.operation.service import Service
from rga.operation.sources.source import Polling
from rga.twin.hardware.inbox import Inbox

CONFIGURATION = """
[[twin]]
name = "east"
model = "model.json"
settings = "settings.json"
rows = {{ every = "60 s", lateness = "60 s" }}
[[twin.source]]
kind = "folder"
path = "logger"
files = "*.dat"
mapping = "import.toml"
poll = "100 ms"
{more}
"""
HEAD = (
    '"TOA5","east","CR1000X","1","OS","CPU:prog","9","Minute"\n'
    '"TIMESTAMP","RECORD","D1","D2"\n'
    '"TS","RN","mm","mm"\n'
    '"","","Avg","Avg"\n'
)


def line(minute: int, day: str = "2026-11-23") -> str:
    return f'"{day} {minute // 60:02d}:{minute % 60:02d}:00",{minute},{minute / 4},-{minute}\n'


@pytest.fixture
def made(measured_bridge: dict[str, Any], tmp_path: Path) -> Iterator[Callable[..., Service]]:
    services = []

    def service(more: str = "clock = { check = false }", zone: str = "UTC") -> Service:
        (tmp_path / "logger").mkdir(exist_ok=True)
        (tmp_path / "model.json").write_text(json.dumps(measured_bridge), "utf-8")
        (tmp_path / "settings.json").write_text(SETTINGS.model_dump_json(), "utf-8")
        mapping = f'logger = "toa5"\n[time]\nzone = "{zone}"\n'
        (tmp_path / "import.toml").write_text(mapping, "utf-8")
        (tmp_path / "serve.toml").write_text(CONFIGURATION.format(more=more), "utf-8")
        services.append(Service(read_configuration(tmp_path / "serve.toml")))
        return services[-1]

    yield service
    for one in services:
        one.stop()


def look(twin: ServedTwin) -> Callable[[], str | None]:
    """Looks at the folder as the thread of the source does."""
    source = twin.sources()["folder"]
    assert isinstance(source, Polling)
    return lambda: source._look(Event())


def rows_of(twin: ServedTwin) -> np.ndarray:
    twin._heard["folder"] -= 10_000
    twin.seal()
    inbox = Inbox(twin.directory)
    station = inbox.station
    assert station is not None
    packet = inbox.packet(station, 0, 10_000)
    inbox.close()
    return np.column_stack([packet.time / 60, packet.readings[:, :2]])


def expected(minutes: list[int]) -> np.ndarray:
    return np.array([[k - minutes[0], k / 4, -k] for k in minutes], dtype=float)


def total(twin: ServedTwin) -> Account:
    return sum(twin.packets.account().values(), Account())


def append(path: Path, text: str) -> None:
    with path.open("a", encoding="utf-8") as file:
        file.write(text)


def test_every_row_of_a_logger_is_used_once(made: Callable[..., Service], tmp_path: Path) -> None:
    twin = made().twins["east"]
    poll, folder = look(twin), tmp_path / "logger"
    path = folder / "Minute.dat"
    for part in HEAD.splitlines(keepends=True):
        append(path, part)
        assert poll() is None
    assert total(twin) == Account()
    for minute in range(20):
        written = line(minute)
        # Now and then, a look falls into the middle of a line.
        append(path, written[:12])
        if minute % 3 == 0:
            poll()
        append(path, written[12:])
        poll()
    path.rename(folder / "Minute_1.dat")
    append(folder / "Minute_1.dat", line(20))
    append(path, HEAD + line(21))
    poll()
    # Replaced by another that begins as it does, and cut.
    (folder / "new").write_text(HEAD + line(22), "utf-8")
    (folder / "new").rename(path)
    poll()
    os.truncate(path, len(HEAD))
    poll()
    append(path, line(23))
    poll()
    # The share is away, and is back with other numbers of its files.
    folder.rename(tmp_path / "away")
    assert poll() == f"{folder} is away"
    folder.mkdir()
    assert "a share may be away" in str(poll())
    shutil.copytree(tmp_path / "away", folder, dirs_exist_ok=True)
    append(path, line(24))
    assert poll() is None
    # The service starts again.
    append(path, line(25))
    look(twin)()
    np.testing.assert_array_equal(rows_of(twin), expected(list(range(26))))
    account = total(twin)
    assert (account.difference, account.refused, account.late) == (0, 0, 0)


def test_what_cannot_be_used_is_refused_apart_from_the_rest(
    made: Callable[..., Service], tmp_path: Path
) -> None:
    twin = made().twins["east"]
    lines = [line(k) for k in range(100)]
    lines[37] = "garbage\n"
    lines[64] = lines[64].replace(",64,", ",64,x")
    append(tmp_path / "logger" / "a.dat", HEAD + "".join(lines))
    (tmp_path / "logger" / "b.dat").write_bytes(b"\x89PNG\r\n\0\0" * 100)
    poll = look(twin)
    poll()
    poll()
    poll()
    good = [k for k in range(100) if k not in (37, 64)]
    np.testing.assert_array_equal(rows_of(twin), expected(good))
    account = total(twin)
    assert (account.refused, account.difference) == (3, 0)


@pytest.mark.parametrize("short", [True, False])
@pytest.mark.parametrize("place", [0, 5, 9])
def test_a_line_that_lacks_fields_is_refused_apart_wherever_it_stands(
    made: Callable[..., Service], tmp_path: Path, place: int, short: bool
) -> None:
    twin = made().twins["east"]
    poll, path = look(twin), tmp_path / "logger" / "a.dat"
    lines = [line(k) for k in range(10)]
    if short:
        lines[place] = lines[place].rpartition(",")[0] + "\n"
    append(path, HEAD + "".join(lines))
    poll()
    # Alone, and as the end of a line that is completed later.
    cut, sent = line(10), line(11)
    append(path, (cut[:-5] if not short else cut.rpartition(",")[0] + "\n"))
    poll()
    append(path, (cut[-5:] if not short else "") + sent)
    poll()
    good = [k for k in range(12) if not (short and k in (place, 10))]
    np.testing.assert_array_equal(rows_of(twin), expected(good))
    account = total(twin)
    assert (account.refused, account.difference) == (2 if short else 0, 0)
    told = refused_packets(twin.inbox, 9)
    said = "the line has 3 fields, the header has 4"
    assert [said in one.reason for one in told] == [True] * account.refused
    assert all(one.reason.startswith("a.dat: ") for one in told)


@pytest.mark.parametrize(
    ("values", "fate"), [("1.5,2.5", "waiting"), ("1.5", "refused"), ("1,2,3", "refused")]
)
def test_a_line_of_csv_that_is_sent_has_as_many_fields_as_its_header(
    made: Callable[..., Service], values: str, fate: str
) -> None:
    twin = made().twins["east"]
    payload = f"time,D1,D2\n2026-11-23T00:00:00Z,{values}\n".encode()
    ((found, why),) = twin.receive("folder", [("a", payload)], kind="file")
    assert found == fate
    assert (fate == "refused") == ("fields, the header has 3" in (why or ""))
    assert total(twin).difference == 0


def test_an_hour_that_exists_twice_is_refused_and_the_rest_used(
    made: Callable[..., Service], tmp_path: Path
) -> None:
    # Hours 0 to 4 of the night on which summer time ends: the hour from 2 on is there twice.
    for zone, refused in (("Europe/Berlin", True), ("+01:00", False)):
        twin = made(zone=zone).twins["east"]
        minutes = [*range(180), *([] if not refused else range(120, 180)), *range(180, 240)]
        path = tmp_path / "logger" / "a.dat"
        path.write_text(HEAD + "".join(line(k, "2026-10-25") for k in minutes), "utf-8")
        look(twin)()
        rows, account = rows_of(twin), total(twin)
        if refused:
            # 00:00 and 01:00 are summer time, and 03:00 lies 4 hours after midnight.
            known = [*range(120), *range(180, 240)]
            after = [k if k < 120 else k + 60 for k in known]
            np.testing.assert_array_equal(rows[:, 0], after)
            np.testing.assert_array_equal(rows[:, 2], [-k for k in known])
            assert account.refused > 0
        else:
            assert len(rows) == 240
            assert account.refused == 0
        assert account.difference == 0
        shutil.rmtree(tmp_path / "data", ignore_errors=True)


def test_a_source_goes_on_by_itself_and_says_what_is_wrong(
    made: Callable[..., Service], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    service = made()
    twin = service.twins["east"]
    failed = Event()

    def fail(*_: Any) -> None:
        failed.set()
        raise RuntimeError("a fault of rga")

    receive = twin.receive_lines
    monkeypatch.setattr(twin, "receive_lines", fail)
    append(tmp_path / "logger" / "a.dat", HEAD + line(0) + line(1))
    source = service._sources["east", "folder"]
    source.start()
    Thread(target=service._seal, daemon=True).start()
    assert failed.wait(20)
    wait_for(lambda: service.faults.get(("east", "folder")) == "RuntimeError: a fault of rga")
    monkeypatch.setattr(twin, "receive_lines", receive)
    wait_for(lambda: total(twin).received == 1)
    wait_for(lambda: ("east", "folder") not in service.faults)


def test_a_clock_is_told_once(made: Callable[..., Service], tmp_path: Path) -> None:
    service = made(more="")
    twin = service.twins["east"]
    Thread(target=service._seal, daemon=True).start()
    poll = look(twin)
    append(tmp_path / "logger" / "a.dat", HEAD)
    for minute in range(5):
        append(tmp_path / "logger" / "a.dat", line(minute, "1970-01-01"))
        poll()
        wait_for(lambda: ("east", "folder") in service.faults)
    told = service.faults["east", "folder"]
    assert told.startswith("a.dat: its readings are ")
    assert total(twin) == Account(received=5, refused=5)


def wait_for(what: Callable[[], Any]) -> None:
    assert any(what() or Event().wait(0.05) for _ in range(400)), "it does not come"
