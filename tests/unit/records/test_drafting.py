"""`rga import-record`: what it guesses, what it doubts, and that the record is then read."""

import json
import tomllib
from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.model import Model
from rga.records import load_record
from rga.records.drafting import MappingDraft, draft_mapping
from rga.records.drafting.matching import folded

START = datetime(2024, 1, 1)


def german(value: float) -> str:
    return f"{value:.3f}".replace(".", ",")


def main_file(path: Path, start: datetime, count: int = 60) -> Path:
    lines = ["Messung Brücke", "Kunde;Müller", "", "Datum;Uhrzeit;S_01;D 1;Batt;Kanal 5;Text"]
    lines.append(";;µm/m;cm;V;;")
    for k in range(count):
        moment = start + timedelta(minutes=10 * k + (600 if k > 30 else 0))
        strain = "-9999" if k == 5 else german(np.sin(k))
        cells = f"{moment:%d.%m.%Y;%H:%M:%S};{strain};{german(np.cos(k))};{german(5 + k)}"
        lines.append(f"{cells};0,0;ok")
    path.write_bytes("\r\n".join(lines).encode("cp1252"))
    return path


def weather_file(path: Path) -> Path:
    rows = [f"{START + timedelta(hours=k)},{50 + k}" for k in range(40)]
    path.write_text("Timestamp,Air temp (°F)\n" + "\n".join(rows), encoding="utf-8")
    return path


@pytest.fixture
def model(two_bars: dict[str, Any]) -> Model:
    two_bars["context"]["temperature"]["range"] = [-20, 60]
    return Model.model_validate(two_bars)


@pytest.fixture
def draft(tmp_path: Path, model: Model) -> MappingDraft:
    files = [
        main_file(tmp_path / "jan.csv", START),
        main_file(tmp_path / "feb.csv", START + timedelta(days=2)),
        weather_file(tmp_path / "weather.csv"),
    ]
    return draft_mapping(files, model, tmp_path)


def test_channels_are_matched_by_name_and_by_unit(draft: MappingDraft) -> None:
    assert {one.name: one.column for one in draft.matched} == {
        "D1": "D 1",
        "S1": "S_01",
        "temperature": "Air temp (°F)",
    }
    content = tomllib.loads(draft.toml)
    assert content["files"] == ["jan.csv", "feb.csv"]
    assert content["beside"][0]["files"] == ["weather.csv"]
    assert content["beside"][0]["match"] == "interpolate"
    assert set(content["unused"]) == {"Batt", "Kanal 5", "Text"}


def test_what_it_doubts_is_said(draft: MappingDraft) -> None:
    doubts = " | ".join(draft.doubts)
    for said in (
        "time stamps have no zone",
        "-9999 stands in S_01 (2 rows): is it a missing value?",
        "1 gaps in time, the longest 36600 s",
        "column 'Kanal 5' is left out: TO CHECK: it reads 0 throughout",
        "column 'Text' is left out: TO CHECK: it holds text",
        "no column is like the context 'load'",
        "temperature is taken from 'Air temp (°F)' (the only temperature that is left)",
    ):
        assert said in doubts
    assert '# missing = ["-9999"]' in draft.toml
    assert '# zone = "+01:00"  # the stamps have none: hours ahead of UTC' in draft.toml


def test_the_record_is_read_by_what_was_written(
    draft: MappingDraft, tmp_path: Path, model: Model
) -> None:
    assert draft.fault is None
    (tmp_path / "import.toml").write_text(draft.toml, encoding="utf-8")
    record = load_record(tmp_path, model)
    assert len(record) == 120
    assert record.readings[0, 0] == pytest.approx(10)
    assert record.contexts["temperature"][0] == pytest.approx(10)


def test_what_must_be_filled_in_is_said_in_the_first_line(tmp_path: Path, model: Model) -> None:
    (tmp_path / "r.csv").write_text("a;D1;S1\n1;2;3\n2;3;4\n", encoding="utf-8")
    draft = draft_mapping([tmp_path / "r.csv"], model, tmp_path)
    assert draft.fault is not None
    assert draft.toml.startswith("# TO FILL IN: as it stands the record is not read: there is no")
    assert "# FILL IN: there is no time column" in draft.toml
    (tmp_path / "r.csv").write_text("Date;D1;S1\n45323,5;2;3\n45323,6;3;4\n", encoding="utf-8")
    dated = draft_mapping([tmp_path / "r.csv"], model, tmp_path)
    assert dated.fault is None
    assert 'format = "excel"' in dated.toml


