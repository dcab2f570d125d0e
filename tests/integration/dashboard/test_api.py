"""What the API answers is what the repository holds."""

import json
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from starlette.testclient import TestClient

import rga
from rga.operation.service import Service
from rga.records import Record
from rga.twin import Twin

EAST = "/api/v1/twins/east"


def answer_of(client: TestClient, path: str, **query: Any) -> Any:
    answer = client.get(path, params=query)
    assert answer.status_code == 200, answer.text
    return answer.json()


def test_states(client: TestClient, service: Service) -> None:
    east, west = answer_of(client, "/api/v1/twins")
    assert (west["name"], west["now"], west["age"]) == ("west", None, None)
    assert east == answer_of(client, EAST) | {"age": east["age"]}
    with Twin.open(service.twins["east"].directory) as twin:
        status = twin.status()
        assert east["now"]["version"] == twin.version
        assert east["now"]["stage"] == status.stage
        assert east["now"]["rows"] == status.rows
        assert east["now"]["undecided"]["number"] == twin.proposals()[-1].number


def test_series_is_the_record(
    client: TestClient, lived_through: tuple[Path, Record], service: Service
) -> None:
    record = lived_through[1]
    found = answer_of(client, f"{EAST}/series", points=5000)
    rows = len(found["measured"]["time"])
    assert 100 < rows <= 120
    for k, name in enumerate(record.sensors):
        column = found["measured"]["columns"][name]
        assert column["mean"] == column["least"] == column["most"]
        np.testing.assert_array_equal(column["mean"], record.readings[:rows, k])
    with Twin.open(service.twins["east"].directory) as twin:
        history = twin.history()
    gaps = np.array([found["gap"]["columns"][name]["mean"] for name in record.sensors], dtype=float)
    expected = (history.gaps / history.noise**2).T
    np.testing.assert_allclose(gaps, expected[:, : gaps.shape[1]], rtol=1e-12)


def test_a_series_does_not_end_before_it_begins(client: TestClient) -> None:
    times = {"from": "2026-11-24T00:00:00Z", "to": "2026-11-23T00:00:00Z"}
    refused = client.get(f"{EAST}/series", params=times)
    assert (refused.status_code, refused.json()["detail"]) == (422, "query.to: it is before from")
    answer_of(client, f"{EAST}/series", **{"from": times["to"], "to": times["from"]})


@pytest.mark.parametrize("points", [1, 7, 60])
def test_a_series_has_no_more_points_than_asked(client: TestClient, points: int) -> None:
    every = answer_of(client, f"{EAST}/series", points=5000)
    found = answer_of(client, f"{EAST}/series", points=points)
    for part in ("measured", "simulated", "gap", "inferred"):
        assert 1 <= len(found[part]["time"]) <= points
        for name, column in found[part]["columns"].items():
            whole = np.array(every[part]["columns"][name]["mean"], dtype=float)
            assert min(column["least"]) == np.nanmin(whole)
            assert max(column["most"]) == np.nanmax(whole)


def test_a_series_of_a_stretch_and_some_channels(client: TestClient, service: Service) -> None:
    begin, end = "2026-11-23T01:00:00Z", "2026-11-23T04:00:00+01:00"
    found = answer_of(client, f"{EAST}/series", **{"from": begin, "to": end, "channels": ["D2"]})
    times = found["measured"]["time"]
    assert [*found["measured"]["columns"]] == ["D2"]
    assert (times[0], times[-1], len(times)) == (
        "2026-11-23T01:00:00Z",
        "2026-11-23T02:50:00Z",
        12,
    )
    for query in ({"from": "2026-11-23T01:00:00"}, {"from": "soon"}, {"channels": "none"}):
        assert client.get(f"{EAST}/series", params=query).status_code == 422
    assert client.get(f"{EAST}/series", params={"points": 0}).status_code == 422
    assert client.get(f"{EAST}/series", params={"points": 10**6}).status_code == 422


@pytest.mark.parametrize("time", ["2026", "1", "1900000000", "9999-12-31T23:59:59-12:00"])
def test_what_is_no_time_of_iso_8601_is_refused(client: TestClient, time: str) -> None:
    for path, key in (("series", "from"), ("series", "to"), ("as-of", "time"), ("report", "from")):
        answer = client.get(f"{EAST}/{path}", params={key: time})
        assert answer.status_code == 422
        assert answer.json()["detail"].startswith(f"query.{key}: ")


