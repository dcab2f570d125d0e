"""The twin on the measured crossing: the train's position by the network, alarm and diagnosis."""

from pathlib import Path

import numpy as np
import pytest

import rga
from rga.cli.operation.settings import read_settings
from rga.inference import TrainingSettings

EXAMPLE = Path(__file__).parents[2] / "examples" / "rdso45m"
RECORD = Path(__file__).parents[3] / "shared" / "measured" / "rdso45m" / "record_40kmh.txt"
THINNED = 6
LITTLE = TrainingSettings(steps=450, fine_steps=60, reduced_steps=350)


@pytest.mark.thorough
def test_the_crossing_ends_in_the_verdict_of_the_diagnosis(tmp_path: Path) -> None:
    if not RECORD.exists():
        pytest.skip("the measured record is not part of this project")
    model = rga.load_model(EXAMPLE / "model.json")
    record = rga.load_record(RECORD, model, EXAMPLE / "import.toml")
    # A sixth of the samples, and networks that learn less, tell the same in a third of the time.
    record = record.rows(slice(None, None, THINNED))
    settings = read_settings(EXAMPLE / "settings.toml", "B").model_copy(update={"training": LITTLE})
    outcome = rga.run(model, record, tmp_path, settings=settings)
    findings, history = outcome.findings, outcome.history
    assert findings.verdict == "partial"
    causes = [cause.effect for cause in findings.causes]
    assert [cause["kind"] for cause in causes] == ["sensor_fault", "floor_participation"]
    assert (causes[0]["sensor"], causes[1]["group"]) == ("S33", "bottom chord")

    # The diagnosis finds the line of the train by a search of its own: the twin must agree.
    line = findings.contexts["train"]
    rate = line["rate [m/s]"]
    chosen = np.flatnonzero(np.isin(record.time, findings.account.record.time))
    position = line["at the first analysed row [m]"] + rate * (record.time - record.time[chosen[0]])
    inferred = history.inferred[:, 0]
    crossing = chosen[len(chosen) // 3 :]
    off = np.abs(inferred - position)[crossing]
    assert np.median(off) < 0.5
    assert np.max(off) < 3.0
    # Before the train is there, nothing tells where it is.
    assert (history.spread[: 4000 // THINNED, 0] > 100).mean() > 0.9
    first = next(event for event in history.events if event.kind == "alarm")
    assert -5.0 < position[first.row] < 10.0
    assert "diagnosis" in {event.kind for event in history.events}
