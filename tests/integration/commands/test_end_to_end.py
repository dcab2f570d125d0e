"""From files to findings through the command line, and on from the extended model."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga import Simulator, diagnose, load_model, load_record
from rga.findings import Findings
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


def test_same_seed_same_bytes(case: Path) -> None:
    model = load_model(case / "model.json")
    record = load_record(case / "record.csv", model)
    assert diagnose(model, record, seed=5).to_json() == diagnose(model, record, seed=5).to_json()


def test_a_context_outside_its_range_is_reported(case: Path) -> None:
    content = json.loads((case / "model.json").read_text(encoding="utf-8"))
    content["context"]["air"]["range"] = [0.0, 1.0]
    (case / "model.json").write_text(json.dumps(content), encoding="utf-8")
    model = load_model(case / "model.json")
    findings = diagnose(model, load_record(case / "record.csv", model))
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
