"""What a diagnosis names becomes a version when somebody accepts it, and none before."""

from collections.abc import Callable
from pathlib import Path

import pytest

import rga
from live_streams import assert_same, commands, history, kinds
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.twin import Accept, Reject, Rollback, carry_out
from rga.twin.repository import Repository
from rga.twin.repository.entries import Proposal

Given = tuple[Model, Record]
TakenIn = Callable[..., Path]


def proposals(place: Path) -> tuple[Proposal, ...]:
    with Repository.open(place, read_only=True) as repository:
        return repository.latest().proposals()


def test_a_diagnosis_proposes_and_changes_nothing(sinks: Given, taken_in: TakenIn) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    with rga.Twin.open(place) as twin:
        assert twin.version == 1
        events = twin.history().events
        assert [one.number for one in twin.history().versions] == [1]
    assert kinds(events)[-2:] == ["diagnosis", "proposal"]
    (proposal,) = proposals(place)
    assert events[-1].words == f"proposal 1: {proposal.words}"
    assert "support settlement" in proposal.words
    assert proposal.gain is not None
    assert proposal.gain > 0


def test_an_end_that_finds_the_same_does_not_propose_it_again(
    sinks: Given, taken_in: TakenIn
) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    with rga.LiveTwin(place) as twin:
        twin.end()
        twin.play()
        events = history(twin).events
    (proposal,) = proposals(place)
    assert kinds(events)[-2:] == ["diagnosis", "proposal"]
    assert events[-1].words == f"proposal 1 stands: {proposal.words}"


@pytest.mark.parametrize("how", ["asked", "carried out"])
def test_what_is_accepted_is_what_is_adopted_at_once(
    how: str, sinks: Given, taken_in: TakenIn
) -> None:
    place, at_once = (taken_in(sinks, 90, adopt=adopt) for adopt in ("ask", "auto"))
    (proposal,) = proposals(place)
    outcome = f"proposal 1 is accepted: {proposal.words}"
    if how == "asked":
        with rga.LiveTwin(place) as asked:
            asked.ask(Accept(who="Ada", proposal=1))
            assert kinds(asked.play()) == ["version", "command"]
    else:
        assert carry_out(place, Accept(who="Ada")) == outcome
    (kept,) = commands(place)
    assert (kept.kind, kept.who, kept.body, kept.outcome) == (
        "accept",
        "Ada",
        {"proposal": 1},
        outcome,
    )
    found, expected = rga.Twin.open(place), rga.Twin.open(at_once)
    with found, expected:
        assert found.version == expected.version == 2
        assert found.state.versions == expected.state.versions
        assert found.state.versions[2] == proposal.effects
        assert found.history().versions == expected.history().versions
        whose = [one for one in found.history().events if one.kind not in ("proposal", "command")]
        assert tuple(whose) == expected.history().events
        assert proposals(at_once) == ()


def test_an_opened_twin_stays_as_it_stood_while_others_go_on(
    sinks: Given, taken_in: TakenIn
) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    with rga.Twin.open(place) as before:
        history_before, log, status = before.history(), before.log(), before.status()
        carry_out(place, Accept(who="Ada"))
        assert_same(before.history(), history_before)
        assert before.history().versions == history_before.versions
        assert before.log() == log
        assert before.status() == status
        assert before.commands() == ()
    with rga.Twin.open(place) as after:
        assert after.version == 2
        assert [one.number for one in after.history().versions] == [1, 2]
        assert len(after.commands()) == 1


def test_the_rows_after_it_are_followed_as_if_adopted_at_once(
    sinks: Given, taken_in: TakenIn
) -> None:
    found = []
    for adopt in ("ask", "auto"):
        with rga.LiveTwin(taken_in(sinks, 90, adopt=adopt)) as twin:
            if adopt == "ask":
                twin.ask(Accept(who="Ada"))
            twin.feed(sinks[1])
            twin.play()
            found.append(history(twin))
    assert found[0].simulated.tobytes() == found[1].simulated.tobytes()
    assert found[0].gaps.tobytes() == found[1].gaps.tobytes()


