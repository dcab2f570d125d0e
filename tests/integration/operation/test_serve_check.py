"""`rga serve --check`: what would go wrong is told beforehand, and nothing is written."""

import json
import socket
import sqlite3
import time
from collections import namedtuple
from collections.abc import Callable, Iterator
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path
from threading import Event, Thread
from typing import Any

import numpy as np
import pytest
from paho.mqtt.client import Client, MQTTv5
from paho.mqtt.enums import CallbackAPIVersion
from typer.testing import CliRunner

from rga.cli.app import app
from rga.errors import InputError
from rga.model import Model, load_model
from rga.operation.configuration import read_configuration
from rga.operation.disk import room as disk_room
from rga.operation.service import Service
from rga.twin.repository import Repository
from rga.twin.repository.migrations import VERSIONS
from rga_bench.operation.broker import Mosquitto
from served.brokers import mosquitto
from served.made_service import HTTP, write_service

__all__ = ["mosquitto"]

FOLDER = 'kind = "folder"\npath = "logger"\nfiles = "*.csv"'
TOPIC = "rga/v1/east/data/logger"
SHORT = '"calibration_rows":40'


def checked(folder: Path, wait: str = "0.6") -> tuple[int, str]:
    """Exit code and words of a check, which leaves the folder as it is."""
    before = contents(folder)
    found = CliRunner().invoke(
        app, ["serve", str(folder / "serve.toml"), "--check", "--wait", wait]
    )
    assert contents(folder) == before
    return found.exit_code, found.output


def contents(folder: Path) -> dict[str, bytes]:
    """Every file and folder below a folder, with what it holds."""
    return {
        str(one.relative_to(folder)): one.read_bytes() if one.is_file() else b""
        for one in folder.rglob("*")
        if "broker" not in one.parts
    }


def write_logger(
    folder: Path,
    model: Model,
    names: list[str] | None = None,
    *,
    ends: datetime | None = None,
    scatter: float = 1.0,
    header: dict[str, str] | None = None,
) -> None:
    """A logger's file of 60 rows, ten minutes apart, that scatter by so many times the noise."""
    names, ends = names or channels(model), ends or datetime.now(UTC)
    noise = [
        scatter * (model.sensors[name].noise or 1.0) if name in model.sensors else 1.0
        for name in names
    ]
    draw = np.random.default_rng(1)
    lines = [",".join(["time", *((header or {}).get(name, name) for name in names)])]
    for k in range(60):
        stamp = (ends - timedelta(minutes=10 * (59 - k))).isoformat(timespec="seconds")
        values = noise * draw.standard_normal(len(names))
        lines.append(",".join([stamp, *(f"{value:.9f}" for value in values)]))
    (folder / "logger").mkdir(exist_ok=True)
    (folder / "logger" / "east.csv").write_text("\n".join(lines) + "\n", "utf-8")


@pytest.fixture
def model(measured_bridge: dict[str, Any], tmp_path: Path) -> Model:
    """The model of a service that reads a folder and calibrates for three days."""
    write_service(tmp_path, measured_bridge, source=FOLDER)
    settings = tmp_path / "settings.json"
    text = settings.read_text("utf-8")
    assert SHORT in text
    settings.write_text(text.replace(SHORT, '"calibration_rows":432'), "utf-8")
    return load_model(tmp_path / "model.json")


def channels(model: Model) -> list[str]:
    """All that its logger has."""
    return [*model.sensors, *model.context]


def test_a_sound_service_is_well_and_untouched(model: Model, tmp_path: Path) -> None:
    write_logger(tmp_path, model)
    code, said = checked(tmp_path)
    assert (code, said.count("\n")) == (0, 2), said
    assert "a year takes about" in said
    assert said.endswith("It can be served.\n")


