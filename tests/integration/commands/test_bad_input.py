"""Bad input: exit code 2, one line that says what, where and how to mend it, nothing written."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import polars as pl
import pytest

from rga.cli.operation.settings import read_settings
from rga.errors import InputError
from rga.model import load_model

GOOD = "time,D1,S1\n0,1,2\n1,1,2\n2,1,2\n"

#: record, mapping, and what the error must say
RECORDS: dict[str, tuple[str | bytes, str | None, list[str]]] = {
    "empty file": ("", None, ["file is empty"]),
    "header only": ("time,D1,S1\n", None, ["no rows below the header"]),
    "blank lines only": ("time,D1,S1\n\n\n", None, ["no rows below the header"]),
    "lines of blanks": (" \n\n \n", None, ["no rows in the file"]),
    "column without a name": ("time,D1,\n0,1,2\n", None, ["column 3 has no name", "line 1"]),
    "column twice": ("time,D1,D1\n0,1,2\n", None, ["'D1' stands twice"]),
    "no letter of a number": (b"time,D1,S1\n0,1,2\n1,\xff,2\n", None, ["'ÿ'", "line 3"]),
    "stated UTF-8": (
        b"time,D1,S1\n0,1,2\n1,\xff,2\n",
        'encoding = "utf-8"',
        ["not UTF-8", "line 3"],
    ),
    "UTF-16 cut off": (GOOD.encode("utf-16")[:-1], None, ["not UTF-16"]),
    "bytes": (bytes(range(256)) * 4, None, ["no table of text"]),
    "workbook": (b"PK\x03\x04" + bytes(50), None, ["workbook", "CSV"]),
    "line cut short": ("time,D1,S1\n0,1,2\n1,1\n", None, ["line 3", "has 2 fields"]),
    "line too long": ("time,D1,S1\n0,1,2,3\n", None, ["line 2", "has 4 fields"]),
    "no time": ("t,D1,S1\n0,1,2\n", None, ["no time column 'time'", "t, D1, S1"]),
    "time missing": ("time,D1,S1\n0,1,2\n,1,2\n", None, ["time is missing", "line 3"]),
    "time repeats": ("time,D1,S1\n0,1,2\n1,1,2\n1,1,2\n", None, ["same as", "line 4"]),
    "time backwards": ("time,D1,S1\n0,1,2\n2,1,2\n1,1,2\n", None, ["backwards", "line 4"]),
    "time infinite": ("time,D1,S1\n0,1,2\ninf,1,2\n", None, ["'inf'", "line 3"]),
    "seconds, then ISO": ("time,D1,S1\n0,1,2\n2024-01-01,1,2\n", None, ["'2024-01-01'", "line 3"]),
    "ISO, then seconds": ("time,D1,S1\n2024-01-01,1,2\n5,1,2\n", None, ["'5'", "line 3"]),
    "zone, then none": (
        "time,D1,S1\n2024-01-01T00:00Z,1,2\n2024-01-01T00:01,1,2\n",
        None,
        ["time zone", "line 3"],
    ),
    "text in a column": ("time,D1,S1\n0,1,2\n1,1,broken\n", None, ["'broken'", "line 3", "'S1'"]),
    "decimal comma": (
        "time;D1;S1\n0;1,5;2\n",
        'delimiter = ";"\ndecimal = "."',
        ["'1,5'", "decimal point"],
    ),
    "point among commas": ("time;D1;S1\n0;1,5;2\n1;1.5;2,5\n", None, ["'1.5'", "line 3"]),
    "huge value": ("time,D1,S1\n0,1,2\n1,1e300,2\n", None, ["1e+300", "line 3", "'D1'"]),
    "infinite value": ("time,D1,S1\n0,1,2\n1,-inf,2\n", None, ["infinite", "line 3", "'D1'"]),
    "channel without values": ("time,D1,S1\n0,1,\n1,1,\n", None, ["'S1' holds no value"]),
    "unknown channel": ("time,D1,S1,S9\n0,1,2,3\n", None, ["'S9'", "rga import-record FILES"]),
    "missing channel": ("time,D1\n0,1\n", None, ["sensors 'S1'", "[unused]"]),
    "no sensor at all": (
        "time,load\n0,1\n",
        '[unused]\nD1 = "none"\nS1 = "none"',
        ["no sensor of the model"],
    ),
    "mapping: no TOML": (GOOD, "delimiter = ", ["no TOML", "import.toml"]),
    "mapping: unknown key": (GOOD, 'separator = ","', ["'separator' is unknown", "delimiter"]),
    "mapping: unknown key of time": (GOOD, "[time]\nrate = 1", ["'time.rate'", "sampling_rate_hz"]),
    "mapping: unknown key of a channel": (GOOD, "[channels]\nD1 = {gain = 2}", ["D1.gain", "sign"]),
    "mapping: sign": (GOOD, "[channels]\nD1 = {sign = 2}", ["channels.D1.sign"]),
    "mapping: header": (GOOD, 'header = "({unit})"', ["header", "{channel}"]),
    "mapping: zero": (GOOD, "zero = [2, 1]", ["zero"]),
    "mapping: zero of no rows": (GOOD, "zero = [5, 6]", ["5 s and 6 s", "D1"]),
    "mapping: no lead-in": (GOOD, 'zero = "lead-in"', ["lead-in", "zero = [from, to]"]),
    "mapping: no time": (GOOD, "[time]\ncolumns = []", ["sampling_rate_hz"]),
    "mapping: reason left out": (GOOD, '[unused]\nD1 = ""', ["unused.D1"]),
    "mapping: channel": (GOOD, "[channels]\nD9 = {sign = -1}", ["'D9'", "model does not have"]),
    "mapping: column": (GOOD, '[channels]\nD1 = {column = "d"}', ["'d'", "file does not have"]),
    "mapping: two columns": (
        "time,D1,d,S1\n0,1,2,3\n",
        '[channels]\nD1 = {column = "d"}',
        ["both give 'D1'"],
    ),
    "mapping: unit of another kind": (GOOD, '[channels]\nD1 = {unit = "kN"}', ["'kN'", "mm"]),
    "mapping: unit of a context": (
        "time,D1,S1,load\n0,1,2,3\n",
        '[channels]\nload = {unit = "mm"}',
        ["'mm'", "convert it to N"],
    ),
    "mapping: time format": (
        "time,D1,S1\n2024-01-01,1,2\n",
        '[time]\nformat = "%d.%m.%Y"',
        ["'2024-01-01'", "%d.%m.%Y"],
    ),
}


def one_line(err: str) -> str:
    assert err.startswith("error: ")
    assert err.count("\n") == 1
    assert "Traceback" not in err
    return err


@pytest.mark.parametrize("command", ["diagnose", "run"])
@pytest.mark.parametrize("case", RECORDS)
def test_records(
    case: str, command: str, tmp_path: Path, model_file: Path, rga: Callable[..., Any]
) -> None:
    content, mapping, expected = RECORDS[case]
    data = content if isinstance(content, bytes) else content.encode()
    (tmp_path / "record.csv").write_bytes(data)
    if mapping is not None:
        (tmp_path / "import.toml").write_text(mapping, encoding="utf-8")
    before = sorted(tmp_path.rglob("*"))
    outcome = rga(command, model_file, tmp_path / "record.csv", "-o", tmp_path / "out")
    assert outcome.code == 2
    assert outcome.out == ""
    for part in expected:
        assert part in one_line(outcome.err)
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize("damage", ["truncated", "no Parquet", "infinite", "text", "boolean"])
def test_parquet(damage: str, tmp_path: Path, model_file: Path, rga: Callable[..., Any]) -> None:
    path = tmp_path / "record.parquet"
    frame = pl.DataFrame({"time": [0.0, 1.0], "D1": [1.0, 2.0], "S1": [1.0, 2.0]})
    bad = {"infinite": [1.0, float("inf")], "text": ["1", "x"], "boolean": [True, False]}
    if damage in bad:
        frame = frame.with_columns(pl.Series("S1", bad[damage]))
    frame.write_parquet(path)
    if damage == "truncated":
        path.write_bytes(path.read_bytes()[:-20])
    elif damage == "no Parquet":
        path.write_text(GOOD, encoding="utf-8")
    expected = {"infinite": "row 2", "text": "'x'", "boolean": "no numbers"}
    outcome = rga("diagnose", model_file, path, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert expected.get(damage, "no complete Parquet file") in one_line(outcome.err)
    assert not (tmp_path / "out").exists()


def test_files_that_are_not_there(
    tmp_path: Path, model_file: Path, rga: Callable[..., Any]
) -> None:
    record = tmp_path / "record.csv"
    record.write_text(GOOD, encoding="utf-8")
    nowhere = tmp_path / "nowhere"
    for arguments in (
        ("diagnose", nowhere, record, "-o", tmp_path / "out"),
        ("diagnose", model_file, nowhere, "-o", tmp_path / "out"),
        ("diagnose", model_file, tmp_path, "-o", tmp_path / "out"),
        ("diagnose", model_file, record, "--import", nowhere, "-o", tmp_path / "out"),
        ("simulate", model_file, nowhere, "-o", tmp_path / "out.csv"),
        ("whatif", model_file, "--add", nowhere),
        ("verify", nowhere),
    ):
        outcome = rga(*arguments)
        assert outcome.code == 2
        assert "nowhere" in one_line(outcome.err) or str(tmp_path) in outcome.err
    assert not (tmp_path / "out").exists()


MODELS: dict[str, tuple[str, list[str]]] = {
    "no JSON": ("{", ["no JSON"]),
    "a list": ("[]", ["a list is no model (", "model.json"]),
    "null": ("null", ["there is nothing in it (", "model.json"]),
    "too deep": ("[" * 100_000, ["too deep in one another"]),
}


@pytest.mark.parametrize("case", MODELS)
def test_models(case: str, tmp_path: Path, rga: Callable[..., Any]) -> None:
    content, expected = MODELS[case]
    (tmp_path / "model.json").write_text(content, encoding="utf-8")
    outcome = rga("whatif", tmp_path / "model.json")
    assert outcome.code == 2
    for part in expected:
        assert part in one_line(outcome.err)


def test_a_model_must_be_text(tmp_path: Path, rga: Callable[..., Any]) -> None:
    path = tmp_path / "model"
    path.write_text("{}", encoding="utf-16")
    said = one_line(rga("whatif", path).err)
    assert said == f"error: this is no UTF-8 text ({path}): save it as UTF-8\n"
    path.write_text("{", encoding="utf-8")
    assert "this is no JSON text: " in one_line(rga("whatif", path).err)


def test_mistakes_of_a_model_are_listed_as_in_python(
    tmp_path: Path, rga: Callable[..., Any]
) -> None:
    path = tmp_path / "model.json"
    path.write_text('{"rga_model": 1, "nmae": "x"}', encoding="utf-8")
    outcome = rga("whatif", path)
    with pytest.raises(InputError) as refused:
        load_model(path)
    assert (outcome.code, outcome.out) == (2, "")
    assert outcome.err == f"error: {refused.value}\n"
    for line in ("nodes: Field required", "nmae: this key is unknown (value 'x')"):
        assert f"\n  {line}\n" in outcome.err


EFFECTS: dict[str, tuple[str, list[str]]] = {
    "no JSON": ("{", ["no JSON"]),
    "no object": ("[1]", ["'kind'"]),
    "unknown kind": ('{"kind": "ghost"}', ["'ghost'"]),
    "unknown key": ('{"kind": "elastic_modulus", "material": "steel", "fcator": 1}', ["factor"]),
    "place": ('{"kind": "elastic_modulus", "material": "wood", "factor": 0.9}', ["'wood'"]),
    "ends before it begins": (
        '{"kind": "elastic_modulus", "material": "steel", "factor": 0.9, "onset": 20, "end": 10}',
        ["end: 10", "onset 20"],
    ),
}


@pytest.mark.parametrize("case", EFFECTS)
def test_effects(case: str, tmp_path: Path, model_file: Path, rga: Callable[..., Any]) -> None:
    content, expected = EFFECTS[case]
    (tmp_path / "softer.json").write_text(content, encoding="utf-8")
    outcome = rga("whatif", model_file, "--add", tmp_path / "softer.json")
    assert outcome.code == 2
    for part in expected:
        assert part in one_line(outcome.err)


@pytest.mark.parametrize(
    "setting", ["wind=3", "temperature", "temperature=warm", "=3", "temperature=nan"]
)
def test_settings(setting: str, model_file: Path, rga: Callable[..., Any]) -> None:
    outcome = rga("whatif", model_file, "--set", setting)
    assert outcome.code == 2
    assert "its range away" not in one_line(outcome.err)


RUN_SETTINGS = {
    "no interval": ('{"policy": "event", "interval": 5}', "policy 'event' has no interval"),
    "unknown": ('{"wind": 3}', "wind: there is no such key"),
    "inner": ('{"training": {"steps": 0}}', "training.steps: Input"),
}


@pytest.mark.parametrize("case", RUN_SETTINGS)
def test_settings_of_a_run(case: str, tmp_path: Path) -> None:
    content, expected = RUN_SETTINGS[case]
    (tmp_path / "settings.json").write_text(content, encoding="utf-8")
    with pytest.raises(InputError) as refusal:
        read_settings(tmp_path / "settings.json", None)
    assert str(refusal.value).startswith(expected)


def test_outputs(tmp_path: Path, model_file: Path, rga: Callable[..., Any]) -> None:
    contexts = tmp_path / "contexts.csv"
    contexts.write_text("temperature,load\n1,2\n", encoding="utf-8")
    (tmp_path / "file").write_text("mine", encoding="utf-8")
    (tmp_path / "folder.csv").mkdir()
    for arguments in (
        ("simulate", model_file, contexts, "-o", tmp_path / "out.xlsx"),
        ("simulate", model_file, contexts, "-o", tmp_path / "file" / "out.csv"),
        ("simulate", model_file, contexts, "-o", tmp_path / "folder.csv"),
        ("dataset", model_file, "-n", "4", "-o", tmp_path / "out.csv"),
        ("draw", model_file, "-o", tmp_path),
        ("draw", model_file, "-o", tmp_path / "drawing"),
    ):
        outcome = rga(*arguments)
        assert outcome.code == 2
        assert "''" not in one_line(outcome.err)
    assert (tmp_path / "file").read_text(encoding="utf-8") == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "contexts.csv",
        "file",
        "folder.csv",
        "model.json",
    ]


def test_contexts_that_do_not_fit(
    tmp_path: Path, model_file: Path, rga: Callable[..., Any]
) -> None:
    for content, part in (
        ("temperature\n1\n", "'load'"),
        ("temperature,load,wind\n1,2,3\n", "'wind'"),
        ("temperature,load\n1,\n", "line 2"),
    ):
        (tmp_path / "contexts.csv").write_text(content, encoding="utf-8")
        outcome = rga("simulate", model_file, tmp_path / "contexts.csv", "-o", tmp_path / "o.csv")
        assert outcome.code == 2
        assert part in one_line(outcome.err)
    assert not (tmp_path / "o.csv").exists()


def test_a_model_without_gauges_is_not_simulated(
    tmp_path: Path, model_file: Path, rga: Callable[..., Any]
) -> None:
    content = json.loads(model_file.read_text(encoding="utf-8"))
    model_file.write_text(json.dumps({**content, "sensors": {}}), encoding="utf-8")
    (tmp_path / "contexts.csv").write_text("temperature,load\n1,2\n", encoding="utf-8")
    outcome = rga("simulate", model_file, tmp_path / "contexts.csv", "-o", tmp_path / "o.csv")
    assert outcome.code == 2
    assert "the model has no gauges" in one_line(outcome.err)
    assert not (tmp_path / "o.csv").exists()


def test_a_name_that_looks_like_markup_is_shown_as_it_is(
    tmp_path: Path, model_file: Path, rga: Callable[..., Any]
) -> None:
    content = json.loads(model_file.read_text(encoding="utf-8"))
    name = "[/bold]"
    content["sensors"][name] = content["sensors"].pop("D1")
    path = tmp_path / "marked.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    outcome = rga("whatif", path, "--set", "load=1")
    assert outcome.code == 0
    assert name in outcome.out
