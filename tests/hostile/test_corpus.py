"""Files that once ended in a traceback, a hang, or a calm wrong answer."""

import json
from collections.abc import Callable
from datetime import date, datetime, timedelta
from datetime import time as of_day
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

Given, Judged = Callable[..., Any], Callable[[Any], Any]
DIAGNOSE = ("diagnose", "{}/model.json", "{}/record.csv", "-o", "{}/out")
PARQUET = ("diagnose", "{}/model.json", "{}/record.parquet", "-o", "{}/out")
MAPPED = (*DIAGNOSE[:3], "--import", "{}/import.toml", "-o", "{}/out")
RUN = ("run", "{}/model.json", "{}/record.csv", "-o", "{}/out", "--settings", "{}/settings.json")
DEEP = 100_000


def edited(sound: Path, **changes: Any) -> bytes:
    """The model, in which values at paths like `context.load.range` are others."""
    model = json.loads((sound / "model.json").read_text("utf-8"))
    for path, value in changes.items():
        *way, last = path.split("__")
        holder = model
        for key in way:
            holder = holder[key]
        holder[last] = value
    return json.dumps(model).encode()


def record(sound: Path) -> pl.DataFrame:
    return pl.read_csv(sound / "record.csv")


def as_csv(frame: pl.DataFrame) -> bytes:
    return frame.write_csv().encode()


def as_parquet(frame: pl.DataFrame) -> bytes:
    content = BytesIO()
    frame.write_parquet(content)
    return content.getvalue()


def with_time(sound: Path, values: Any) -> pl.DataFrame:
    return record(sound).with_columns(pl.Series("time", values))


def mapping(**changes: Any) -> bytes:
    lines = [f"{key} = {json.dumps(value)}" for key, value in changes.items() if key != "time"]
    time = {"column": "time", **changes.get("time", {})}
    lines.append("[time]")
    lines += [f"{key} = {json.dumps(value)}" for key, value in time.items()]
    return "\n".join(lines).encode()


