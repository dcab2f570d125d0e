"""The monitor in the twin: alarms about residuals, beside twins without a change."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import rga
from rga.twin import Settings
from rga.twin.history import History
from rga.twin.runner import taken_up
from rga.twin.sync.detector import synchrony
from rga.twin.sync.monitor import Monitored
from rga.twin.sync.protocol import OutOfSync, Residuals
from rga.twin.sync.window_rule import WindowRule

CHANNELS = ("D1", "D2", "dead", "stuck", "S1")
Rows = NDArray[np.float64]


def residuals(rows: int = 300, *, step: float = 0.0) -> Rows:
    """Noise of the residuals of five channels; S1 has a step at row 200."""
    draw = np.random.default_rng(4).standard_normal((rows, 5)) * [0.1, 2.0, 1.0, 1.0, 5.0]
    draw[:, 2] = np.nan
    draw[:, 3] = 0.7
    draw[200:, 4] += step
    return draw


def reader(rows: Rows) -> Residuals:
    return lambda first, end: rows[first:end]


def watched(detector: Monitored, rows: Rows, first: int, packet: int) -> OutOfSync | None:
    for start in range(first, len(rows), packet):
        found = detector.alarm(start, min(start + packet, len(rows)), reader(rows))
        if found is not None:
            return found
    return None


def test_a_step_is_reported_with_its_sensor_and_onset() -> None:
    rows = residuals(step=15.0)
    detector = Monitored(CHANNELS, Settings())
    detector.begin_again(0, 100, reader(rows))
    found = watched(detector, rows, 100, 10)
    assert found is not None
    assert found.sensors == ("S1",)
    assert 198 <= found.since <= found.row <= 205
    assert "in S1 since row" in found.words


def test_without_a_step_there_is_no_alarm() -> None:
    rows = residuals()
    detector = Monitored(CHANNELS, Settings())
    detector.begin_again(0, 100, reader(rows))
    assert watched(detector, rows, 100, 10) is None


def test_packets_of_any_size_and_restarts_find_the_same() -> None:
    rows = residuals(step=15.0)
    found = []
    for packet in (1, 7, 50):
        detector = Monitored(CHANNELS, Settings())
        detector.begin_again(0, 100, reader(rows))
        assert watched(detector, rows[:150], 100, packet) is None
        resumed = Monitored(CHANNELS, Settings())
        resumed.restore(detector.to_bytes())
        alarm = watched(resumed, rows, 150, packet)
        assert alarm is not None
        found.append(alarm.row)
    assert len(set(found)) == 1


def test_what_a_recalibration_dealt_with_is_usual_from_then_on() -> None:
    rows = residuals(step=15.0)
    detector = Monitored(CHANNELS, Settings())
    detector.begin_again(0, 100, reader(rows))
    assert watched(detector, rows[:260], 100, 10) is not None
    detector.begin_again(None, 260, reader(rows))
    assert watched(detector, rows, 260, 10) is None


def test_few_rows_are_waited_for() -> None:
    rows = residuals(step=15.0)
    detector = Monitored(CHANNELS, Settings())
    detector.begin_again(0, 10, reader(rows))
    restored = Monitored(CHANNELS, Settings())
    restored.restore(detector.to_bytes())
    found = watched(restored, rows, 10, 10)
    assert found is not None
    assert 198 <= found.since <= found.row <= 215
    twin = residuals(step=0.0)
    quiet = Monitored(CHANNELS, Settings())
    quiet.begin_again(0, 10, reader(twin))
    assert watched(quiet, twin, 10, 10) is None


def test_channels_without_readings_are_never_reported() -> None:
    rows = np.full((80, 2), np.nan)
    detector = Monitored(("a", "b"), Settings())
    detector.begin_again(0, 40, reader(rows))
    assert watched(detector, rows, 40, 10) is None
    assert detector.warnings == ()


def test_settings_choose_the_detector() -> None:
    assert isinstance(synchrony(CHANNELS, Settings()), Monitored)
    assert isinstance(synchrony(CHANNELS, Settings(detector="window")), WindowRule)


def played(folder: Path, directory: Path) -> History:
    """What the twin lived through up to its closing diagnosis; others are put off."""
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    settings = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    chosen = Settings.model_validate(settings | {"detector": "monitor", "level": "B"})
    with taken_up(model, record, directory, chosen, 0) as running:
        while running.stage != "close":
            if running.stage == "diagnose":
                running.postpone("alarms are what is asked for")
            else:
                running.step()
        return running.history()


@pytest.mark.parametrize("sinks", [True, False])
def test_the_twin_reports_since_when_a_bearing_is_lower(
    sinks: bool, small_stream: Callable[..., Path], tmp_path: Path
) -> None:
    """A bearing sinks at row 105; in the null twin nothing does."""
    history = played(small_stream(drifts=False, sinks=sinks), tmp_path)
    alarms = [event for event in history.events if event.kind == "alarm"]
    assert bool(alarms) == sinks
    if sinks:
        assert 105 <= alarms[0].row < 112
        since = int(alarms[0].words.rsplit(" ", 1)[1])
        assert abs(since - 105) <= 2
