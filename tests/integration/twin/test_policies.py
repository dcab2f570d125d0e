"""The policies of synchronisation: when each recalibrates, after a kill too, and what it costs."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from rga.inference import TrainingSettings
from rga.model import load_model
from rga.records import load_record
from rga.twin import Settings
from rga.twin.history import History
from rga.twin.run_state import Standing
from rga.twin.runner import taken_up
from rga.twin.settings import Pace
from rga.twin.sync.policy import Policy
from rga_bench.policies.experiment import PoliciesExperiment
from rga_bench.policies.mean_results import means
from rga_bench.policies.setting import STREAMS, PolicySetting
from rga_bench.policies.twin_run import PolicyResult, run_twin

Stream = Callable[..., Path]
POLICIES = ("event", "time", "hybrid", "adaptive")


def policy(name: str, **more: Any) -> Policy:
    settings = Settings.model_validate({"policy": name} | more)
    return Policy.of(settings, Pace(calibration_rows=40, packet=10, settle=12, interval=30))


def after(rows: int, alarm: int | None = None, interval: int = 30) -> Standing:
    """So many rows after a calibration on 100 rows."""
    since = None if alarm is None else alarm - 3
    return Standing(row=100 + rows, synchronised=100, interval=interval, alarm=alarm, since=since)


@pytest.mark.parametrize(
    ("name", "standing", "last", "expected"),
    [
        ("event", after(500), True, None),
        ("event", after(31, alarm=120), False, None),
        ("event", after(32, alarm=120), False, 117),
        ("event", after(21, alarm=120), True, 117),
        ("time", after(29), True, None),
        ("time", after(30), False, 100),
        ("time", after(29, alarm=101), True, None),
        ("time", after(30, alarm=101), False, 100),
        ("hybrid", after(29), False, None),
        ("hybrid", after(30), False, 100),
        ("hybrid", after(20, alarm=104), False, 101),
        # The clock does not wait for the rows of an alarm, which waits for its own.
        ("hybrid", after(29, alarm=120), False, None),
        ("hybrid", after(31, alarm=120), False, 100),
        ("hybrid", after(32, alarm=120), False, 117),
        ("adaptive", after(30, interval=60), False, None),
        ("adaptive", after(60, interval=60), False, 100),
        ("adaptive", after(20, alarm=104, interval=60), False, 101),
        # Never on fewer rows than a recalibration needs.
        ("time", after(5, interval=5), False, 93),
    ],
)
def test_when_a_recalibration_is_due(
    name: str, standing: Standing, last: bool, expected: int | None
) -> None:
    standing = standing.model_copy(update={"ended": last})
    assert policy(name).due(standing) == expected


@pytest.mark.parametrize("name", POLICIES)
def test_level_a_never_recalibrates(name: str) -> None:
    standing = after(500, alarm=120).model_copy(update={"ended": True})
    assert policy(name, level="A").due(standing) is None


def test_an_interval_follows_what_recalibrations_were_worth() -> None:
    adaptive = policy("adaptive")
    assert adaptive.next_interval(30, 1.0, 1.0) == 30
    # A gap that grew to four times what is allowed has had twice the time.
    assert adaptive.next_interval(30, 4.0, 1.0) == 15
    assert adaptive.next_interval(30, 100.0, 1.0) == 15
    for gain in (0.0, -1.0, float("nan")):
        assert adaptive.next_interval(30, gain, 1.0) == 60
    assert adaptive.next_interval(120, 0.0, 1.0) == 120
    assert adaptive.next_interval(8, 100.0, 1.0) == 8
    assert policy("hybrid").next_interval(30, 100.0, 1.0) == 30


def test_an_interval_that_nothing_would_use_is_refused() -> None:
    with pytest.raises(ValidationError, match="policy 'event' has no interval"):
        Settings(interval=10)
    with pytest.raises(ValidationError):
        Settings(policy="time", interval=0)


def play(folder: Path, place: Path, *, steps: int | None = None, **settings: Any) -> History:
    """The stages of a run before its closing diagnosis, at most so many of them at a time."""
    model = load_model(folder / "model.json")
    record = load_record(folder / "record.csv", model)
    wanted = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    chosen = Settings.model_validate(wanted | settings)
    place.mkdir(exist_ok=True)
    while True:
        with taken_up(model, record, place, chosen, 0) as running:
            done = 0
            while running.stage != "close" and (steps is None or done < steps):
                running.step()
                done += 1
            if running.stage == "close":
                return running.history()


def rows(history: History, kind: str) -> list[int]:
    return [event.row for event in history.events if event.kind == kind]


@pytest.fixture(scope="module")
def null(small_stream: Stream) -> Path:
    """Nothing drifts, and nothing is hidden."""
    return small_stream(drifts=False, sinks=False)


@pytest.fixture(scope="module")
def changed(small_stream: Stream) -> Path:
    """A heavy load comes and goes in rows 60 to 89, and from row 105 on a bearing is lower."""
    return small_stream()


@pytest.fixture(scope="module")
def quiet(null: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, History]:
    """What twins of each policy lived through where nothing happens."""
    place = tmp_path_factory.mktemp("quiet")
    return {
        name: play(null, place / name, policy=name, interval=None if name == "event" else 30)
        for name in POLICIES
    }


def test_the_clock_recalibrates_where_nothing_happens(quiet: dict[str, History]) -> None:
    found = {name: rows(history, "recalibration") for name, history in quiet.items()}
    assert found["event"] == []
    assert found["time"] == found["hybrid"] == [69, 99, 129]
    # Next to nothing is gained, and the next one is later.
    assert found["adaptive"][0] == 69
    assert found["adaptive"][1] > 99
    for history in quiet.values():
        assert not rows(history, "alarm")
        assert len(history.versions) == 1


@pytest.mark.parametrize(
    "name",
    [
        "event",
        pytest.param("time", marks=pytest.mark.thorough),
        "hybrid",
        pytest.param("adaptive", marks=pytest.mark.thorough),
    ],
)
def test_an_alarm_recalibrates_where_it_is_listened_to(
    name: str, changed: Path, tmp_path: Path
) -> None:
    """And whatever the policy, a diagnosis finds that the model is wrong."""
    history = play(changed, tmp_path, policy=name, interval=None if name == "event" else 30)
    (alarm,) = rows(history, "alarm")
    assert 105 <= alarm < 115
    found = rows(history, "recalibration")
    if name == "event":
        # The alarm comes in the packet up to row 109, and has 12 rows with that up to row 119.
        assert found == [119]
    elif name == "time":
        # Here it is told, and the clock goes on as before.
        assert found == [69, 99, 129]
    elif name == "hybrid":
        # Both: the clock begins anew with the recalibration of the alarm.
        assert found == [69, 99, 119, 149]
    else:
        # An alarm is not kept waiting by an interval that has adapted.
        assert 119 in found
    assert len(history.versions) == 2
    assert "support settlement" in history.versions[1].causes[0]


@pytest.mark.parametrize("happens", [False, pytest.param(True, marks=pytest.mark.thorough)])
def test_interrupted_after_every_step_it_ends_the_same(
    happens: bool, null: Path, changed: Path, tmp_path: Path
) -> None:
    """An interval that adapts is all that any policy has to remember, and an alarm besides."""
    given = {"policy": "adaptive", "interval": 30}
    stream = changed if happens else null
    whole = play(stream, tmp_path / "whole", **given)
    again = play(stream, tmp_path / "again", steps=1, **given)
    assert again.events == whole.events
    np.testing.assert_array_equal(again.gaps, whole.gaps)
    np.testing.assert_array_equal(again.inferred, whole.inferred)


#: as little as can be played
TRAINING = TrainingSettings(
    steps=40, fine_steps=10, reduced_steps=40, width=24, features=8, reduced_width=24
)
LITTLE = PolicySetting(
    streams=1,
    rows=72,
    clocks=(6,),
    settings=Settings(
        inference="networks", packet=12, arl0=2000.0, design_rows=128, training=TRAINING
    ),
)


@pytest.mark.thorough
def test_the_comparison(rga: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        "rga_bench.policies.experiment.shorter", lambda seed: replace(LITTLE, seed=seed)
    )
    folder, file = tmp_path / "out", tmp_path / "played.json"
    given = ("--quick", "--seed", "3", "--workers", "1", "-o", folder, "--json", file)
    ran = rga("benchmark", "policies", *given)
    assert ran.code == 0, ran.err
    assert "hybrid, 12 rows" in ran.out
    assert {path.name for path in folder.iterdir()} == {"policies.md", "policies.png"}
    page = (folder / "policies.md").read_text(encoding="utf-8")
    content = json.loads(file.read_text(encoding="utf-8"))
    assert content["command"] == "rga benchmark policies --quick --seed 3"
    assert content["command"] in page
    found = {(one["stream"], one["policy"]): one for one in content["played"]}
    assert len(found) == len(content["played"]) == 3 * 4
    for stream in STREAMS:
        assert f"| **{stream}** |" in page
        # Rows 24 to 71 are watched: the clock has room for four.
        assert found[stream, "time, 12 rows"]["recalibrations"] == 4
        assert found[stream, "time, 12 rows"]["steps"] == 4 * TRAINING.fine_steps
    for one in found.values():
        assert one["steps"] == one["recalibrations"] * TRAINING.fine_steps
        assert one["gap"] > 0
        assert 0 <= one["out_of_sync"] <= 1
    # The same seed gives the same, whatever was played before.
    for task in replace(LITTLE, seed=3).tasks()[-2:]:
        assert run_twin(task) == PolicyResult(**found[task.stream, task.policy])


def test_a_comparison_that_cannot_be_written_is_not_begun(
    rga: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(PoliciesExperiment, "measure", None)
    taken = tmp_path / "file"
    taken.touch()
    ran = rga("benchmark", "policies", "-o", taken)
    assert ran.code == 2
    assert "the output is a file" in ran.err


def test_means_are_those_of_a_policy_on_a_sort_of_stream() -> None:
    def played(stream: str, seed: int, gap: float) -> PolicyResult:
        return PolicyResult(stream, seed, "event", 1, 0, 0, 120, 0, gap, 0.5, 0.1, 3.0)

    found = means([played("a", 0, 1.0), played("b", 0, 9.0), played("a", 1, 2.0)])
    assert list(found) == [("a", "event"), ("b", "event")]
    assert found["a", "event"]["gap"] == 1.5
    assert found["b", "event"]["gap"] == 9.0
