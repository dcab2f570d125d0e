"""What pages say of the newest rows is by the version in force, before a row has come under it."""

from pathlib import Path

import numpy as np
import pytest
from starlette.testclient import TestClient

from rga.operation.reading.twin_now import RECENT, TwinNow, twin_now
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.service import Service
from rga.report.figures.of_run.run_gap import mean
from rga.twin import Twin
from rga.twin.repository import RunView
from served.bridges import played

from .conftest import page


def asked(client: TestClient, service: Service, **command: object) -> None:
    """Let a command be carried out; no row comes meanwhile."""
    answer = client.post("/api/v1/twins/east/commands", json=command | {"why": "to see"})
    assert answer.status_code == 202
    played(service.twins["east"])


def said(reading: TwinReading) -> tuple[RunView, TwinNow]:
    view, now = reading.view(), reading.now()
    assert view is not None
    assert now is not None
    return view, now


def test_an_accepted_version_is_seen_at_once_and_so_is_the_way_back(
    folder: Path, service: Service, client: TestClient
) -> None:
    reading = TwinReading("east", folder / "data" / "east", None)
    _, before = said(reading)
    assert before.recent is not None
    assert before.sensors["D3"].recent is not None
    past = reading.series(0.0, np.inf, 1000)
    asked(client, service, kind="accept")
    view, now = said(reading)
    assert (now.version, now.rows) == (2, before.rows)
    latest = view.gaps(now.rows - RECENT, now.rows, version=2)
    noise = [one.noise for one in now.sensors.values()]
    expected = mean(latest.gaps / np.array(noise, dtype=float) ** 2, axis=0)
    recent = [one.recent for one in now.sensors.values()]
    np.testing.assert_allclose(np.array(recent, dtype=float), expected)
    assert now.recent is not None
    assert now.recent < before.recent / 10
    told = client.get("/api/v1/twins/east/gap").json()
    assert told["mean"] == pytest.approx(now.gap)
    assert told["sensors"]["D3"] == pytest.approx(now.sensors["D3"].gap)
    html = page(client, "/twins/east")
    assert "gap by version 2 of the model, with" in html
    assert "gap4" not in html.split('class="scale"')[0]
    for path in ("/twins/east/sensors", "/twins/east/sensors?name=D3"):
        html = page(client, path)
        assert "simulated by version 2" in html
        assert "very far off" not in html
    second, first = page(client, "/twins/east/versions").split("<h3>Version ")[1:]
    assert "never" not in second
    assert "as noise" in second
    assert "as noise" not in first
    # The past says what was said then.
    again = reading.series(0.0, np.inf, 1000)
    assert past is not None
    assert again is not None
    np.testing.assert_array_equal(past.gap.mean, again.gap.mean)
    asked(client, service, kind="rollback", version=1)
    _, back = said(reading)
    assert back.version == 1
    assert back.sensors["D3"].recent is not None
    assert back.sensors["D3"].recent > 10 * (now.sensors["D3"].recent or 0.0)
    second, first = page(client, "/twins/east/versions").split("<h3>Version ")[1:]
    assert "never" not in second
    assert "in force</span>" in first


def test_no_step_shows_what_another_version_said(
    folder: Path, service: Service, client: TestClient
) -> None:
    reading = TwinReading("east", folder / "data" / "east", None)
    view, _ = said(reading)
    first = view.steps
    asked(client, service, kind="accept")
    asked(client, service, kind="rollback", version=1)
    view, now = said(reading)
    noise = {name: one.noise or np.nan for name, one in now.sensors.items()}
    seen = set()
    for step in range(first, view.steps + 1):
        then = view.at_step(step)
        stood = twin_now(Twin(then, reading.place), then, noise)
        followed = then.gaps(stood.rows - 1, stood.rows, version=stood.version)
        shown = [one.simulated for one in stood.sensors.values()]
        if len(followed.rows):
            np.testing.assert_array_equal(np.array(shown, dtype=float), followed.simulated[0])
        else:
            assert set(shown) == {None}
        seen.add(stood.version)
    assert seen == {1, 2}
