"""The loop on the case study: reality is a frame with scatter, solved by independent physics."""

from pathlib import Path
from typing import Any

import pytest

import rga
from rga.inference import TrainingSettings
from rga.twin import Outcome, Settings
from rga_bench.synthetic import draw_stream

pytestmark = pytest.mark.usefixtures("without_reports")
ROWS = 180
SETTINGS = Settings(
    arl0=2000.0,
    design_rows=1024,
    training=TrainingSettings(steps=500, fine_steps=60, reduced_steps=300),
)


def run(folder: Path, **what: Any) -> tuple[Outcome, dict[str, Any]]:
    stream = draw_stream(3, rows=ROWS, **what)
    stream.write(folder)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    return rga.run(model, record, folder / "twin", settings=SETTINGS), stream.truth


@pytest.mark.thorough
def test_what_was_hidden_is_found_and_added(tmp_path: Path) -> None:
    outcome, truth = run(tmp_path)
    events = outcome.history.events
    order = ["calibration", "novel context", "alarm", "recalibration", "diagnosis", "version"]
    kinds = [event.kind for event in events]
    assert set(order) <= set(kinds)
    drift = truth["drift"]
    stored = [event.time for event in events if event.kind == "novel context"]
    assert any(drift["from"] <= time <= drift["until"] for time in stored)
    alarms = [event.time for event in events if event.kind == "alarm"]
    assert any(truth["onset"] <= time < truth["onset"] + 20 * 600 for time in alarms)
    (cause,) = (cause.effect for cause in outcome.findings.causes)
    hidden = {"kind": truth["kind"], **truth["place"]}
    assert {key: cause[key] for key in hidden} == hidden
    assert cause[truth["parameter"]]["value"] == pytest.approx(truth["value"], rel=0.1)
    # The recalibration before it has learned what the structure is like, and not why.
    first = next(event for event in events if event.kind == "version")
    doubted = [e for e in events if e.kind == "recalibration" and truth["onset"] <= e.time]
    assert doubted[0].gap_before is not None
    assert first.gap_after is not None
    assert first.gap_after < 0.7 * doubted[0].gap_before


def test_where_nothing_is_hidden_nothing_is_found(tmp_path: Path) -> None:
    outcome, _ = run(tmp_path, hidden=None, drift=False)
    assert outcome.findings.causes == []
    assert outcome.findings.verdict == "nothing_wrong"
    assert len(outcome.history.versions) == 1
    assert "novel context" not in {event.kind for event in outcome.history.events}
