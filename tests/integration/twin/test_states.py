"""What was learned under conditions that come again is taken up again (level C)."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import rga
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.twin import Settings
from rga.twin.calibration.states import State
from rga.twin.changes import diagnose_change
from rga.twin.hardware.recorded import Recorded
from rga.twin.history import Event
from rga.twin.runner import Running, taken_up
from rga.twin.simulation_model import SimulationModel

#: rows in which a gauge is off, and by how many times its noise
OFF, SIZE = ((80, 120), (160, 200)), 12.0
PLAYED: dict[str, object] = {
    "inference": "joint",
    "detector": "monitor",
    "arl0": 1000.0,
    "settle": 20,
}


@pytest.fixture(scope="module")
def sound(small_stream: Callable[..., Path]) -> tuple[Model, Record, dict[str, object]]:
    """A model, a record in which nothing happens, and settings."""
    folder = small_stream(drifts=False, sinks=False, rows=220)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    return model, record, json.loads((folder / "settings.json").read_text(encoding="utf-8"))


def off(model: Model, record: Record, rows: tuple[tuple[int, int], ...] = OFF) -> Record:
    """The same record with a gauge that is off for a while, and again later."""
    readings = record.readings.copy()
    name = record.sensors[0]
    for first, end in rows:
        readings[first:end, 0] += SIZE * float(model.sensors[name].noise or 0.0)
    return replace(record, readings=readings, sha256="off")


def played(
    given: tuple[Model, Record, dict[str, object]], folder: Path, level: str, stop: int = 10**6
) -> tuple[Event, ...]:
    """Events of a run without diagnoses, up to a row."""
    model, record, settings = given
    chosen = Settings.model_validate(settings | PLAYED | {"level": level})
    folder.mkdir(exist_ok=True)
    with taken_up(model, record, folder / "twin.sqlite", chosen, 0) as running:
        while running.stage not in ("close", "report") and running.row < stop:
            step(running)
        return running.history().events


def step(running: Running) -> None:
    if running.stage == "diagnose":
        running.postpone("not asked here")
    else:
        running.step()


@pytest.fixture(scope="module")
def whole(
    sound: tuple[Model, Record, dict[str, object]], tmp_path_factory: pytest.TempPathFactory
) -> tuple[Event, ...]:
    """What a twin of level C lives through where the gauge is off."""
    model, record, settings = sound
    return played((model, off(model, record), settings), tmp_path_factory.mktemp("whole"), "C")


def test_c_takes_up_what_b_learns_anew(
    sound: tuple[Model, Record, dict[str, object]], whole: tuple[Event, ...], tmp_path: Path
) -> None:
    model, record, settings = sound
    found = {"B": played((model, off(model, record), settings), tmp_path, "B"), "C": whole}
    recalls = {
        level: [one for one in events if one.kind == "recall"] for level, events in found.items()
    }
    assert recalls["B"] == []
    learned = {
        level: [e.kind for e in events].count("recalibration") for level, events in found.items()
    }
    assert learned["C"] < learned["B"]
    healed = recalls["C"][0]
    # The gauge is as it was in the calibration again.
    assert OFF[0][1] <= healed.row < OFF[1][0]
    assert "are as rows 0 to 39 were" in healed.words
    assert "in doubt" not in healed.words
    again = [one for one in recalls["C"] if OFF[1][0] <= one.row < OFF[1][1] + 20]
    assert any("in doubt as it was there" in one.words for one in again)
    assert healed.gap_after is not None
    assert healed.gap_before is not None
    assert healed.gap_after < healed.gap_before


def test_nothing_is_recalled_where_nothing_happened(
    sound: tuple[Model, Record, dict[str, object]], tmp_path: Path
) -> None:
    kinds = {event.kind for event in played(sound, tmp_path, "C")}
    assert not kinds & {"recall", "recalibration"}


def test_states_outlive_an_interruption(
    sound: tuple[Model, Record, dict[str, object]], whole: tuple[Event, ...], tmp_path: Path
) -> None:
    model, record, settings = sound
    given = model, off(model, record), settings
    for stop in (90, 130, 140, 175):
        played(given, tmp_path, "C", stop)
    assert played(given, tmp_path, "C") == whole


def test_a_run_by_an_estimator_of_ones_own_is_not_resumed(
    sound: tuple[Model, Record, dict[str, object]], tmp_path: Path
) -> None:
    from rga.twin.calibration.joint_posterior import JointEstimator

    class Own(JointEstimator):
        kind = "own"

    model, record, settings = sound
    chosen = Settings.model_validate(settings | PLAYED)
    place = tmp_path / "twin.sqlite"
    with taken_up(model, record, place, chosen, 0, learn=Own.learn) as running:
        while running.row < 60:
            step(running)
        words = next(one.words for one in running.events if one.kind == "calibration")
        assert "of the caller's own" in words
        assert np.isfinite(running.gap)
    again = taken_up(model, record, place, chosen, 0, learn=Own.learn)
    with pytest.raises(InputError, match="cannot be resumed"), again:
        pass
    with (
        pytest.raises(InputError, match="the caller's own"),
        taken_up(model, record, place, chosen, 0),
    ):
        pass


def test_what_is_learned_in_doubt_is_kept_in_doubt(
    sound: tuple[Model, Record, dict[str, object]], tmp_path: Path
) -> None:
    model, record, settings = sound
    clock = settings | PLAYED | {"level": "C", "policy": "hybrid", "interval": 30}
    begun = 80
    with taken_up(
        model,
        off(model, record, ((begun, 220),)),
        tmp_path / "twin.sqlite",
        Settings.model_validate(clock),
        0,
    ) as running:
        while running.stage not in ("close", "report"):
            step(running)
        states, standing = running.calibration.states, running.analysis.standing
        # A recalibration by the clock that explains faulty rows takes no doubt away.
        assert standing.doubted
        assert {one.doubted for one in states if one.rows[1] > begun} == {True}
        assert not states[0].doubted
        learned_of = [one.rows for one in states if one.estimator is running.calibration.sound]
        assert all(end <= begun for _, end in learned_of)


def test_a_fault_that_begins_as_another_ends_leaves_the_doubt(
    sound: tuple[Model, Record, dict[str, object]], tmp_path: Path
) -> None:
    model, record, settings = sound
    readings, sensors = record.readings.copy(), list(record.sensors)
    for name, rows, size in (
        (sensors[0], slice(80, 160), SIZE),
        (sensors[5], slice(160, None), 3.5),
    ):
        readings[rows, sensors.index(name)] += size * float(model.sensors[name].noise or 0.0)
    given = model, replace(record, readings=readings, sha256="two"), settings
    asked = [one.row for one in played(given, tmp_path, "C") if one.kind == "diagnosis"]
    assert asked
    assert max(asked) > 160


def test_a_state_of_networks_is_what_it_was(
    sound: tuple[Model, Record, dict[str, object]], tmp_path: Path
) -> None:
    model, record, settings = sound
    # Of 40 rows that say what is usual a thousand rows let an alarm come before the fault does.
    rare = {"arl0": 10_000.0}
    chosen = settings | PLAYED | rare | {"level": "C", "inference": "amortised"}
    given_model = SimulationModel(model, Recorded(record, model).station)
    with taken_up(
        model, off(model, record), tmp_path / "twin.sqlite", Settings.model_validate(chosen), 0
    ) as running:
        while running.row < 130:
            step(running)
        calibration = running.calibration
        ledger, states = calibration.ledger, calibration.states
        assert len(states) > 1
        laws = [list(model.context.values())[column] for column in calibration.latent]
        rows = ledger.rows(0, len(ledger))
        given = 0, rows.readings, rows.contexts, rows.time, laws
        for state in states:
            again = State.from_bytes(state.to_bytes(), lambda version: given_model)
            assert (again.rows, again.doubted) == (state.rows, state.doubted)
            for one, other in zip(
                state.estimator.infer(*given), again.estimator.infer(*given), strict=True
            ):
                np.testing.assert_array_equal(one, other)


@pytest.mark.thorough
def test_findings_written_after_an_interruption_are_those_of_the_run(
    small_stream: Callable[..., Path], tmp_path: Path
) -> None:
    folder = small_stream(drifts=False, sinks=True, rows=160)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    settings = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    chosen = Settings.model_validate(settings | PLAYED)
    place = tmp_path / "twin.sqlite"
    with taken_up(model, record, place, chosen, 0) as running:
        while running.stage != "report":
            running.step()
        found = running.findings()
        assert found.to_json() == running.stored_findings().to_json()
        given = running.calibration.given
        assert given is not None
        assert given.found is not None
        assert given.correction is not None
        # What begins no later than the calibration ends is no change since then.
        late = diagnose_change(
            model,
            record,
            given.found,
            given.correction,
            since=record.origin + float(record.time[-1]),
            criteria=chosen.criteria,
            seed=0,
            progress=lambda stage, done: None,
        )
        assert late is None
    assert "has changed since the calibration" in " ".join(found.warnings)
    assert [one.effect["kind"] for one in found.causes] == ["support_settlement"]
    assert found.model_sha256 == model.sha256
    extended = found.account.extended
    assert len(set(extended.effects) - set(model.effects)) == len(found.causes)
    with taken_up(model, record, place, chosen, 0) as again:
        assert again.stage == "report"
        assert again.findings().to_json() == found.to_json()
