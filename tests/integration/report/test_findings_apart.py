"""Findings are written whatever becomes of what is drawn and said beside them."""

import csv
import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from rga import diagnose, diagnose_many, load_findings, load_model
from rga.errors import InputError, ReportError
from rga.findings import Findings
from rga.model import Model, model_content, read_model
from rga.outputs import write_run
from rga.records import Record
from rga.twin.history import History
from rga.twin.outcome import Outcome

Rga = Callable[..., Any]
Recorded = Callable[..., Record]
CRACK = {"kind": "member_stiffness", "member": "U2-U3", "factor": 0.7, "onset": 30000.0}
LOST = "could not be drawn"
#: what each part of a report rests on, and how the report calls the part
PARTS = {
    "rga.report.pages.diagnosis_page.draw_bridge": "The map of percentages",
    "rga.report.pages.diagnosis_page.draw_residuals": "The map of residuals",
    "rga.report.pages.diagnosis_page.member_forces": "The forces of the members",
    "rga.report.pages.diagnosis_page.draw_forces": "The forces of the members",
    "rga.report.pages.diagnosis_page.all_channels": "Every channel",
    "rga.report.pages.diagnosis_page.percent_off": "The table of the sensors",
    "rga.report.pages.diagnosis_page.draw_series": "The readings",
    "rga.report.pages.diagnosis_page.ranked": "The table of explanations",
    "rga.report.pages.diagnosis_page.draw_explanations": "The figure of explanations",
    "rga.report.pages.diagnosis_page.unseen_groups": "The channels left out",
    "rga.report.pages.diagnosis_page.draw_gain": "The figure of the gain",
    "rga.report.pages.diagnosis_page.generic": "The table of contexts",
    "rga.report.figures.unexplained.leftovers": "The patterns that are left",
    "rga.report.pages.diagnosis_page.actions": "What to do first",
    "rga.report.pages.diagnosis_page.evidence": "The evidence",
    "rga.report.pages.evidence.profiles": "The profiles",
    "rga.report.pages.evidence.onset_profile": "The profiles",
    "rga.report.pages.evidence.contrast": "The rival's fit",
    "rga.report.pages.evidence.hold": "What its lead hangs on",
    "rga.report.pages.evidence.least_seen": "The smallest effect that would have been named",
}
#: parts that fail together are so many apart: none of them holds another
APART = 6


@pytest.fixture(scope="module")
def model(measured_bridge: dict[str, Any]) -> Model:
    return read_model(measured_bridge, "measured bridge")


@pytest.fixture(scope="module")
def cracked(model: Model, measured_record: Recorded) -> Findings:
    """A member that cracks on the way; a temperature is told, so that every part is drawn."""
    findings = diagnose(model, measured_record(model, CRACK))
    findings.contexts["temperature"] = {"noise [degC]": 0.3}
    return findings


@pytest.fixture(scope="module")
def sound(cracked: Findings, tmp_path_factory: pytest.TempPathFactory) -> str:
    """The report of that."""
    return cracked.write(tmp_path_factory.mktemp("sound")).read_text(encoding="utf-8")


@pytest.fixture
def files(model: Model, measured_record: Recorded, tmp_path: Path) -> Path:
    """Model and record of the same as files."""
    record = measured_record(model, CRACK)
    columns = {"time": record.time, **record.contexts}
    columns |= dict(zip(record.sensors, record.readings.T, strict=True))
    pl.DataFrame(columns).write_csv(tmp_path / "record.csv")
    (tmp_path / "model.json").write_text(json.dumps(model_content(model)), encoding="utf-8")
    return tmp_path


def fails(*_: Any, **__: Any) -> Any:
    raise np.linalg.LinAlgError("Singular matrix")


def whole(folder: Path, findings: Findings) -> bool:
    """Whether findings and model stand in a folder, and nothing half written does."""
    loaded = load_findings(folder)
    causes = len(load_model(folder / "model.json").effects) - len(findings.account.model.effects)
    return (
        loaded.to_json() == findings.to_json()
        and causes == len(findings.causes)
        and not list(folder.glob("*.partial"))
    )


def figures(html: str) -> int:
    """Figures of a page without those of single channels."""
    return html.count("<svg") - html.count('<details class="channel">')


def test_a_sound_report_has_lost_nothing(cracked: Findings, sound: str) -> None:
    assert LOST not in sound
    assert cracked.warnings == []
    assert figures(sound) == 9


@pytest.mark.parametrize("first", range(APART))
def test_parts_that_fail_are_reported_in_their_places(
    cracked: Findings, sound: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, first: int
) -> None:
    failing = list(PARTS)[first::APART]
    for place in failing:
        monkeypatch.setattr(place, fails)
    html = cracked.write(tmp_path).read_text(encoding="utf-8").replace("&#39;", "'")
    for place in failing:
        assert f"{PARTS[place]} {LOST}: LinAlgError: Singular matrix." in html
    lost = {name for name in PARTS.values() if f"{name} {LOST}" in html}
    assert lost == {PARTS[place] for place in failing}
    # What is lost are these parts, of two figures at most: the other sections are there.
    assert html.count("<h2>") == sound.count("<h2>")
    assert figures(html) >= figures(sound) - 2 * len(failing)
    assert whole(tmp_path, cracked)


