"""Criteria decide: a stricter one takes a name away, a looser one leaves a sound record alone."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import polars as pl
import pytest

from rga import Criteria, diagnose, load_findings, plan
from rga.errors import InputError
from rga.experiments.separation import success
from rga.findings import Findings
from rga.model import Model, read_model
from rga.model.io import model_content
from rga.records import Record

Rga = Callable[..., Any]
Recorded = Callable[..., Record]
CRACK = {"kind": "member_stiffness", "member": "U2-U3", "factor": 0.7, "onset": 30000.0}


@pytest.fixture(scope="module")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "measured bridge")


@pytest.fixture(scope="module")
def record(model: Model, measured_record: Recorded) -> Record:
    return measured_record(model, CRACK)


@pytest.fixture(scope="module")
def usual(model: Model, record: Record) -> Findings:
    return diagnose(model, record)


def with_figures(**groups: dict[str, float]) -> Criteria:
    return Criteria.model_validate(groups)


def test_by_default_the_crack_is_named(usual: Findings) -> None:
    (cause,) = usual.causes
    assert (usual.verdict, cause.effect["kind"]) == ("named", "member_stiffness")
    assert usual.criteria == Criteria()
    content = json.loads(usual.to_json())["criteria"]
    assert content == Criteria().model_dump()


def test_what_needs_more_log_odds_is_not_named(
    model: Model, record: Record, usual: Findings, tmp_path: Path, rga: Rga
) -> None:
    columns = {"time": record.time, **record.contexts}
    columns |= dict(zip(record.sensors, record.readings.T, strict=True))
    pl.DataFrame(columns).write_csv(tmp_path / "record.csv")
    (tmp_path / "model.json").write_text(json.dumps(model_content(model)), encoding="utf-8")
    listed, strict = tmp_path / "list.csv", tmp_path / "strict.toml"
    listed.write_text("name,model,record\nnorth,model.json,record.csv\n", encoding="utf-8")
    odds = 2 * usual.causes[0].log_odds
    strict.write_text(f"[naming]\nlog_odds = {odds}\n", encoding="utf-8")
    out = tmp_path / "out"
    assert rga("diagnose-many", listed, "-o", out, "--criteria", strict, "--workers", 1).code == 0
    findings = load_findings(out / "north")
    assert (findings.verdict, findings.causes) == ("unknown", [])
    assert findings.criteria.differing() == {"naming.log_odds": odds}
    assert "criterion naming.log_odds" in (out / "north" / "report.html").read_text("utf-8")


def test_its_null_twin_stays_sound(model: Model, measured_record: Recorded) -> None:
    """Where nothing is hidden nothing is named, by a looser criterion either."""
    loose = with_figures(naming={"log_odds": 4.6})
    findings = diagnose(model, measured_record(model), criteria=loose)
    assert (findings.verdict, findings.causes) == ("nothing_wrong", [])
    assert findings.criteria == loose


def test_rivals_are_counted_by_their_distance(
    model: Model, record: Record, usual: Findings
) -> None:
    found = usual.account.found
    assert found is not None
    ((nearest, *_),) = found.alternatives
    assert nearest.behind > Criteria().rivals.log_odds
    wide = with_figures(rivals={"log_odds": nearest.behind + 1.0, "listed": 1})
    findings = diagnose(model, record, criteria=wide)
    (cause,) = findings.causes
    assert findings.verdict == "ambiguous"
    assert len(cause.rivals) == 1
    # A plan goes by the criteria of its findings.
    (pair,) = plan(model, findings, sensors=1, positions=1).separations
    assert pair.d_perp > 0
    assert pair.expected == success(pair.d_perp, wide.rivals.log_odds)
    assert pair.expected < success(pair.d_perp, Criteria().rivals.log_odds)


def test_a_stricter_fit_says_that_structure_is_left(
    model: Model, record: Record, usual: Findings
) -> None:
    strict = with_figures(fit={"deviations": 0.02, "stated_noise": 1.0})
    findings = diagnose(model, record, criteria=strict)
    assert findings.verdict == "partial"
    assert [one.effect["kind"] for one in findings.causes] == ["member_stiffness"]
    for reason in ("against the model", "times its stated noise"):
        assert reason in findings.unexplained.looks_like
        assert reason not in usual.unexplained.looks_like


def test_rows_and_what_cannot_be_seen(model: Model, record: Record, usual: Findings) -> None:
    with pytest.raises(InputError, match="a diagnosis needs 101 at least"):
        diagnose(model, record, criteria=with_figures(record={"least_rows": 101}))
    few = with_figures(record={"most_rows": 50}, explanations={"smallest_d_prime": 30.0})
    findings = diagnose(model, record, criteria=few)
    assert len(findings.account.record) == 50
    assert any(warning.startswith("only 50 rows") for warning in findings.warnings)
    assert len(findings.unidentifiable) > len(usual.unidentifiable)


@pytest.mark.parametrize("command", ["diagnose", "diagnose-many"])
def test_a_wrong_file_ends_before_any_work(
    command: str, model_file: Path, tmp_path: Path, rga: Rga
) -> None:
    record, listed = tmp_path / "record.csv", tmp_path / "list.csv"
    record.write_text("time,D1,S1,temperature\n0,1,2,3\n1,1,2,3\n", encoding="utf-8")
    listed.write_text("name,model,record\nnorth,model.json,record.csv\n", encoding="utf-8")
    wrong = tmp_path / "criteria.toml"
    wrong.write_text("[naming]\nlog_odds = 'high'\n", encoding="utf-8")
    files = [model_file, record] if command == "diagnose" else [listed]
    refused = rga(command, *files, "-o", tmp_path / "out", "--criteria", wrong)
    assert refused.code == 2
    assert "naming.log_odds: " in refused.err
    assert "Traceback" not in refused.err
    assert not (tmp_path / "out").exists()


def test_their_schema_says_what_each_decides(rga: Rga) -> None:
    schema = json.loads(rga("schema", "criteria").out)
    figure = schema["$defs"]["NamingCriteria"]["properties"]["log_odds"]
    assert figure["default"] == Criteria().naming.log_odds
    assert {"description", "unit", "reason"} <= figure.keys()
    findings = json.loads(rga("schema", "findings").out)
    assert "criteria" in findings["properties"]
    assert "criteria" not in findings["required"]