@pytest.mark.parametrize("path", [EAST, f"{EAST}/series", f"{EAST}/stream", "/api/v1/twins"])
def test_a_key_of_a_query_that_is_unknown_is_refused(client: TestClient, path: str) -> None:
    answer = client.get(path, params={"form": "2026-11-23T01:00:00Z"})
    assert answer.status_code == 422
    assert "query.form: there is no such key" in answer.json()["detail"]


def test_gap_contexts_and_latest(client: TestClient, service: Service) -> None:
    state = answer_of(client, EAST)["now"]
    gap = answer_of(client, f"{EAST}/gap")
    assert gap["mean"] == state["gap"]
    assert gap["sensors"] == {name: one["gap"] for name, one in state["sensors"].items()}
    contexts = answer_of(client, f"{EAST}/contexts")
    for name, (mean, spread) in state["contexts"].items():
        low, high = contexts[name]["ci90"]
        assert contexts[name]["mean"] == mean
        assert high - low == pytest.approx(2 * 1.6449 * spread)
    latest = answer_of(client, f"{EAST}/latest")
    assert {*latest} == {*state["sensors"]}
    # Rows that are sealed wait behind those that the twin has taken in.
    time = datetime.fromisoformat(latest["D1"]["time"])
    assert time >= datetime.fromisoformat(state["time"])
    assert latest["D1"]["age"] < 0 or latest["D1"]["age"] > 0


def test_what_a_twin_lived_through(client: TestClient, service: Service) -> None:
    with Twin.open(service.twins["east"].directory) as twin:
        history, proposals = twin.history(), twin.proposals()
    versions = answer_of(client, f"{EAST}/versions")
    assert [one["number"] for one in versions] == [one.number for one in history.versions]
    assert [one["in_force"] for one in versions].count(True) == 1
    model = client.get(f"{EAST}/versions/1/model")
    assert rga.model.read_model(model.json(), "downloaded").sensors.keys() == {
        *history.record.sensors
    }
    assert client.get(f"{EAST}/versions/99/model").status_code == 404
    found = answer_of(client, f"{EAST}/proposals")
    assert [one["words"] for one in found] == [one.words for one in proposals]
    assert [one["decided"] for one in found][-1] is None
    events = answer_of(client, f"{EAST}/events", last=1000)
    assert [one["words"] for one in events] == [one.words for one in history.events]
    assert answer_of(client, f"{EAST}/events", last=2) == events[-2:]
    messages = answer_of(client, f"{EAST}/messages", kind="Q5", last=1000)
    assert {one["kind"] for one in messages} == {"Q5"}
    assert answer_of(client, f"{EAST}/messages", kind="Q5", last=1) == messages[-1:]
    times = {one["row"]: one["time"] for one in events}
    of_events = [one for one in answer_of(client, f"{EAST}/messages") if one["row"] in times]
    assert of_events
    assert all(one["time"] == times[one["row"]].replace("+00:00", "Z") for one in of_events)
    account = answer_of(client, f"{EAST}/account")["http"]
    assert (account["received"], account["difference"]) == (120, 0)


def test_as_of_goes_back(client: TestClient) -> None:
    now = answer_of(client, EAST)["now"]
    events = answer_of(client, f"{EAST}/events", last=1000)
    alarm = next(one for one in events if one["kind"] == "alarm")
    before = datetime.fromisoformat(alarm["time"]) - timedelta(hours=3)
    then = answer_of(client, f"{EAST}/as-of", time=before.isoformat())
    assert now["undecided"] is not None
    assert then["undecided"] is None
    assert then["rows"] < now["rows"]
    assert answer_of(client, f"{EAST}/as-of", time="2030-01-01T00:00:00Z") == now
    assert answer_of(client, f"{EAST}/as-of", time="2001-01-01T00:00:00Z") is None