def test_a_year_of_two_twins_that_does_not_fit_is_told(
    model: Model, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_logger(tmp_path, model)
    path = tmp_path / "serve.toml"
    text = path.read_text("utf-8")
    twin = text[text.index("[[twin]]") :]
    path.write_text(text + "\n" + twin.replace('"east"', '"west"'), "utf-8")
    # Of each 52 596 rows: 44 bytes of every sensor and context, and 400 of a tenth of a step.
    rows = 52_596 * (44 * len(channels(model)) + 400)
    usage = namedtuple("usage", "total used free")
    found = usage(10_000 * rows, 0, round(1.9 * rows))
    monkeypatch.setattr(disk_room.shutil, "disk_usage", lambda _: found)
    path.write_text("[alarms]\ndisk = 0.0\n" + path.read_text("utf-8"), "utf-8")
    code, said = checked(tmp_path)
    assert code == 2
    assert said.count(f"a year takes about {rows / 1e6:.3g} MB for rows and ") == 2
    assert "a year of all twins takes about " in said
    assert f"and {1.9 * rows / 1e6:.3g} MB are free" in said


def test_names_that_only_one_side_has_are_told(model: Model, tmp_path: Path) -> None:
    first, *others = channels(model)
    write_logger(tmp_path, model, [*others, "D99"])
    code, said = checked(tmp_path)
    assert code == 2
    assert "the channel 'D99' is not used: the model has no such channel" in said
    assert f"nobody sends {first!r}" in said


def test_a_unit_of_something_else_is_told(model: Model, tmp_path: Path) -> None:
    name = next(iter(model.sensors))
    write_logger(tmp_path, model, header={name: f"{name} (kg)"})
    code, said = checked(tmp_path)
    assert code == 2
    assert f"the channel '{name} (kg)' is not used: the unit 'kg' of {name!r}" in said
    assert f"nobody sends {name!r}" in said


def test_a_unit_that_the_mapping_outweighs_is_told(model: Model, tmp_path: Path) -> None:
    name = next(iter(model.sensors))
    write_logger(tmp_path, model, header={name: f"{name} (m)"})
    config = tmp_path / "serve.toml"
    text = config.read_text("utf-8").replace(FOLDER, f'{FOLDER}\nmapping = "import.toml"', 1)
    config.write_text(text, "utf-8")
    (tmp_path / "import.toml").write_text(f'[channels]\n{name} = {{ unit = "cm" }}\n', "utf-8")
    assert "import.toml says cm, and what comes says m: it is read in cm" in checked(tmp_path)[1]


def test_stated_columns_are_looked_at_before_anything_comes(model: Model, tmp_path: Path) -> None:
    first, *others = channels(model)
    write_logger(tmp_path, model)
    config = tmp_path / "serve.toml"
    columns = ", ".join(f'"{one}"' for one in ("time", "D99", *others))
    row = f'kind = "http"\nformat = "row"\ncolumns = [{columns}]'
    config.write_text(config.read_text("utf-8").replace(FOLDER, row, 1), "utf-8")
    code, said = checked(tmp_path)
    assert code == 2
    assert "the channel 'D99' is not used: the model has no such channel" in said
    assert f"nobody sends {first!r}" in said
    text = config.read_text("utf-8").replace('"D99"', f'"{others[0]} (mm)"')
    config.write_text(text, "utf-8")
    code, said = checked(tmp_path)
    assert code == 2
    assert f"both give {others[0]!r}" in said


def test_variables_of_a_server_that_is_away_are_looked_at(model: Model, tmp_path: Path) -> None:
    first, second, *others = channels(model)
    nodes = ", ".join(f'"{one}" = "ns=2;s={one}"' for one in ("D99", second, *others))
    server = f'kind = "opcua"\nurl = "opc.tcp://127.0.0.1:9"\nnodes = {{ {nodes} }}'
    server += '\nmapping = "import.toml"'
    config = tmp_path / "serve.toml"
    config.write_text(config.read_text("utf-8").replace(FOLDER, server, 1), "utf-8")
    (tmp_path / "import.toml").write_text(
        f'[channels]\n{second} = {{}}\n[unused]\n{second} = "broken"\n', "utf-8"
    )
    code, said = checked(tmp_path)
    assert code == 2
    assert "the channel 'D99' is not used: the model has no such channel" in said
    assert f"nobody sends {first!r}" in said
    assert f"the channel {second!r} is left out: [unused] names it" in said


@pytest.mark.parametrize(
    ("ahead", "code", "words"),
    [
        (timedelta(hours=3), 2, "its clock is 3 h ahead: they are refused"),
        (timedelta(days=-9), 2, "its readings are 9 days old: they are refused"),
        (timedelta(hours=-5), 0, "its newest reading is 5 h old"),
    ],
)
def test_a_clock_that_is_off_is_told(
    model: Model, tmp_path: Path, ahead: timedelta, code: int, words: str
) -> None:
    ends = datetime.now(UTC) + ahead
    write_logger(tmp_path, model, ends=ends)
    found, said = checked(tmp_path)
    assert found == code
    assert words in said


def test_rows_that_are_quieter_than_the_model_says_are_told(model: Model, tmp_path: Path) -> None:
    write_logger(tmp_path, model, scatter=0.1)
    code, said = checked(tmp_path)
    assert code == 0
    assert "rows scatter less than half as much as the model's noise" in said


def test_a_calibration_of_less_than_three_days_is_told(model: Model, tmp_path: Path) -> None:
    write_logger(tmp_path, model)
    settings = tmp_path / "settings.json"
    text = settings.read_text("utf-8")
    settings.write_text(text.replace(":432", ":431"), "utf-8")
    code, said = checked(tmp_path)
    assert code == 0
    assert "the calibration takes 2.99 days" in said
    assert "give 432 calibration_rows or more: 3 days" in said


def test_a_folder_that_is_away_is_told(model: Model, tmp_path: Path) -> None:
    code, said = checked(tmp_path)
    assert code == 2
    assert f"error: {tmp_path / 'logger'} is away (twin 'east', folder)" in said


@pytest.mark.parametrize(
    ("file", "old", "new", "words"),
    [
        ("settings.json", '"packet":10', '"packet":null', "state each of them, in rows"),
        ("settings.json", '"packet":10', '"pocket":10', "pocket"),
        ("model.json", '"nodes"', '"knots"', "knots"),
        ("serve.toml", "[[twin]]", '[[notify]]\nurl_file = "gone"\n[[twin]]', "notices"),
        ("serve.toml", '"127.0.0.1:', '"0.0.0.0:', "there are no users"),
        ("serve.toml", "[[twin]]", 'certificate = "gone"\nkey = "gone"\n[[twin]]', "TLS"),
        ("serve.toml", "[[twin]]", "[alarms]\ndisk = 0.999999\n[[twin]]", "of the disk is free"),
        ("serve.toml", FOLDER, f'{FOLDER}\nmapping = "gone"', "gone"),
        ("serve.toml", FOLDER, f'{FOLDER}\nmapping = "units.toml"', "'kg' of 'D1' is not one of"),
        (
            "serve.toml",
            FOLDER,
            'kind = "sql"\nurl = "sqlite:///gone.db"\ntable = "t"\nposition = "id"',
            "there is no such file",
        ),
        (
            "serve.toml",
            FOLDER,
            'kind = "sql"\nurl = "sqlite://"\npassword = "gone"\ntable = "t"\nposition = "id"',
            "the secret cannot be read",
        ),
    ],
)
def test_each_file_that_is_wrong_is_told(
    model: Model, tmp_path: Path, file: str, old: str, new: str, words: str
) -> None:
    write_logger(tmp_path, model)
    (tmp_path / "units.toml").write_text('[channels]\nD1 = { unit = "kg" }\n', "utf-8")
    text = (tmp_path / file).read_text("utf-8")
    assert old in text
    (tmp_path / file).write_text(text.replace(old, new, 1), "utf-8")
    code, said = checked(tmp_path)
    assert code == 2
    assert words in said
    assert "Traceback" not in said


def test_a_port_that_is_taken_is_told(measured_bridge: dict[str, Any], tmp_path: Path) -> None:
    address = write_service(tmp_path, measured_bridge, source=HTTP)
    code, said = checked(tmp_path)
    assert code == 0, said
    assert "loggers send to the service" in said
    with socket.socket() as other:
        other.bind(("127.0.0.1", int(address.rpartition(":")[2])))
        other.listen()
        code, said = checked(tmp_path)
    assert code == 2
    assert "nothing can listen there: address already in use" in said


def test_what_was_kept_goes_with_the_files_or_is_told(
    measured_bridge: dict[str, Any], tmp_path: Path
) -> None:
    write_service(tmp_path, measured_bridge, source=HTTP)
    Service(read_configuration(tmp_path / "serve.toml")).stop()
    repository = tmp_path / "data" / "east" / "twin.sqlite"
    Repository.open(repository).close()
    code, said = checked(tmp_path)
    assert code == 0, said
    assert "brought up to date" not in said
    with closing(sqlite3.connect(repository)) as opened, opened:
        opened.execute(f"UPDATE {VERSIONS} SET version_num = '0001'")
    text = (tmp_path / "serve.toml").read_text("utf-8")
    (tmp_path / "serve.toml").write_text(
        text.replace("[[twin.source]]", "seed = 1\n[[twin.source]]")
    )
    code, said = checked(tmp_path)
    assert code == 2
    assert "a live twin that differs in seed is here" in said
    assert "note: its repository is brought up to date at the start" in said
    assert "LiveTwin" not in said
    every = 'every = "600 s"'
    assert every in text
    (tmp_path / "serve.toml").write_text(text.replace(every, 'every = "30 min"'), "utf-8")
    code, said = checked(tmp_path)
    assert code == 2
    assert "a live twin of rows of 10 min is here, and rows.every is 30 min" in said
    with pytest.raises(InputError, match="state rows of 10 min, or take another directory"):
        Service(read_configuration(tmp_path / "serve.toml"))


@pytest.fixture
def sending(mosquitto: Mosquitto, model: Model) -> Iterator[Callable[[list[str]], None]]:
    """Begins a logger that sends a packet of channels through the broker, again and again."""
    ended, threads = Event(), list[Thread]()

    def begin(names: list[str]) -> None:
        client = Client(CallbackAPIVersion.VERSION2, "logger", protocol=MQTTv5)
        client.connect("127.0.0.1", mosquitto.port)
        client.loop_start()

        def send() -> None:
            while not ended.wait(0.1):
                row = {"v": 1, "t0": datetime.now(UTC).isoformat(), "channels": names}
                client.publish(TOPIC, json.dumps(row | {"values": [[1.0] * len(names)]}), qos=1)
            client.disconnect()
            client.loop_stop()

        threads.append(Thread(target=send))
        threads[-1].start()

    yield begin
    ended.set()
    for one in threads:
        one.join()


def use_broker(folder: Path, broker: Mosquitto) -> None:
    """Let the service of a folder read a broker."""
    text = (folder / "serve.toml").read_text("utf-8")
    source = f'kind = "mqtt"\nurl = "{broker.url}"\ntopics = ["rga/v1/east/data/#"]'
    # Ten packets a second would fill a disk within a year.
    text = text.replace("[[twin.source]]", 'retention = { raw = "7 d" }\n[[twin.source]]')
    (folder / "serve.toml").write_text(text.replace(FOLDER, source), "utf-8")


def test_a_broker_is_listened_to(
    mosquitto: Mosquitto, model: Model, tmp_path: Path, sending: Callable[[list[str]], None]
) -> None:
    use_broker(tmp_path, mosquitto)
    sending(channels(model))
    code, said = checked(tmp_path)
    assert (code, said.count("\n")) == (0, 2), said
    sending(["D99"])
    code, said = checked(tmp_path)
    assert code == 2
    assert "the channel 'D99' is not used" in said


def test_a_broker_keeps_nothing_of_a_check(
    mosquitto: Mosquitto, model: Model, tmp_path: Path
) -> None:
    use_broker(tmp_path, mosquitto)
    seen: list[tuple[str, bytes]] = []
    watching = Client(CallbackAPIVersion.VERSION2, "watch", protocol=MQTTv5)
    watching.on_message = lambda _, __, one: seen.append((one.topic, bytes(one.payload)))
    watching.connect("127.0.0.1", mosquitto.port)
    watching.subscribe([("rga/#", 1), ("$SYS/broker/clients/total", 1)])
    watching.loop_start()
    code, said = checked(tmp_path)
    assert code == 0
    assert "warning: nothing came within 0.6 s" in said
    sent = watching.publish("rga/v1/east/data/logger", b"1", qos=1)
    sent.wait_for_publish(20)
    # $SYS counts clients with sessions every so often; here: only the one that watches.
    totals: list[bytes] = []
    until = time.monotonic() + 20
    while time.monotonic() < until and not (totals and totals[-1] == b"1"):
        totals = [payload for topic, payload in seen if topic.startswith("$SYS")]
        time.sleep(0.05)
    watching.disconnect()
    watching.loop_stop()
    assert totals[-1] == b"1"
    assert [one for one in seen if one[0].startswith("rga/")] == [(TOPIC, b"1")]


def test_a_broker_that_is_away_is_told(mosquitto: Mosquitto, model: Model, tmp_path: Path) -> None:
    mosquitto.kill()
    use_broker(tmp_path, mosquitto)
    code, said = checked(tmp_path)
    assert code == 2
    assert f"the broker mqtt://127.0.0.1:{mosquitto.port} cannot be reached" in said