@pytest.mark.parametrize(
    "broken", ["rga.report.pages.diagnosis_page.card", "rga.report.pages.write.page"]
)
def test_findings_stand_without_their_report(
    cracked: Findings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, broken: str
) -> None:
    (tmp_path / "report.html").write_text("of other findings", encoding="utf-8")
    monkeypatch.setattr(broken, fails)
    with pytest.raises(ReportError) as refused:
        cracked.write(tmp_path)
    assert all(
        str(tmp_path / name) in str(refused.value) for name in ("findings.json", "model.json")
    )
    assert whole(tmp_path, cracked)
    shown = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert f"The report {LOST}: LinAlgError: Singular matrix." in shown
    assert "other findings" not in shown


def test_findings_stand_where_nothing_can_draw(
    cracked: Findings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "rga.report", None)
    with pytest.raises(ReportError):
        cracked.write(tmp_path)
    assert whole(tmp_path, cracked)


def test_a_run_loses_no_findings(
    cracked: Findings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.report.write_run_report", fails)
    with pytest.raises(ReportError, match="Singular matrix"):
        write_run(Outcome(cracked, History.__new__(History)), tmp_path)
    assert whole(tmp_path, cracked)


def test_findings_from_a_file_write_nothing(cracked: Findings, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="arrays"):
        Findings.model_validate_json(cracked.to_json()).write(tmp_path / "new")
    assert not (tmp_path / "new").exists()


def test_the_command_says_in_one_line_that_the_report_is_missing(
    files: Path, rga: Rga, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = ("diagnose", files / "model.json", files / "record.csv", "-o", files / "out")
    sound = rga(*command)
    assert (sound.code, sound.err) == (0, "")
    before = (files / "out" / "findings.json").read_bytes()
    monkeypatch.setattr("rga.report.pages.write.page", fails)
    outcome = rga(*command)
    assert outcome.code == 1
    assert "Verdict: " in outcome.out
    assert "The report is" not in outcome.out
    (line,) = outcome.err.splitlines()
    assert line.startswith(f"error: the report {LOST} (LinAlgError: Singular matrix)")
    assert all(str(files / "out" / name) in line for name in ("findings.json", "model.json"))
    assert (files / "out" / "findings.json").read_bytes() == before
    assert LOST in (files / "out" / "report.html").read_text(encoding="utf-8")


def test_of_many_bridges_no_findings_are_lost(files: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    listed = files / "list.csv"
    listed.write_text("name,model,record\nnorth,model.json,record.csv\n", encoding="utf-8")
    monkeypatch.setattr("rga.report.pages.write.page", fails)
    with pytest.raises(ReportError, match="north"):
        diagnose_many(listed, files / "out")
    findings = load_findings(files / "out" / "north")
    with (files / "out" / "summary.csv").open(encoding="utf-8", newline="") as file:
        (line,) = csv.DictReader(file)
    assert line["verdict"] == findings.verdict


@pytest.mark.parametrize(
    ("stage", "part", "error"),
    [
        (
            "rga.diagnosis.pipeline.compare",
            "the comparison of explanations",
            np.linalg.LinAlgError("Singular matrix"),
        ),
        (
            "rga.diagnosis.assemble.causes.Advice",
            "what would separate the causes from their rivals",
            InputError("the structure can move", "node L1, uz", "hold it"),
        ),
        pytest.param(
            "rga.diagnosis.residuals.patterns.in_words",
            "what the structure that is left goes with",
            FloatingPointError("overflow"),
            marks=pytest.mark.thorough,
        ),
    ],
)
def test_a_stage_after_the_search_loses_no_findings(
    model: Model,
    measured_record: Recorded,
    cracked: Findings,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    stage: str,
    part: str,
    error: Exception,
) -> None:
    def stumbles(*_: Any, **__: Any) -> Any:
        raise error

    monkeypatch.setattr(stage, stumbles)
    findings = diagnose(model, measured_record(model, CRACK))
    (warning,) = findings.warnings
    assert warning.startswith(f"{part} could not be worked out: ")
    assert str(error) in warning
    (cause,), (sound,) = findings.causes, cracked.causes
    assert cause.effect == sound.effect
    assert (findings.verdict, findings.gap) == (cracked.verdict, cracked.gap)
    assert (findings.explanations == []) == (stage == "rga.diagnosis.pipeline.compare")
    assert (cause.separated_by == "") == (stage == "rga.diagnosis.assemble.causes.Advice")
    html = findings.write(tmp_path).read_text(encoding="utf-8")
    assert LOST not in html
    assert part in html


def test_nothing_wrong_and_nothing_lost(
    model: Model, measured_record: Recorded, tmp_path: Path
) -> None:
    findings = diagnose(model, measured_record(model))
    assert (findings.verdict, findings.causes) == ("nothing_wrong", [])
    assert findings.warnings == []
    assert LOST not in findings.write(tmp_path).read_text(encoding="utf-8")