def test_what_if_is_that_of_the_twin(client: TestClient, service: Service) -> None:
    question = {"settings": {"temperature": 30.0}}
    found = client.post(f"{EAST}/whatif", json=question)
    assert found.status_code == 200, found.text
    with Twin.open(service.twins["east"].directory) as twin:
        expected = twin.whatif(question["settings"])
    for k, name in enumerate(expected.sensors):
        assert found.json()["sensors"][name]["after"] == pytest.approx(expected.after[k])
    for wrong in (
        {"settings": {"weather": 1.0}},
        {"settings": {"temperature": "hot"}},
        {"settings": {"temperature": "5"}},
        {"settings": {"temperature": True}},
        {"add": {"x": {"kind": "magic"}}},
        {"addition": {}},
    ):
        assert client.post(f"{EAST}/whatif", json=wrong).status_code == 422
    deep = "[" * 100_000 + "]" * 100_000
    told = client.post(f"{EAST}/whatif", content=deep, headers={"Content-Type": "application/json"})
    assert told.status_code in (400, 422)
    large = json.dumps({"settings": {"x" * 300_000: 1.0}})
    told = client.post(f"{EAST}/whatif", content=large)
    assert told.status_code == 413


def test_a_twin_that_has_not_begun_says_so(client: TestClient) -> None:
    west = "/api/v1/twins/west"
    assert answer_of(client, west)["now"] is None
    assert answer_of(client, f"{west}/account") == {}
    for path in ("gap", "contexts", "latest", "series", "versions", "events", "messages", "report"):
        answer = client.get(f"{west}/{path}")
        assert answer.status_code == 404
        assert "has not begun" in answer.json()["detail"]


@pytest.mark.parametrize(
    "name", ["north", "..", "%2e%2e", "east%2f..%2fwest", "east/../west", "<script>", "east%00"]
)
def test_other_names_lead_nowhere(client: TestClient, name: str) -> None:
    answer = client.get(f"/api/v1/twins/{name}/gap")
    assert answer.status_code in (404, 422)
    assert "<script>" not in answer.text or answer.headers["content-type"] == "application/json"


def test_health_and_metrics(client: TestClient, service: Service) -> None:
    assert answer_of(client, "/healthz") == {"state": "up"}
    assert answer_of(client, "/readyz") == {"state": "up", "lacking": 0}
    found = client.get("/metrics").text
    now = answer_of(client, EAST)["now"]
    assert f'rga_steps_total{{twin="east"}} {float(now["steps"])}' in found
    assert 'rga_packets_total{fate="received",source="http",twin="east"} 120.0' in found
    assert 'rga_row_age_seconds{twin="east"}' in found
    assert 'rga_row_age_seconds{twin="west"}' not in found


def test_packets_are_refused_by_kind_size_rate_and_room(
    client: TestClient, service: Service
) -> None:
    path = f"{EAST}/packets"
    for kind in ("text/html", "multipart/form-data"):
        assert client.post(path, content=b"{}", headers={"Content-Type": kind}).status_code == 415
    told = client.post(path, content=b"{}", headers={"Content-Encoding": "gzip"})
    assert told.status_code == 415
    assert client.post(path, content=b"x" * (8 * 2**20 + 1)).status_code == 413
    assert answer_of(client, f"{EAST}/account")["http"]["received"] == 120
    # As nothing of these was kept, one that is kept shows that something can be.
    assert client.post(path, content=b"[" * 100_000).json()["refused"] != []
    assert answer_of(client, f"{EAST}/account")["http"]["received"] == 121


def test_a_full_disk_is_told_and_nothing_is_kept(
    client: TestClient, service: Service, monkeypatch: pytest.MonkeyPatch
) -> None:
    inbox = service.twins["east"].inbox
    with inbox.reading() as connection:
        pages = connection.exec_driver_sql("PRAGMA page_count").scalar_one()
        connection.exec_driver_sql(f"PRAGMA max_page_count = {pages}")
    answer = client.post(f"{EAST}/packets", content=b"\x81" + b"x" * 100_000)
    assert answer.status_code == 507
    assert int(answer.headers["Retry-After"]) > 0
    assert answer_of(client, f"{EAST}/account")["http"]["received"] == 120
    monkeypatch.setattr("rga.dashboard.api.bounds.RESERVE", 2**62)
    client.app.state.room._found.clear()  # type: ignore[attr-defined]
    answer = client.post(f"{EAST}/packets", content=b"{}")
    assert answer.status_code == 429
    assert client.get("/readyz").status_code == 503