def test_what_is_rejected_stays_out(sinks: Given, taken_in: TakenIn) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    untouched = taken_in(sinks, 90, adopt="ask")
    with rga.LiveTwin(place) as twin:
        twin.ask(Reject(who="Ada", why="the bearing was levelled"))
        assert kinds(twin.play()) == ["command"]
        twin.feed(sinks[1])
        twin.play()
        rejected = history(twin)
    with rga.LiveTwin(untouched) as twin:
        twin.feed(sinks[1])
        twin.play()
        expected = history(twin)
    (kept,) = commands(place)
    assert (kept.body, kept.outcome) == ({"proposal": 1}, "proposal 1 is rejected")
    assert [one.number for one in rejected.versions] == [1]
    assert rejected.simulated.tobytes() == expected.simulated.tobytes()
    assert [one for one in rejected.events if one.kind != "command"] == list(expected.events)


@pytest.mark.parametrize("first", [Accept, Reject])
@pytest.mark.parametrize("second", [Accept, Reject])
def test_nobody_decides_twice(first: type, second: type, sinks: Given, taken_in: TakenIn) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    with rga.LiveTwin(place) as twin:
        twin.ask(first(who="Ada"))
        twin.ask(second(who="Bob"))
        twin.play()
        decided = history(twin)
    kind = first.__name__.lower()
    one, other = commands(place)
    assert "refused" not in one.body
    assert other.outcome.startswith(f"refused: proposal 1 was decided by Ada: {kind}")
    with pytest.raises(InputError, match=f"proposal 1 was decided by Ada: {kind}"):
        carry_out(place, second(who="Bob", proposal=1))
    with rga.Twin.open(place) as stored:
        assert_same(stored.history(), decided)
        assert stored.version == (2 if first is Accept else 1)


def test_what_was_refused_may_be_decided_yet(sinks: Given, taken_in: TakenIn) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    with rga.LiveTwin(place) as twin:
        twin.ask(Accept(who="Ada", proposal=2))
        twin.ask(Accept(who="Ada", proposal=1))
        twin.play()
    assert ["refused" in one.body for one in commands(place)] == [True, False]
    assert "proposal 2 is not the last, which is 1" in commands(place)[0].outcome
    with rga.Twin.open(place) as stored:
        assert stored.version == 2


def test_an_accepted_version_can_be_taken_back(sinks: Given, taken_in: TakenIn) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    with rga.LiveTwin(place) as twin:
        for command in (Accept(who="Ada"), Rollback(who="Ada", version=1)):
            twin.ask(command)
        assert kinds(twin.play()) == ["version", "command", "rollback", "command"]
        assert twin.twin.version == 1
        twin.ask(Rollback(who="Ada", version=2))
        twin.play()
        with twin.twin as stored:
            assert stored.version == 2
            assert stored.state.versions[2] == proposals(place)[0].effects


def test_the_null_twin_is_proposed_nothing(sound: Given, taken_in: TakenIn) -> None:
    place = taken_in(sound, 100, adopt="ask")
    with rga.LiveTwin(place) as twin:
        assert twin.end().findings.verdict == "nothing_wrong"
        found = kinds(history(twin).events)
    assert proposals(place) == ()
    assert found == ["calibration", "diagnosis"]
    with pytest.raises(InputError, match="nothing is proposed"):
        carry_out(place, Accept(who="Ada"))


def test_what_a_later_diagnosis_does_not_name_is_withdrawn(
    sinks: Given, sound: Given, taken_in: TakenIn, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    nothing = rga.diagnose(*sound)
    assert nothing.causes == []
    monkeypatch.setattr("rga.twin.runner.PastDiagnosis.ask", lambda *_: nothing)
    with rga.LiveTwin(place) as twin:
        twin.feed(sinks[1])
        twin.end()
        words = [one.words for one in history(twin).events if one.kind == "proposal"]
    assert words[1:] == ["proposal 1 is withdrawn: a later diagnosis does not propose it again"]
    (kept,) = commands(place)
    assert (kept.kind, kept.who, kept.outcome) == ("reject", "rga", "withdrawn")
    with pytest.raises(InputError, match="proposal 1 was decided by rga: reject"):
        carry_out(place, Accept(who="Ada"))


def test_a_version_that_makes_the_gap_larger_does_not_come_into_force(
    sinks: Given, taken_in: TakenIn, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = taken_in(sinks, 90, adopt="ask")
    monkeypatch.setattr("rga.twin.analysis.WORSE", 0.0)
    outcome = carry_out(place, Accept(who="Ada"))
    assert outcome.endswith("but did not come into force")
    with rga.Twin.open(place) as stored:
        assert stored.version == 1
