"""What people ask a twin for is done once and in its order, and stays with who, when and why."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import rga
from live_streams import SETTINGS, commands, history, kinds
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.twin import Accept, Exclude, Note, Recalibrate, Reject, Rollback, carry_out, rollback

Given = tuple[Model, Record]
BY: dict[str, str] = {"who": "Ada", "why": "as said", "given_at": "2026-11-26T12:00:00+00:00"}
#: commands, the body that is kept of each, and what comes of it
DONE: list[tuple[Any, dict[str, Any], str]] = [
    (Note(**BY), {}, "noted"),
    (Rollback(version=1, **BY), {"version": 1}, "version 1 stays in force, as asked"),
    (
        Exclude(sensor="D1", **BY),
        {"sensor": "D1", "since": None, "until": None},
        "D1 is not used from now on",
    ),
    (
        Exclude(sensor="D1", since=4e4, until=5e4, **BY),
        {"sensor": "D1", "since": 4e4, "until": 5e4},
        "D1 is not used from 40000.0 to 50000.0; rows that were followed stay as they are",
    ),
]
#: those that cannot be done by a twin that has found nothing, and what it says
REFUSED: list[tuple[Any, str]] = [
    (Rollback(version=9, **BY), "there is no version 9"),
    (Exclude(sensor="D9", **BY), "there is no sensor 'D9'"),
    (Exclude(sensor="D1", since=500.0, until=400.0, **BY), "ends before it begins"),
    (Exclude(sensor="D1", until=400.0, **BY), "ends before it begins"),
    (Exclude(sensor="D1", since="2026-03-01T12:00", **BY), "is none"),
    (Accept(**BY), "nothing is proposed"),
    (Reject(proposal=1, **BY), "nothing is proposed"),
]


def names(given: list[Any]) -> list[str]:
    return [f"{one[0].kind} {number}" for number, one in enumerate(given)]


@pytest.mark.parametrize("how", ["asked", "carried out"])
@pytest.mark.parametrize(("command", "body", "outcome"), DONE, ids=names(DONE))
def test_a_command_is_done_and_kept(
    how: str,
    command: Any,
    body: dict[str, Any],
    outcome: str,
    sound: Given,
    ended: Path,
    taken_in: Callable[..., Path],
    tmp_path: Path,
) -> None:
    if how == "asked":
        place = taken_in(sound, 80)
        with rga.LiveTwin(place) as twin:
            twin.ask(command)
            happened = twin.play()
        row = 79
    else:
        place = shutil.copytree(ended, tmp_path / "copy")
        assert carry_out(place, command) == outcome
        with rga.Twin.open(place) as stored:
            happened = list(stored.history().events)
        row = 99
    (kept,) = commands(place)
    assert (kept.row, kept.kind, kept.body, kept.outcome) == (row, command.kind, body, outcome)
    assert (kept.who, kept.why, kept.given_at) == ("Ada", "as said", BY["given_at"])
    last = happened[-1]
    assert (last.kind, last.row) == ("command", row)
    assert last.words == f"Ada asked to {command.kind} (as said): {outcome}"
    with rga.Twin.open(place) as stored:
        assert stored.version == 1
        assert last in stored.history().events
        assert any(last.words in words for _, _, words in stored.log())


@pytest.mark.parametrize(("command", "why"), REFUSED, ids=names(REFUSED))
def test_what_cannot_be_done_is_refused_and_the_twin_goes_on(
    command: Any, why: str, sound: Given, ended: Path, taken_in: Callable[..., Path], tmp_path: Path
) -> None:
    place = taken_in(sound, 80)
    with rga.LiveTwin(place) as twin:
        twin.ask(command)
        (event,) = twin.play()
        assert (event.kind, event.row) == ("command", 79)
        assert why in event.words
        assert "refused" in event.words
        twin.feed(sound[1])
        assert twin.play() == []
        found = history(twin)
    (kept,) = commands(place)
    assert kept.body["refused"] is True
    assert kept.outcome.startswith("refused: ")
    assert why in kept.outcome
    assert len(found.record) == 100
    copy = shutil.copytree(ended, tmp_path / "copy")
    with pytest.raises(InputError, match=why):
        carry_out(copy, command)
    assert commands(copy) == ()


def test_a_refused_command_changes_nothing_that_follows(
    sound: Given, taken_in: Callable[..., Path]
) -> None:
    found = []
    for asked in (True, False):
        with rga.LiveTwin(taken_in(sound, 80)) as twin:
            if asked:
                twin.ask(Rollback(version=9, **BY))
                twin.play()
            twin.feed(sound[1])
            twin.play()
            found.append(history(twin))
    events = [[one for one in past.events if one.kind != "command"] for past in found]
    assert events[0] == events[1]
    assert found[0].gaps.tobytes() == found[1].gaps.tobytes()


def test_a_recalibration_is_made_when_it_is_asked_for(
    sound: Given, ended: Path, taken_in: Callable[..., Path], tmp_path: Path
) -> None:
    place = taken_in(sound, 80)
    with rga.LiveTwin(place) as twin:
        twin.ask(Recalibrate(**BY))
        assert kinds(twin.play()) == ["recalibration", "command"]
    assert [one.outcome for one in commands(place)] == ["recalibrated"]
    copy = shutil.copytree(ended, tmp_path / "copy")
    with pytest.raises(InputError, match="no rows are watched now"):
        carry_out(copy, Recalibrate(**BY))


@pytest.mark.parametrize(
    ("command", "outcome"),
    [
        (Note(**BY), "noted"),
        (Recalibrate(**BY), "refused: "),
        (Rollback(version=1, **BY), "version 1 stays in force"),
        (Exclude(sensor="D1", **BY), "D1 is not used from now on"),
    ],
)
def test_before_the_calibration_commands_stop_nothing(
    command: Any, outcome: str, sound: Given, taken_in: Callable[..., Path]
) -> None:
    place = taken_in(sound, 15)
    with rga.LiveTwin(place) as twin:
        twin.ask(command)
        twin.play()
        twin.feed(sound[1])
        twin.play()
        assert "calibration" in kinds(history(twin).events)
        assert len(history(twin).record) == 100
    (kept,) = commands(place)
    assert kept.outcome.startswith(outcome)
    assert kept.row < 15


def test_before_the_first_row_commands_wait(sound: Given, tmp_path: Path) -> None:
    with rga.live(sound[0], tmp_path, settings=SETTINGS) as twin:
        twin.ask(Note(**BY))
        assert twin.play() == []
        twin.feed(sound[1].rows(slice(0, 5)))
        assert kinds(twin.play()) == ["command"]
    assert [one.row for one in commands(tmp_path)] == [0]


def test_a_note_is_taken_by_a_twin_that_nobody_plays(
    sound: Given, taken_in: Callable[..., Path]
) -> None:
    place = taken_in(sound, 15)
    assert carry_out(place, Note(**BY)) == "noted"
    with rga.LiveTwin(place) as twin:
        twin.feed(sound[1])
        twin.play()
        assert len(history(twin).record) == 100
    assert [one.kind for one in commands(place)] == ["note"]


def test_commands_are_done_once_and_in_their_order(
    sound: Given, taken_in: Callable[..., Path]
) -> None:
    place = taken_in(sound, 80)
    wanted = [Note(who=f"person {number}") for number in range(8)]
    with rga.LiveTwin(place) as twin:
        assert [twin.ask(one) for one in wanted[:4]] == [1, 2, 3, 4]
    for stop in range(4):
        with rga.LiveTwin(place) as twin:
            twin.play(lambda running, stop=stop: running.commanded <= stop)
            twin.ask(wanted[4 + stop])
    with rga.LiveTwin(place) as twin:
        twin.play()
        assert twin.play() == []
    assert [one.who for one in commands(place)] == [one.who for one in wanted]
    assert [one.given_at for one in commands(place)] == [one.given_at for one in wanted]


def test_a_process_that_dies_within_a_command_has_done_nothing(
    sound: Given, taken_in: Callable[..., Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    place = taken_in(sound, 80)
    with rga.LiveTwin(place) as twin:
        twin.ask(Note(**BY))
        with monkeypatch.context() as broken:
            broken.setattr("rga.twin.checkpoint.Checkpoint.keep", _die)
            with pytest.raises(KeyboardInterrupt):
                twin.play()
        assert commands(place) == ()
        assert kinds(twin.play()) == ["command"]
    assert len(commands(place)) == 1


def _die(self: Any) -> None:
    raise KeyboardInterrupt


def test_rollback_says_who_asked(ended: Path, tmp_path: Path) -> None:
    place = shutil.copytree(ended, tmp_path / "copy")
    with rollback(place, 1, who="Ada", why="to see") as stored:
        assert stored.version == 1
    assert [(one.who, one.why) for one in commands(place)] == [("Ada", "to see")]


def test_a_recalibration_behind_a_rollback_is_about_the_version_in_force(
    sinks: Given, taken_in: Callable[..., Path]
) -> None:
    place = taken_in(sinks, 100)
    with rga.LiveTwin(place) as twin:
        assert twin.twin.version == 2
        twin.ask(Rollback(who="Ada", version=1))
        twin.ask(Recalibrate(who="Ada"))
        (recalibration,) = [one for one in twin.play() if one.kind == "recalibration"]
    assert recalibration.gap_before is not None
    assert recalibration.gap_before > 5.0
    assert "do not explain" in recalibration.words
