"""From files to findings through the command line, and on from the extended model."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga import Simulator, diagnose, load_model, load_record
from rga.findings import Findings
from rga.twin import Settings
from rga.twin.runner import taken_up
from rga_bench.synthetic import draw_case

SEED = 1028


@pytest.fixture
def case(tmp_path: Path) -> Path:
    """Model and record of a generated footbridge with an effect hidden."""
    draw_case(SEED, rows=160).write(tmp_path)
    return tmp_path


def test_files_in_findings_out(case: Path, rga: Callable[..., Any]) -> None:
    out = case / "out"
    # False alarms that come more often are told from by shorter streams.
    settings = case / "settings.json"
    settings.write_text('{"arl0": 2000}', encoding="utf-8")
    files = case / "model.json", case / "record.csv"
    done = rga("run", *files, "-o", out, "--seed", "3", "--settings", settings)
    assert done.code == 0
    assert str(out / "report.html") in done.out
    assert sorted(path.name for path in out.iterdir()) == [
        "findings.json",
        "model.json",
        "report.html",
        "twin.sqlite",
        "twin.sqlite.lock",
    ]
    text = (out / "findings.json").read_text(encoding="utf-8")
    findings = Findings.model_validate_json(text)
    assert findings.seed == 3
    assert findings.gap.held_out.gain_ci90[0] > 0
    assert f"Verdict: {findings.verdict}. {findings.sentence()}" in done.out
    told = [line for line in done.err.splitlines() if line.startswith("warning: ")]
    assert told == [f"warning: {one}" for one in findings.warnings]
    assert "http" not in (out / "report.html").read_text(encoding="utf-8").replace(
        "http://www.w3.org/", ""
    )

    extended = load_model(out / "model.json")
    added = set(extended.effects) - set(load_model(case / "model.json").effects)
    assert len(added) == len(findings.causes)
    again = diagnose(extended, load_record(case / "record.csv", extended))
    assert again.gap.before == pytest.approx(findings.gap.after, rel=0.2)
    assert again.causes == []


@pytest.mark.usefixtures("without_reports")
def test_results_of_another_run_are_not_replaced_without_a_word(
    case: Path, rga: Callable[..., Any]
) -> None:
    out = case / "out"
    record = case / "record.csv"
    assert rga("diagnose", case / "model.json", record, "-o", out, "--seed", "4").code == 0
    lines = record.read_text(encoding="utf-8").splitlines(keepends=True)
    (case / "short.csv").write_text("".join(lines[:60]), encoding="utf-8")
    done = rga("run", case / "model.json", case / "short.csv", "-o", out, "--level", "A")
    assert "holds the results of a run with another record and seed" in done.err
    assert "row 18  calibration: calibrated on 19 rows" in done.out
    done = rga("run", case / "model.json", case / "short.csv", "-o", out, "--level", "A")
    assert "holds the results" not in done.err


@pytest.mark.usefixtures("without_reports")
def test_a_run_that_goes_on_tells_what_happened_before(case: Path, rga: Callable[..., Any]) -> None:
    out = case / "out"
    out.mkdir()
    model = load_model(case / "model.json")
    record = load_record(case / "record.csv", model)
    with taken_up(model, record, out / "twin.sqlite", Settings(level="A"), 0) as running:
        while running.stage != "watch":
            running.step()
        (before,) = running.events
    files = case / "model.json", case / "record.csv"
    done = rga("run", *files, "-o", out, "--level", "A")
    told = done.out.splitlines()
    assert before.words in told[0]
    assert told[1] == "The run goes on at row 53."
    assert sum(before.words in line for line in told) == 1


def test_a_calibration_longer_than_the_record_is_refused(
    case: Path, rga: Callable[..., Any]
) -> None:
    settings = case / "settings.json"
    settings.write_text('{"calibration_rows": 161}', encoding="utf-8")
    files = case / "model.json", case / "record.csv"
    done = rga("run", *files, "-o", case / "out", "--settings", settings)
    assert done.code == 2
    assert "the calibration wants 161 rows, and the record has 160" in done.err


def test_a_context_outside_its_range_is_reported(case: Path) -> None:
    content = json.loads((case / "model.json").read_text(encoding="utf-8"))
    content["context"]["air"]["range"] = [0.0, 1.0]
    (case / "model.json").write_text(json.dumps(content), encoding="utf-8")
    model = load_model(case / "model.json")
    findings = diagnose(model, load_record(case / "record.csv", model).rows(slice(60)))
    assert any("air" in warning for warning in findings.warnings)
    assert any("air" in line for line in findings.write(case / "out").read_text().splitlines())


def test_a_latent_context_is_inferred(case: Path) -> None:
    """Without its channel the load is inferred row by row, near what was measured."""
    model = load_model(case / "model.json")
    record = load_record(case / "record.csv", model)
    measured = record.contexts.pop("people")
    findings = diagnose(model, record)
    shown = Simulator(model).predict({**record.contexts, "time": record.time, "people": measured})
    assert "inferred mean [kN/m]" in findings.contexts["people"]
    before = findings.account.before
    rows = np.isin(record.time, findings.account.record.time)
    seen = np.isfinite(before)
    correlation = np.corrcoef(before[seen], shown[rows][seen])[0, 1]
    assert correlation > 0.98
