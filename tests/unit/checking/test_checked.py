"""What checks have found, as text, JSON and HTML; and the command that says it."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import rga
from rga.checking import CheckResult, Finding, check
from rga.checking.finding import refused
from rga.errors import SeveralMistakes
from rga.model import Model
from rga.records import Record, load_record

FINDINGS = (
    Finding("error", "node <X>", "it moves", "hold it"),
    Finding("warning", "context 'a'", "a < b & c", "swap them"),
    Finding("warning", "context 'b'", "odd", "even it"),
)


@pytest.fixture
def files(portal: dict[str, Any], measured: Callable[..., Record], tmp_path: Path) -> Path:
    """The portal and its record as files."""
    record = measured()
    columns = {"time": record.time, **record.contexts}
    columns |= dict(zip(record.sensors, record.readings.T, strict=True))
    pl.DataFrame(columns).write_csv(tmp_path / "record.csv")
    (tmp_path / "model.json").write_text(json.dumps(portal), encoding="utf-8")
    return tmp_path


def test_text_and_json_say_the_same() -> None:
    checked = CheckResult(FINDINGS)
    assert not checked.ok
    lines = str(checked).split("\n")
    assert lines[0] == "error: it moves (node <X>): hold it"
    assert lines[-1] == "1 error, 2 warnings."
    content = json.loads(checked.to_json())
    assert content["ok"] is False
    assert content["findings"][1] == {
        "severity": "warning",
        "where": "context 'a'",
        "what": "a < b & c",
        "remedy": "swap them",
    }
    assert CheckResult(FINDINGS[1:]).ok
    assert str(CheckResult()) == "Nothing looks wrong."


def test_html_is_escaped_and_bounded() -> None:
    html = CheckResult(FINDINGS)._repr_html_()
    assert "node &lt;X&gt;" in html
    assert "a &lt; b &amp; c" in html
    many = CheckResult(tuple(Finding("note", str(k), "w", "r") for k in range(500)))._repr_html_()
    assert many.count("<tr>") == 31
    assert "470 more" in many


def test_a_list_of_mistakes_is_a_finding_each_up_to_a_bound() -> None:
    few = refused(SeveralMistakes(["a: b", "c: d"], "model.json", "mend"))
    assert [one.what for one in few] == ["a: b", "c: d"]
    many = refused(SeveralMistakes([f"{k}: b" for k in range(50)], "model.json", "mend"))
    assert len(many) == SeveralMistakes.MOST + 1
    assert "30 more" in many[-1].what


def test_it_is_a_door_of_python(files: Path, model: Model) -> None:
    assert rga.check is check
    assert str(rga.check(str(files / "model.json"))) == "Nothing looks wrong."
    read, *said = str(rga.check(model, files / "record.csv")).split("\n")
    assert read.startswith("record: ")
    assert said == ["Nothing looks wrong."]
    wrong: Any = 3
    assert "int is no model" in str(check(wrong))
    assert "int is no record" in str(check(model, wrong))


def test_the_command_says_what_python_says(files: Path, rga: Callable[..., Any]) -> None:
    outcome = rga("check", files / "model.json", files / "record.csv")
    read, *said = outcome.out.split("\n")
    assert read.startswith("record: ")
    assert (outcome.code, said, outcome.err) == (0, ["Nothing looks wrong.", ""], "")
    portal = json.loads((files / "model.json").read_text(encoding="utf-8"))
    portal["materials"]["steel"]["E"] = 210
    portal["nodes"]["X"] = [9, 0, 0]
    (files / "model.json").write_text(json.dumps(portal), encoding="utf-8")
    outcome = rga("check", files / "model.json", files / "record.csv")
    assert outcome.code == 2
    assert outcome.out == f"{check(files / 'model.json', files / 'record.csv')}\n"
    assert "\nerror: no member, spring or tie joins it (node 'X'): " in outcome.out
    listed = rga("check", files / "model.json", "--json")
    assert listed.code == 2
    assert json.loads(listed.out) == check(files / "model.json").content()
    saved = rga("check", files / "model.json", "--json", files / "found.json")
    assert saved.out == f"{check(files / 'model.json')}\n"
    assert json.loads((files / "found.json").read_text()) == json.loads(listed.out)


def test_warnings_leave_the_exit_code_alone(files: Path, rga: Callable[..., Any]) -> None:
    portal = json.loads((files / "model.json").read_text(encoding="utf-8"))
    portal["sections"]["old"] = {"A": 0.01}
    portal["materials"]["steel"]["density"] = 7.85
    (files / "model.json").write_text(json.dumps(portal), encoding="utf-8")
    outcome = rga("check", files / "model.json")
    assert outcome.code == 0
    assert outcome.out.endswith("1 warning, 1 note.\n")


def test_a_mapping_is_used(files: Path, rga: Callable[..., Any]) -> None:
    text = (files / "record.csv").read_text(encoding="utf-8").replace("time", "z", 1)
    (files / "record.csv").write_text(text, encoding="utf-8")
    assert rga("check", files / "model.json", files / "record.csv").code == 2
    (files / "how.toml").write_text('[time]\ncolumns = ["z"]', encoding="utf-8")
    outcome = rga(
        "check", files / "model.json", files / "record.csv", "--import", files / "how.toml"
    )
    assert (outcome.code, outcome.out.split("\n")[-2]) == (0, "Nothing looks wrong.")


@pytest.mark.parametrize("content", ["", "{", "[]", "\x00\x01", '{"rga_model": 1}'])
def test_files_that_are_no_model_are_findings(
    content: str, tmp_path: Path, rga: Callable[..., Any]
) -> None:
    (tmp_path / "model.json").write_text(content, encoding="utf-8")
    outcome = rga("check", tmp_path / "model.json", tmp_path / "record.csv")
    assert outcome.code == 2
    assert outcome.out.startswith("error: ")
    assert outcome.err == ""


def test_what_was_read_as_the_record_stands_above(
    files: Path, model: Model, rga: Callable[..., Any]
) -> None:
    frame = pl.read_csv(files / "record.csv")
    contexts = model.context.keys() & {*frame.columns}
    sensor = next(iter(model.sensors))
    frame = frame.with_columns(
        pl.when(pl.int_range(pl.len()) % 4 == 0).then(None).otherwise(sensor).alias(sensor)
    )
    frame.write_csv(files / "record.csv")
    record = load_record(files / "record.csv", model)
    checked = check(model, replace(record, notes=["w.csv is matched by the row nearest"]))
    step = record.time[1] - record.time[0]
    share = 100 * np.mean(np.arange(len(record)) % 4 == 0) / (len(model.sensors) + len(contexts))
    said = (
        f"record: {len(record)} rows, {record.start:g} s to {record.start + record.time[-1]:g} s, "
        f"a step of {step:g} s; {len(model.sensors)} of {len(model.sensors)} sensors and "
        f"{len(contexts)} of {len(model.context)} contexts; {share:.2g} % of the cells missing"
    )
    assert str(checked).split("\n")[:2] == [said, "record: w.csv is matched by the row nearest"]
    listed = json.loads(rga("check", files / "model.json", files / "record.csv", "--json").out)
    assert listed["record"]["rows"] == len(record)
    assert listed["record"]["missing"] == pytest.approx(share / 100)
    assert "record" not in check(model).content()
    assert not str(check(model)).startswith("record")
