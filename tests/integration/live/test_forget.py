"""Readings that somebody lets a twin forget: the latest stay, and what was said of the others."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from live_streams import SETTINGS, SINKS_AT, assert_same, history, kinds, play_step_by_step, sinking
from rga.errors import InputError
from rga.model import Model
from rga.records import Record, load_record
from rga.twin import Event, Forget, Settings, carry_out
from rga.twin.history import History
from rga.twin.past.chosen_past import BEGINNINGS
from rga.twin.rows.retention import ABOUT

Given = tuple[Model, Record]
ROWS, KEPT, ASKED_AT = 320, 64, 60
CALIBRATED = SETTINGS.calibration_rows or 0
#: a diagnosis of few rows, of which few need to be kept
FEW = SETTINGS.model_copy(
    update={"criteria": SETTINGS.criteria.model_copy(
        update={"record": SETTINGS.criteria.record.model_copy(update={"most_rows": KEPT})}
    )}
)  # fmt: skip


@pytest.fixture(scope="module", params=[False, True], ids=["nothing happens", "a bearing sinks"])
def stream(request: Any, sound: Given, measured_record: Callable[..., Record]) -> Given:
    model, sinks = sound[0], request.param
    return model, sinking(model, measured_record, ROWS, sinks=sinks)


def begun(given: Given, place: Path, settings: Settings = FEW) -> rga.LiveTwin:
    twin = rga.live(given[0], place, settings=settings)
    twin.feed(given[1].rows(slice(0, ASKED_AT)))
    twin.play()
    return twin


def played(given: Given, place: Path, keep: int | None) -> History:
    with begun(given, place) as twin:
        twin.ask(Forget(who="Ada", why="the disk is small", keep=keep, given_at="now"))
        twin.feed(given[1])
        twin.play()
        return history(twin)


@pytest.fixture(scope="module")
def both(
    stream: Given, tmp_path_factory: pytest.TempPathFactory
) -> dict[int | None, tuple[Path, History]]:
    """What a stream leaves behind, and where, in which old readings are forgotten or none are."""
    place = tmp_path_factory.mktemp("both")
    return {
        keep: (place / str(keep), played(stream, place / str(keep), keep)) for keep in (KEPT, None)
    }


def but_commands(events: tuple[Event, ...]) -> list[Event]:
    return [one for one in events if one.kind != "command"]


def test_old_readings_are_gone_and_the_rest_is_as_it_was(
    both: dict[int | None, tuple[Path, History]],
) -> None:
    (place, found), (_, whole) = both[KEPT], both[None]
    with rga.Twin.open(place) as twin:
        stretches = twin.forgotten
        assert "are forgotten" in twin.status().words()
    gone = np.zeros(ROWS, dtype=bool)
    for first, last in stretches:
        gone[first : last + 1] = True
    assert not gone[:CALIBRATED].any()
    assert not gone[ROWS - KEPT :].any()
    marks = [one.row for one in found.events if one.kind in BEGINNINGS]
    assert not any(gone[max(0, mark - ABOUT) : mark + ABOUT].any() for mark in marks)
    # What is not about a mark is gone but for the last few packets.
    near = [abs(np.arange(ROWS) - mark) < ABOUT + 10 for mark in marks]
    free = ~np.any([np.zeros(ROWS, dtype=bool), *near], axis=0)
    assert gone[CALIBRATED : ROWS - KEPT - 42][free[CALIBRATED : ROWS - KEPT - 42]].all()
    assert gone.any()
    for name in ("gaps", "simulated"):
        rows = getattr(found, name)
        assert np.isnan(rows[gone]).all()
        np.testing.assert_array_equal(rows[~gone], getattr(whole, name)[~gone])
    assert np.isnan(found.record.readings[gone]).all()
    assert np.isfinite(found.record.readings[~gone]).all()
    np.testing.assert_array_equal(found.record.time, whole.record.time)
    for name, column in whole.record.contexts.items():
        np.testing.assert_array_equal(found.record.contexts[name], column)
    assert but_commands(found.events) == but_commands(whole.events)


def test_the_past_can_be_asked_all_the_same(
    both: dict[int | None, tuple[Path, History]],
) -> None:
    kept, forgotten = (rga.Twin.open(both[keep][0]) for keep in (None, KEPT))
    for row in (50, 120, ROWS - 1):
        one, other = kept.as_of(row=row), forgotten.as_of(row=row)
        assert one.version == other.version
        assert one.context == other.context
        assert one.status().time == other.status().time
        assert [e.kind for e in one.history().events] == [e.kind for e in other.history().events]


def test_step_by_step_it_comes_to_the_same(
    stream: Given, both: dict[int | None, tuple[Path, History]], tmp_path: Path
) -> None:
    place = tmp_path / "step by step"
    with begun(stream, place) as twin:
        twin.ask(Forget(who="Ada", why="the disk is small", keep=KEPT, given_at="now"))
        twin.feed(stream[1])
    play_step_by_step(place)
    with rga.Twin.open(place) as found:
        assert_same(found.history(), both[KEPT][1])


def test_the_diagnosis_says_what_it_did_not_see(stream: Given, tmp_path: Path) -> None:
    with begun(stream, tmp_path) as twin:
        twin.ask(Forget(who="Ada", keep=KEPT))
        twin.feed(stream[1])
        findings = twin.end().findings
        happened = kinds(history(twin).events)
    assert any("are forgotten" in warning for warning in findings.warnings)
    if "alarm" in happened:
        (cause,) = findings.causes
        assert cause.effect["kind"] == "support_settlement"
        assert cause.onset == pytest.approx(600.0 * SINKS_AT, abs=600.0 * 10)
        assert cause.onset_ci90 is not None
        assert cause.onset_ci90[0] <= 600.0 * SINKS_AT <= cause.onset_ci90[1]
    else:
        assert findings.verdict == "nothing_wrong"
    assert (tmp_path / "report.html").exists()


def test_a_record_of_them_is_empty_there_and_says_so(
    sound: Given, measured_record: Callable[..., Record], tmp_path: Path, rga: Callable[..., Any]
) -> None:
    model = sound[0]
    record = sinking(model, measured_record, ROWS, sinks=False)
    played((model, record), tmp_path / "twin", KEPT)
    said = rga("export", tmp_path / "twin", "-o", tmp_path / "out.csv")
    assert said.code == 0
    assert f"rows from {CALIBRATED} to " in said.err
    back = load_record(tmp_path / "out.csv", model)
    assert len(back) == ROWS
    gone = np.isnan(back.readings).all(axis=1)
    np.testing.assert_array_equal(back.readings[~gone], record.readings[~gone])
    assert 0 < gone.sum() < ROWS - KEPT - CALIBRATED


def test_no_more_is_forgotten_when_all_are_to_be_kept(sound: Given, tmp_path: Path) -> None:
    with begun(sound, tmp_path) as twin:
        twin.ask(Forget(who="Ada", keep=KEPT))
        twin.ask(Forget(who="Ada", keep=None))
        twin.feed(sound[1])
        twin.play()
    with rga.Twin.open(tmp_path) as kept:
        assert kept.forgotten == ()


def test_what_a_diagnosis_needs_is_not_forgotten(sound: Given, tmp_path: Path) -> None:
    begun(sound, tmp_path, SETTINGS).close()
    with pytest.raises(InputError, match="fewer than the 800"):
        carry_out(tmp_path, Forget(who="Ada", keep=799))
    assert carry_out(tmp_path, Forget(who="Ada", keep=800)) == (
        "readings are kept of the latest 800 rows and of the calibration"
    )
