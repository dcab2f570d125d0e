"""The policies of synchronisation: when each recalibrates, and that a kill changes nothing."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

import rga
from rga.twin import Settings
from rga.twin.history import History
from rga.twin.policy import Policy
from rga.twin.running import taken_up
from rga.twin.settings import Pace
from rga.twin.standing import Standing

Stream = Callable[..., Path]
POLICIES = ("event", "time", "hybrid", "adaptive")


def policy(name: str, **more: Any) -> Policy:
    settings = Settings.model_validate({"policy": name} | more)
    return Policy.of(settings, Pace(calibration_rows=40, packet=10, settle=12, interval=30))


def after(rows: int, alarm: int | None = None, interval: int = 30) -> Standing:
    """So many rows after a calibration on 100 rows."""
    since = None if alarm is None else alarm - 3
    return Standing(
        row=100 + rows, synchronised=100, interval=interval, alarm=alarm, since=since
    )  # fmt: skip


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
    assert policy(name).due(standing, last) == expected


@pytest.mark.parametrize("name", POLICIES)
def test_level_a_never_recalibrates(name: str) -> None:
    assert policy(name, level="A").due(after(500, alarm=120), True) is None


def test_an_interval_follows_what_recalibrations_were_worth() -> None:
    adaptive = policy("adaptive", recovered=2.0)
    assert adaptive.next_interval(30, 1.0) == 30
    # A gap that grew to four times what is allowed has had twice the time.
    assert adaptive.next_interval(30, 4.0) == 15
    assert adaptive.next_interval(30, 100.0) == 15
    for gain in (0.0, -1.0, float("nan")):
        assert adaptive.next_interval(30, gain) == 60
    assert adaptive.next_interval(120, 0.0) == 120
    assert adaptive.next_interval(8, 100.0) == 8
    assert policy("hybrid").next_interval(30, 100.0) == 30


def test_an_interval_that_nothing_would_use_is_refused() -> None:
    with pytest.raises(ValidationError, match="policy 'event' has no interval"):
        Settings(interval=10)
    with pytest.raises(ValidationError):
        Settings(policy="time", interval=0)


def play(folder: Path, place: Path, *, steps: int | None = None, **settings: Any) -> History:
    """The stages of a run before its closing diagnosis, at most so many of them at a time."""
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
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
def drifting(small_stream: Stream) -> Path:
    """In rows 60 to 89 a load is far beyond all that it was before."""
    return small_stream(sinks=False)


def test_the_clock_recalibrates_where_nothing_happens(null: Path, tmp_path: Path) -> None:
    by_policy = {
        name: play(null, tmp_path / name, policy=name, **more)
        for name, more in {
            "event": {},
            "time": {"interval": 30},
            "hybrid": {"interval": 30},
            "adaptive": {"interval": 30},
        }.items()
    }
    found = {name: rows(history, "recalibration") for name, history in by_policy.items()}
    assert found["event"] == []
    assert found["time"] == found["hybrid"] == [69, 99, 129]
    # Nothing is gained, and the next one is later.
    assert found["adaptive"] == [69, 129]
    for history in by_policy.values():
        assert not rows(history, "alarm")
        assert len(history.versions) == 1
