"""One honest state: header, card, API and metrics say the same, and never hide an alarm."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

import rga
from rga.dashboard.app import app_of
from rga.records import Record
from rga.twin import Accept, Exclude, Reject, Rollback
from rga.twin.commands.command import AnyCommand
from served.alarmed_bridge import PATIENCE, Bridge, made

from .conftest import HERE, page


@contextmanager
def called(bridge: Bridge) -> Iterator[TestClient]:
    with TestClient(app_of(bridge.service), base_url=HERE) as client:
        yield client


def state(bridge: Bridge) -> str:
    """How the twin is, after it was seen that all doors say the same."""
    with called(bridge) as client:
        told = client.get("/api/v1/twins/east").json()
        word: str = told["state"]
        assert [one["state"] for one in client.get("/api/v1/twins").json()] == [word]
        numbers = client.get("/metrics").text
        assert re.findall(r'rga_state\{rga_state="(.+)",twin="east"\} 1\.0', numbers) == [word]
        for html in (page(client, "/"), page(client, "/twins/east")):
            assert re.search(rf'<span class="badge \w+">.{{0,60}}</span> {word}</span>', html)
        open_alarms = client.get("/api/v1/twins/east/alarms").json()
        is_alarmed = any(one["kind"] == "gap" and not one["cleared_at"] for one in open_alarms)
        if told["now"] is not None:
            assert told["now"]["out_of_sync"] == is_alarmed
        assert not (is_alarmed and word == "in step")
    return word


def asked(bridge: Bridge, command: AnyCommand) -> None:
    """Let a command be carried out; no row comes meanwhile."""
    with rga.LiveTwin(bridge.service.twins["east"].directory) as live:
        live.ask(command)
        live.play()
    bridge.look(play=True)


@pytest.fixture
def calm(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> Bridge:
    return made(tmp_path / "calm", measured_bridge, measured_record, 120, sinks=False)


def test_a_calm_twin_is_in_step_as_long_as_something_is_heard_of(calm: Bridge) -> None:
    assert state(calm) == "no rows yet"
    calm.send(30)
    assert state(calm) == "learning"
    calm.send(45)
    # Five rows wait for a full packet.
    assert state(calm) == "in step"
    calm.wait(PATIENCE - 60)
    assert state(calm) == "in step"
    calm.wait(180)
    assert state(calm) == "silent"
    # What was kept by the logger meanwhile is old, and somebody sends it.
    calm.send(1)
    assert state(calm) == "behind"
    calm.sent += 7
    calm.send(1)
    assert state(calm) == "in step"


def test_an_alarm_is_shown_until_something_in_force_explains_the_rows(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    bridge = made(tmp_path / "sunk", measured_bridge, measured_record, 240, sinks=True)
    bridge.send(70)
    assert state(bridge) == "in step"
    bridge.send(20)
    assert state(bridge) == "alarm"
    bridge.send(20)
    assert state(bridge) == "to decide"
    (alarm,) = [one for one in bridge.service.alarms.open() if one.kind == "gap"]
    bridge.service.alarms.acknowledge(alarm.id, "Ada")
    asked(bridge, Accept(who="Ada", why="surveyed"))
    assert state(bridge) == "in step"
    bridge.send(10)
    asked(bridge, Rollback(who="Bo", why="by mistake", version=1))
    assert state(bridge) == "alarm"
    bridge.wait(PATIENCE + 120)
    with called(bridge) as client:
        words = client.get("/api/v1/twins/east").json()["words"]
    assert "have left what the model lets expect; nothing in force explains it" in words
    assert "nothing has come for 62" in words
    bridge.send(1)
    asked(bridge, Rollback(who="Ada", why="it was right", version=2))
    assert state(bridge) in ("in step", "behind")
    spans_are_told(bridge)


def spans_are_told(bridge: Bridge) -> None:
    """Versions have beginnings, ends, and whoever put them in force."""
    with called(bridge) as client:
        first, second = client.get("/api/v1/twins/east/versions").json()
        html = page(client, "/twins/east/versions")
    spans = [*first["spans"], *second["spans"]]
    assert [(one["by"], one["who"], one["why"]) for one in spans] == [
        (None, None, None),
        ("rollback", "Bo", "by mistake"),
        ("accept", "Ada", "surveyed"),
        ("rollback", "Ada", "it was right"),
    ]
    original, mistake, accepted, again = spans
    assert original["end"] == accepted["begin"]
    assert accepted["end"] == mistake["begin"]
    assert mistake["end"] == again["begin"]
    assert again["end"] is None
    assert mistake["at"] < again["at"]
    shown = [re.sub(r"<[^>]+>", "", one) for one in html.split("<h3>Version ")[1:]]
    assert re.search(r"since 2026-\S+ \S+ UTC put back by Ada at 2\S+ \S+ UTC: it was", shown[0])
    assert re.search(r"from 2026-\S+ \S+ UTC to 2026-\S+ \S+ UTC accepted by Ada at ", shown[0])
    assert "since" not in shown[1]
    assert re.search(r"to 2026-\S+ \S+ UTC put back by Bo at ", shown[1])


def test_a_rejected_cause_leaves_the_alarm(
    measured_bridge: dict[str, Any], measured_record: Callable[..., Record], tmp_path: Path
) -> None:
    bridge = made(tmp_path / "sunk", measured_bridge, measured_record, 120, sinks=True)
    bridge.send(110)
    asked(bridge, Reject(who="Ada", why="it is sound"))
    assert state(bridge) == "alarm"
    with called(bridge) as client:
        assert "not explained" not in page(client, "/twins/east/causes")


def test_a_diagnosis_without_an_answer_leaves_the_alarm_and_is_told_of(calm: Bridge) -> None:
    calm.send(70)
    assert state(calm) == "in step"
    sensors = calm.service.twins["east"].model.sensors.values()
    noise = np.array([one.noise for one in sensors], dtype=float)
    draw = np.random.default_rng(1)

    def spoil(values: np.ndarray[Any, Any]) -> None:
        # Nothing that a bridge does has every sensor jump about by itself.
        values[:11] += 8 * noise * draw.normal(size=11)

    calm.send(50, spoil=spoil)
    assert state(calm) == "alarm"
    with called(calm) as client:
        html = page(client, "/twins/east/causes")
    assert "No cause has been proposed" in html
    assert re.search(r"diagnos[ie]s ha(s|ve) ended in “unknown”", html)
    assert "no kind of effect that is known explains it" in html


def test_a_twin_that_watches_nothing_is_not_in_step(calm: Bridge) -> None:
    def spoil(values: np.ndarray[Any, Any]) -> None:
        values[0], values[1:11] = 1e-3, np.nan

    calm.send(90, spoil=spoil)
    assert state(calm) == "not watched"


def test_sensors_that_are_out_of_use_are_seen_everywhere(calm: Bridge) -> None:
    def seen() -> list[bool]:
        with called(calm) as client:
            pages = [page(client, one) for one in ("/", "/twins/east", "/twins/east/sensors")]
        return ["10 of 11 sensors are out of use" in html for html in pages]

    calm.send(80)
    assert seen() == [False] * 3
    for name in calm.record.sensors[1:]:
        asked(calm, Exclude(who="Ada", why="cable cut", sensor=name))
    assert seen() == [True] * 3
    with called(calm) as client:
        html = page(client, "/twins/east/sensors")
        now = client.get("/api/v1/twins/east").json()["now"]
    assert html.count("<i></i>out of use") == 10
    assert now["out_of_use"] == list(calm.record.sensors[1:])
    assert now["gap"] == now["sensors"][calm.record.sensors[0]]["gap"]
    assert state(calm) == "in step"