def test_a_sensor_without_a_column_is_left_out_to_be_checked(tmp_path: Path, model: Model) -> None:
    (tmp_path / "r.csv").write_text("time;D1;S2\n1;2;3\n2;3;4\n", encoding="utf-8")
    draft = draft_mapping([tmp_path / "r.csv"], model, tmp_path)
    assert draft.fault is None
    assert 'S1 = "TO CHECK: no column has a name like it"' in draft.toml
    assert "S2" in tomllib.loads(draft.toml)["unused"]


def test_names_that_differ_by_a_number_are_not_alike() -> None:
    assert folded("Strain 1") != folded("Strain 2")
    assert folded("MS01_Top") == folded("ms 1 top")


def test_the_command_writes_once(tmp_path: Path, model_file: Path, rga: Callable[..., Any]) -> None:
    data = tmp_path / "data"
    data.mkdir()
    main_file(data / "jan.csv", START)
    command = ("import-record", data / "jan.csv", "--model", model_file)
    outcome = rga(*command)
    assert outcome.code == 0
    assert "doubt: the time stamps have no zone" in outcome.out
    written = (data / "import.toml").read_text(encoding="utf-8")
    again = rga(*command)
    assert again.code == 2
    assert "--force" in again.err
    assert (data / "import.toml").read_text(encoding="utf-8") == written
    assert rga(*command, "--force").code == 0
    elsewhere = rga(*command, "-o", tmp_path / "other" / "my.toml")
    assert elsewhere.code == 0
    content = tomllib.loads((tmp_path / "other" / "my.toml").read_text(encoding="utf-8"))
    assert content["files"] == ["../data/jan.csv"]
    shown = rga("import-record", tmp_path / "none.csv", "--model", model_file)
    assert shown.code == 2
    assert not list(tmp_path.glob(".rga-*"))


@pytest.mark.parametrize("rows", ["", "2024-01-01 00:00,ok,good\n2024-01-01 00:10,ok,good\n"])
def test_a_file_without_a_number_is_refused(
    tmp_path: Path, model_file: Path, rga: Callable[..., Any], rows: str
) -> None:
    (tmp_path / "r.csv").write_text(f"time,state,remark\n{rows}", encoding="utf-8")
    outcome = rga("import-record", tmp_path / "r.csv", "--model", model_file)
    assert outcome.code == 2
    assert "r.csv" in outcome.err
    assert not (tmp_path / "import.toml").exists()


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("2024-12-01,1,2\n2024-13-01,2,3\n", "'2024-13-01' cannot be read"),
        ("2024-01-02,1,2\n2024-01-01,2,3\n", "the time runs backwards"),
        ("2024-01-01,1,2\n2024-01-01,2,3\n", "the time is the same as in the row before"),
        ("2024-01-01,inf,inf\n2024-01-02,2,3\n", "the value is infinite"),
        ("2024-01-01,1e308,1e308\n2024-01-02,1e308,1e308\n", "nothing measures 1e+308"),
    ],
)
def test_a_record_that_is_not_read_is_bad_input(
    tmp_path: Path, model_file: Path, rga: Callable[..., Any], rows: str, said: str
) -> None:
    (tmp_path / "r.csv").write_text(f"time,D1,S1\n{rows}", encoding="utf-8")
    outcome = rga("import-record", tmp_path / "r.csv", "--model", model_file)
    assert outcome.code == 2
    target = tmp_path / "import.toml"
    *_, fault, remedy = outcome.out.splitlines()
    assert fault.startswith("To fill in, before the record is read: ")
    assert said in fault
    assert remedy == f"Mend {target} or the files there, then: rga check {model_file} {target}"
    assert said in target.read_text(encoding="utf-8").splitlines()[0]


@pytest.mark.parametrize("kind", ["import", "settings"])
def test_schemas_are_printed(kind: str, rga: Callable[..., Any]) -> None:
    content = json.loads(rga("schema", kind).out)
    known = {"import": "header_line", "settings": "level"}
    assert known[kind] in content["properties"]


def test_a_column_without_a_value_is_taken_for_nothing(tmp_path: Path, model: Model) -> None:
    content = "time;D1 [mm];S1;load [kN]\n0;1;2;\n1;2;3;Overrange\n"
    (tmp_path / "r.csv").write_text(content, encoding="utf-8")
    draft = draft_mapping([tmp_path / "r.csv"], model, tmp_path)
    assert draft.fault is None
    assert {one.name for one in draft.matched} == {"D1", "S1"}
    assert tomllib.loads(draft.toml)["unused"] == {"load [kN]": "it holds no value"}