ROWS = 60
MINUTES = [timedelta(minutes=k) for k in range(ROWS)]
#: that are refused, or work: nothing else may come of them
RECORDS: dict[str, Callable[[Path], dict[str, bytes]]] = {
    "ends of lines are CR": lambda sound: {
        "record.csv": (sound / "record.csv").read_bytes().replace(b"\n", b"\r")
    },
    "ends of lines in quotes": lambda sound: {
        "record.csv": (sound / "record.csv").read_bytes().replace(b"D1", b'"D\n1"')
    },
    "a quote that is never closed": lambda sound: {
        "record.csv": b'"' + (sound / "record.csv").read_bytes()
    },
    "times 5e-324 s apart": lambda sound: {
        "record.csv": as_csv(with_time(sound, 5e-324 * np.arange(ROWS)))
    },
    "times 1e300 s apart": lambda sound: {
        "record.csv": as_csv(with_time(sound, 1e300 * np.arange(ROWS)))
    },
    "times of the years 1 and 9999": lambda sound: {
        "record.csv": as_csv(
            with_time(sound, ["0001-01-01T00:00:00"] * 59 + ["9999-12-31T23:59:59"])
        )
    },
    "readings of 1e308": lambda sound: {
        "record.csv": as_csv(record(sound).with_columns(D1=pl.lit(1e308)))
    },
    "readings of 5e-324": lambda sound: {
        "record.csv": as_csv(record(sound).with_columns(D1=pl.lit(5e-324)))
    },
    "nothing": lambda sound: {"record.csv": b""},
    "a header alone": lambda sound: {"record.csv": b"time,D1,S1,S2,temperature\n"},
    "zeros": lambda sound: {"record.csv": bytes(100_000)},
    "one long line": lambda sound: {"record.csv": b"1," * 200_000},
}
TIMES: dict[str, list[Any]] = {
    "times of day": [of_day(k // 6, k % 6 * 10) for k in range(ROWS)],
    "durations": MINUTES,
    "lists": [[k] for k in range(ROWS)],
    "days": [date(2026, 1, 1) + timedelta(k) for k in range(ROWS)],
    "the year 1 on": [datetime(1, 1, 1) + step for step in MINUTES],
    "up to the year 9999": [datetime(9999, 12, 31, 23) + 0.9 * step for step in MINUTES],
    "truth values": [bool(k % 2) for k in range(ROWS)],
    "nothing": [None] * ROWS,
}
MAPPINGS = {
    "a directive twice": mapping(time={"format": "%Y-%m-%dT%H:%M:%S%Y"}),
    "a format of nothing": mapping(time={"format": ""}),
    "a format of a percent sign": mapping(time={"format": "%"}),
    "a delimiter of several bytes": mapping(delimiter="é"),
    "a delimiter of several letters": mapping(delimiter=",,"),
    "a delimiter that is none": mapping(delimiter=""),
    "a sampling rate of 1e300": mapping(time={"rate": 1e300}),
    "a sampling rate of 5e-324": mapping(time={"rate": 5e-324}),
    "an encoding that is none": mapping(encoding="rot13"),
    "lists within lists": b"a = " + b"[" * DEEP + b"]" * DEEP,
}
BAR = "sections__bar__A"
MODELS: dict[str, dict[str, Any]] = {
    "no effects": {"effects": {}},
    "an area of 1e-308": {BAR: 1e-308},
    "an area of 1e300": {BAR: 1e300},
    "a modulus of 5e-324": {"materials__steel__E": 5e-324},
    "a range of one rounding step": {"context__load__range": [1.0, np.nextafter(1.0, 2.0)]},
    "a range to 1e308": {"context__load__range": [-1e308, 1e308]},
    "noise of a context 1e300": {"context__temperature__noise": 1e300},
    "noise of a context 1e-300": {"context__temperature__noise": 1e-300},
    "noise of a sensor 1e300": {"sensors__D1__noise": 1e300},
    "noise of a sensor 1e-300": {"sensors__D1__noise": 1e-300},
    "nodes 1e-300 apart": {"nodes__T": [0, 0, 1e-300]},
    "a direction of 1e-200": {"sensors__D1__direction": [0, 0, 1e-200]},
    "nodes 1e300 apart": {"nodes__T": [3, 0, 1e300]},
    "a name that is markup": {"name": "[/bold]<script>alert(1)</script>"},
    "half of a letter": {"name": "\ud800"},
}
SETTINGS: dict[str, dict[str, Any]] = {
    "distinct is infinite": {"distinct": float("inf")},
    "widths of 1": {"training": {"width": 1, "reduced_width": 1, "features": 1}},
    "a width of 100 000": {"training": {"width": 100_000}},
    "design rows of 1e7": {"design_rows": 10**7},
    "a packet of 2**63": {"packet": 2**63},
    "no number": {"z": float("nan")},
}
#: settings that are odd, and work
WORK = ("widths of 1", "a packet of 2**63")


def check(judged: Judged, case: Any) -> Any:
    came = judged(case)
    assert not came.faults, came.faults
    return came


@pytest.mark.parametrize("name", RECORDS)
def test_a_record(name: str, sound: Path, given: Given, judged: Judged) -> None:
    check(judged, given(DIAGNOSE, RECORDS[name](sound)))


@pytest.mark.parametrize("name", TIMES)
def test_times_in_parquet(name: str, sound: Path, given: Given, judged: Judged) -> None:
    content = as_parquet(with_time(sound, TIMES[name]))
    check(judged, given(PARQUET, {"record.parquet": content}))


@pytest.mark.parametrize(
    "place",
    [
        pytest.param(place, marks=[pytest.mark.thorough] if number % 4 else [])
        for number, place in enumerate(range(4, 3000, 149))
    ],
)
def test_a_flipped_bit_in_parquet(place: int, sound: Path, given: Given, judged: Judged) -> None:
    content = bytearray((sound / "record.parquet").read_bytes())
    content[place % len(content)] ^= 1 << place % 8
    check(judged, given(PARQUET, {"record.parquet": bytes(content)}))


@pytest.mark.parametrize("name", MAPPINGS)
def test_a_mapping(name: str, given: Given, judged: Judged) -> None:
    check(judged, given(MAPPED, {"import.toml": MAPPINGS[name]}))


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("command", ["diagnose", "dataset", "whatif", "draw"])
def test_a_model(command: str, name: str, sound: Path, given: Given, judged: Judged) -> None:
    words = {
        "diagnose": DIAGNOSE,
        "dataset": ("dataset", "{}/model.json", "-n", "9", "-o", "{}/out/set.parquet"),
        "whatif": ("whatif", "{}/model.json", "--set", "load=3"),
        "draw": ("draw", "{}/model.json", "-o", "{}/out/drawing.svg"),
    }[command]
    check(judged, given(words, {"model.json": edited(sound, **MODELS[name])}))


@pytest.mark.parametrize("name", SETTINGS)
def test_settings(name: str, given: Given, judged: Judged) -> None:
    quick = {"calibration_rows": 20, "packet": 10, "settle": 10, "level": "A"}
    content = json.dumps(quick | SETTINGS[name]).encode()
    came = check(judged, given(RUN, {"settings.json": content}))
    assert came.code == (0 if name in WORK else 2)


@pytest.mark.parametrize(
    "content",
    [b"{" + b'"a":{' * DEEP, b"[" * DEEP, b"nan", b"{}", b"\xff\xfe", b'{"kind": []}', bytes(9)],
    ids=["tables", "lists", "nan", "empty", "a mark", "a list", "zeros"],
)
@pytest.mark.parametrize(
    ("file", "words"),
    [
        ("model.json", DIAGNOSE),
        ("model.json", ("check", "{}/model.json")),
        ("settings.json", RUN),
        ("findings.json", ("plan", "{}/model.json", "{}/findings.json")),
        ("criteria.json", (*DIAGNOSE, "--criteria", "{}/criteria.json")),
        ("add.json", ("whatif", "{}/model.json", "--add", "{}/add.json")),
    ],
    ids=["model", "checked", "settings", "findings", "criteria", "effect"],
)
def test_text_that_is_none(
    words: tuple[str, ...], file: str, content: bytes, given: Given, judged: Judged
) -> None:
    came = check(judged, given(words, {file: content}))
    assert came.code == 2 or content == b"{}"


@pytest.mark.parametrize("seed", [2**63, 2**64, 10**30])
def test_a_seed_beyond_any(seed: int, given: Given, judged: Judged) -> None:
    check(judged, given((*DIAGNOSE, "--seed", str(seed)), {}))


@pytest.mark.parametrize("rows", [10**400, 10**20, 10**12])
def test_a_dataset_that_no_disk_holds(rows: int, given: Given, judged: Judged) -> None:
    words = ("dataset", "{}/model.json", "-n", str(rows), "-o", "{}/out/set.parquet")
    assert check(judged, given(words, {})).code == 2


#: text in other languages than JSON that is refused: the file, and what reads it
LANGUAGES: dict[str, tuple[str, bytes]] = {
    "a key of TOML through 40 000 tables": ("model.toml", b"a" + b".a" * 40_000 + b" = 1"),
    "a key of a mapping through 40 000 tables": ("import.toml", b"a" + b".a" * 40_000 + b" = 1"),
    "an integer of TOML of 5 000 digits": ("model.toml", b"rga_model = 0x" + b"f" * 5000),
    "an integer of a mapping of 5 000 digits": ("import.toml", b"header_line = 0x" + b"f" * 5000),
    "an integer of YAML of 5 000 digits": ("model.yaml", b"rga_model: 0x" + b"f" * 5000),
    "a boolean of YAML that is none": ("model.yaml", b'x: !!bool "x"'),
    "a time of YAML that is none": ("model.yaml", b'x: !!timestamp "x"'),
    "a key of half a character": ("model.json", b'{"rga_model": 1, "\\ud800": {}}'),
}


@pytest.mark.parametrize("name", LANGUAGES)
def test_another_language(name: str, given: Given, judged: Judged) -> None:
    file, content = LANGUAGES[name]
    words = MAPPED if file == "import.toml" else ("check", f"{{}}/{file}")
    assert check(judged, given(words, {file: content})).code == 2


@pytest.mark.parametrize(
    "edit",
    [
        {"explanations": [{"effects": [{"kind": {}}]}]},
        {"gap": {"by_sensor": {"D1": {"after": float("nan")}}}},
    ],
    ids=["a kind that is a table", "a gap that is no number"],
)
def test_findings_that_were_edited(
    edit: dict[str, Any], sound: Path, given: Given, judged: Judged
) -> None:
    findings = json.loads((sound / "findings.json").read_text("utf-8"))
    findings |= edit
    words = ("plan", "{}/model.json", "{}/findings.json")
    check(judged, given(words, {"findings.json": json.dumps(findings).encode()}))


def test_findings_with_a_number_beyond_all_numbers(
    sound: Path, given: Given, judged: Judged
) -> None:
    findings = json.loads((sound / "findings.json").read_text("utf-8"))
    findings["explanations"][-1]["gap"] = "beyond"
    written = json.dumps(findings).replace('"beyond"', "1e400").encode()
    words = ("plan", "{}/model.json", "{}/findings.json")
    assert check(judged, given(words, {"findings.json": written})).code == 2


@pytest.mark.parametrize("value", ["1e400", "nan", "1e308"])
def test_a_drawing_that_reaches_beyond_all_bounds(value: str, given: Given, judged: Judged) -> None:
    tokens = f"0 SECTION 2 ENTITIES 0 LINE 8 0 10 {value} 20 0 30 0 11 1 21 1 31 0 0 ENDSEC 0 EOF"
    words = ("import", "{}/a.dxf", "--units", "m", "--kind", "truss", "--section", "A=12cm2")
    words = (*words, "--material", "E=210GPa", "-o", "{}/out/model.json")
    came = check(judged, given(words, {"a.dxf": "\n".join(tokens.split()).encode()}))
    assert came.code == 2


def test_a_name_that_is_no_text(given: Given, judged: Judged) -> None:
    words = ("simulate", "{}/model.json", "{}/contexts.csv", "-o", "{}/out/nul\udc80.csv")
    check(judged, given(words, {}))
