"""Commands by the API: kept once, carried out in order, told to who comes too late."""

from typing import Any

import pytest
from starlette.testclient import TestClient

import rga
from rga.operation.service import Service
from rga.twin.commands.command import Accept, read_command

EAST = "/api/v1/twins/east"
ACCEPT = {"kind": "accept", "why": "seen on site"}
ROLLBACK = {"kind": "rollback", "version": 1, "why": "not yet"}


def asked(client: TestClient, command: dict[str, Any], key: str | None = None) -> int:
    headers = {} if key is None else {"Idempotency-Key": key}
    answer = client.post(f"{EAST}/commands", json=command, headers=headers)
    assert answer.status_code == 202, answer.text
    assert answer.headers["Location"] == f"{EAST}/commands/{answer.json()['number']}"
    return int(answer.json()["number"])


def state_of(client: TestClient, number: int) -> Any:
    return client.get(f"{EAST}/commands/{number}").json()


def play(service: Service) -> None:
    with rga.LiveTwin(service.twins["east"].directory) as live:
        live.play()


def test_a_command_waits_and_is_done_once(client: TestClient, service: Service) -> None:
    number = asked(client, {"kind": "note", "why": "bearing greased"}, key="k")
    assert asked(client, {"kind": "note", "why": "bearing greased"}, key="k") == number
    assert state_of(client, number)["state"] == "waiting"
    answer = client.post(
        f"{EAST}/commands", json={"kind": "note"}, headers={"Idempotency-Key": "k"}
    )
    assert answer.status_code == 409
    play(service)
    state = state_of(client, number)
    assert (state["state"], state["outcome"]) == ("done", "noted")
    with rga.LiveTwin(service.twins["east"].directory) as live:
        assert [one.kind for one in live.twin.commands()].count("note") == 1
    assert client.get(f"{EAST}/commands/{number + 1}").status_code == 404


@pytest.mark.parametrize("second", [ACCEPT, ROLLBACK | {"version": 1}])
def test_of_two_at_once_one_wins_and_the_other_is_told(
    client: TestClient, service: Service, second: dict[str, Any]
) -> None:
    first_number, second_number = asked(client, ACCEPT), asked(client, second)
    play(service)
    first, last = state_of(client, first_number), state_of(client, second_number)
    assert first["state"] == "done"
    assert last["state"] == "refused"
    assert "version 2 has come into force meanwhile" in last["outcome"]
    assert client.get(EAST).json()["now"]["version"] == 2
    events = client.get(f"{EAST}/events").json()
    told = [one["words"] for one in events if one["kind"] == "command"]
    assert "seen on site" in told[-2]
    assert "refused" in told[-1]


def test_one_after_the_other_both_are_done(client: TestClient, service: Service) -> None:
    for command, version in ((ACCEPT, 2), (ROLLBACK, 1)):
        number = asked(client, command)
        play(service)
        assert state_of(client, number)["state"] == "done"
        assert client.get(EAST).json()["now"]["version"] == version


@pytest.mark.parametrize(
    "wrong",
    [
        {},
        {"kind": "explode"},
        {"kind": "rollback"},
        {"kind": "rollback", "version": 0},
        {"kind": "note", "who": "somebody else"},
        {"kind": "note", "given_at": "2001-01-01"},
        {"kind": "note", "why": "x" * 20_001},
        {"kind": "exclude", "sensor": "D1", "since": "soon"},
        [],
        "note",
    ],
)
def test_what_is_no_command_is_refused(client: TestClient, wrong: Any) -> None:
    answer = client.post(f"{EAST}/commands", json=wrong)
    assert answer.status_code == 422
    assert isinstance(answer.json()["detail"], str)


BEYOND = "9999-12-31T23:59:59-12:00"
IN_ORDER = {"since": "2026-11-23T12:00:00Z", "until": "2026-11-23T10:00:00Z"}


@pytest.mark.parametrize(
    ("twin", "command", "told"),
    [
        ("west", {"kind": "accept"}, "nothing is proposed"),
        ("west", {"kind": "reject", "proposal": 1}, "nothing is proposed"),
        ("west", {"kind": "rollback", "version": 1}, "no version 1"),
        ("east", {"kind": "accept", "proposal": 9}, "no proposal 9"),
        ("east", {"kind": "rollback", "version": 9}, "no version 9"),
        ("east", {"kind": "accept", "version_seen": 9}, "no version 9"),
        ("east", {"kind": "note", "why": "x", "version_seen": 9}, "no version 9"),
        ("west", {"kind": "recalibrate", "version_seen": 1}, "there is none yet"),
        ("east", {"kind": "exclude", "sensor": "D77"}, "no sensor 'D77'"),
        ("east", {"kind": "exclude", "sensor": "D1"} | IN_ORDER, "ends before it begins"),
        ("west", {"kind": "exclude", "sensor": "D1"} | IN_ORDER, "ends before it begins"),
        ("east", {"kind": "exclude", "sensor": "D1", "until": IN_ORDER["until"]}, "ends before"),
        ("east", {"kind": "exclude", "sensor": "D1", "since": 5.0}, "with its zone"),
        ("east", {"kind": "exclude", "sensor": "D1", "since": "2026-11-23T12:00"}, "its zone"),
        ("east", {"kind": "exclude", "sensor": "D1", "until": BEYOND}, "behind the year 9999"),
        ("east", {"kind": "note"}, "a note has words"),
        ("east", {"kind": "accept", "why": ""}, "say why"),
        ("east", {"kind": "accept", "why": "a\0b"}, "control character"),
        ("east", {"kind": "accept", "why": "a\x1bb"}, "control character"),
    ],
)
def test_what_cannot_be_meant_is_refused_at_once(
    client: TestClient, service: Service, twin: str, command: dict[str, Any], told: str
) -> None:
    answer = client.post(f"/api/v1/twins/{twin}/commands", json=command)
    assert answer.status_code == 422, answer.text
    assert told in answer.json()["detail"]
    assert list(service.twins[twin].inbox.commands(0)) == []


def test_what_can_be_meant_is_kept(client: TestClient) -> None:
    later = {"since": "2026-11-23T10:00:00Z", "until": "2030-11-23T12:00:00Z"}
    asked(client, {"kind": "exclude", "sensor": "D1", "why": "two\nlines"} | later)
    asked(client, {"kind": "exclude", "sensor": "D1", "until": later["until"]})


def test_an_accept_that_waits_takes_no_later_proposal(client: TestClient, service: Service) -> None:
    number = asked(client, {"kind": "accept"})
    (_, waiting), *_ = service.twins["east"].inbox.commands(number - 1)
    assert isinstance(kept := read_command(waiting), Accept)
    assert kept.proposal == 1


def test_what_was_done_is_answered_again(client: TestClient, service: Service) -> None:
    number = asked(client, ACCEPT, key="k")
    play(service)
    assert asked(client, ACCEPT, key="k") == number


def test_script_in_words_stays_words(client: TestClient, service: Service) -> None:
    script = "<script>alert(1)</script>"
    number = asked(client, {"kind": "note", "why": script})
    play(service)
    assert state_of(client, number)["why"] == script
    answer = client.get(f"{EAST}/events")
    assert answer.headers["content-type"] == "application/json"
    assert answer.headers["X-Content-Type-Options"] == "nosniff"
    assert script in answer.json()[-1]["words"]
