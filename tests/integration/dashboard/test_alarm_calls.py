"""Alarms by the API: who may see them, and what becomes of them."""

from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from starlette.testclient import TestClient

from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.service import Service

ALARMS = "/api/v1/alarms"


@pytest.fixture
def raised(service: Service) -> list[int]:
    """Numbers of alarms of the first twin, of the second, and of the service itself."""
    now = datetime.now(UTC)
    for twin in ("east", "west", None):
        key = ConditionKey(twin, "gap", "alarm", "twin")
        there = Condition(key, f"{twin} is out of step", now, ("D1",))
        service.alarms.observe(twin, Observation((there,), frozenset({"gap"})))
    return [one.id for one in service.alarms.open()]


def as_token(client: TestClient, purpose: Any, twin: str) -> dict[str, str]:
    access = client.app.state.access  # type: ignore[attr-defined]
    return {"Authorization": f"Bearer {access.tokens.make(f'{purpose} {twin}', purpose, twin)}"}


def numbers(client: TestClient, path: str = ALARMS, **headers: str) -> list[int]:
    answer = client.get(path, headers=headers)
    assert answer.status_code == 200, answer.text
    return [one["id"] for one in answer.json()]


def test_open_and_closed_ones_are_listed(
    client: TestClient, service: Service, raised: list[int]
) -> None:
    east, west, own = raised
    assert numbers(client) == [own, west, east]
    assert numbers(client, "/api/v1/twins/east/alarms") == [east]
    service.alarms.acknowledge(east, "Ada")
    service.alarms.observe("east", Observation((), frozenset({"gap"})))
    assert numbers(client) == [own, west]
    assert numbers(client, f"{ALARMS}?closed=1") == [own, west, east]
    assert numbers(client, "/api/v1/twins/east/alarms") == []
    assert numbers(client, "/api/v1/twins/east/alarms?closed=5") == [east]
    assert client.get(f"{ALARMS}?closed=-1").status_code == 422


def test_an_alarm_lives_by_calls(client: TestClient, raised: list[int]) -> None:
    path = f"{ALARMS}/{raised[0]}"
    assert client.get(path).json()["alarm"]["state"] == "raised"
    done = client.post(f"{path}/ack", json={"why": "seen"})
    assert (done.status_code, done.json()["state"]) == (200, "acknowledged")
    refused = client.post(f"{path}/ack")
    assert refused.status_code == 422
    assert "was acknowledged by" in refused.json()["detail"]
    shelved = client.post(f"{path}/shelve", json={"for": "8 h", "why": "works"}).json()
    left = datetime.fromisoformat(shelved["shelved_until"]) - datetime.now(UTC)
    assert timedelta(hours=7.9) < left <= timedelta(hours=8)
    assert client.post(f"{path}/unshelve").json()["state"] == "raised"
    until = (datetime.now(UTC) + timedelta(days=2)).isoformat()
    assert (
        client.post(f"{path}/shelve", json={"until": until, "why": "more works"}).json()["state"]
        == "shelved"
    )
    life = client.get(path).json()["life"]
    assert [one["change"] for one in life] == [
        "raised", "acknowledged", "shelved", "unshelved", "shelved",
    ]  # fmt: skip
    assert [one["why"] for one in life][1:3] == ["seen", "works"]
    assert all(one["who"] for one in life[1:])


@pytest.mark.parametrize(
    "shelving",
    [
        {},
        {"for": "8 h", "until": "2030-01-01T00:00:00Z"},
        {"for": "8 h"},
        {"for": "8 h", "why": " "},
        {"for": "8 h", "why": "a\0b"},
        {"for": "40 d", "why": "works"},
        {"for": 8, "why": "works"},
        {"until": "2001-01-01T00:00:00Z", "why": "works"},
        {"until": "2030-01-01T00:00:00", "why": "works"},
        {"until": "9999-12-31T23:59:59-12:00", "why": "works"},
        {"until": "0001-01-01T00:00:00+12:00", "why": "works"},
        {"until": 1_900_000_000, "why": "works"},
        {"for": "8 h", "why": "x" * 1001},
        {"for": "8 h", "why": "works", "who": "somebody else"},
    ],
)
def test_what_is_no_shelf_is_refused(
    client: TestClient, raised: list[int], shelving: dict[str, Any]
) -> None:
    assert client.post(f"{ALARMS}/{raised[0]}/shelve", json=shelving).status_code == 422
    assert client.get(f"{ALARMS}/{raised[0]}").json()["alarm"]["state"] == "raised"


def test_who_may_not_is_refused(client: TestClient, raised: list[int]) -> None:
    east, west, own = raised
    reads, operates = (as_token(client, one, "east") for one in ("read", "operate"))
    sends = as_token(client, "ingest", "east")
    assert numbers(client, **reads) == [east]
    assert client.get(f"{ALARMS}/{east}", headers=reads).status_code == 200
    for number in (west, own):
        assert client.get(f"{ALARMS}/{number}", headers=operates).status_code == 403
        assert client.post(f"{ALARMS}/{number}/ack", headers=operates).status_code == 403
    assert client.get("/api/v1/twins/west/alarms", headers=operates).status_code == 403
    for what in ("ack", "shelve", "unshelve"):
        call = {"json": {"for": "1 h", "why": "works"} if what == "shelve" else {}}
        assert client.post(f"{ALARMS}/{east}/{what}", headers=reads, **call).status_code == 403
    for path in (ALARMS, f"{ALARMS}/{east}"):
        assert client.get(path, headers=sends).status_code == 403
        assert client.get(path, headers={"Authorization": "Bearer x"}).status_code == 401
    assert client.post(f"{ALARMS}/{east}/ack", headers=operates).status_code == 200
    assert client.get(f"{ALARMS}/{own + 1}", headers=operates).status_code == 404
