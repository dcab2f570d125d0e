"""Files that are spoiled in one to three ways, through every command that reads them."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hostile.spoiling import damaged, dumped, spoiled, toml

#: model and record of a folder
MODEL, RECORD = "{}/model.json", "{}/record.csv"
#: cases in every run; and cases of a test, and how many tests there are, at full length
FEW, CASES, TESTS = 20, 60, 80

SETTINGS: dict[str, Any] = {
    "calibration_rows": 20, "packet": 10, "settle": 10, "detector": "window", "window": 30,
    "persistence": [3, 4], "design_rows": 64, "level": "B", "inference": "joint",
}  # fmt: skip
CRITERIA: dict[str, Any] = {"record": {"most_rows": 2000}, "cause": {"log_odds": 6.0}}
MAPPING: dict[str, Any] = {
    "time": {"column": "time", "format": "%Y-%m-%dT%H:%M:%S"},
    "separator": ",",
    "decimal": ".",
    "encoding": "utf-8",
    "skip_rows": 0,
    "missing": ["NA", -9999],
    "channels": {
        "D1": {"column": "D1", "scale": 1.0, "unit": "mm"},
        "S1": {"column": "S1"},
        "S2": {"column": "S2"},
        "temperature": {"column": "temperature"},
    },
}
#: by kind: the file that is spoiled, and the command lines that read it
READERS: dict[str, tuple[str, tuple[tuple[str, ...], ...]]] = {
    "model": (
        "model.json",
        (
            ("check", MODEL),
            ("draw", MODEL, "-o", "{}/out/drawing.svg"),
            ("simulate", MODEL, "{}/contexts.csv", "-o", "{}/out/simulated.csv"),
            ("results", MODEL, "--contexts", "temperature=3,load=5", "-o", "{}/out/results.csv"),
            ("whatif", MODEL, "--set", "load=3", "--set", "temperature=5"),
            ("dataset", MODEL, "-n", "20", "-o", "{}/out/set.parquet"),
            ("diagnose", MODEL, RECORD, "-o", "{}/out"),
            ("plan", MODEL, "{}/findings.json"),
            ("import-record", RECORD, "--model", MODEL, "-o", "{}/out/import.toml"),
        ),
    ),
    "model.yaml": (
        "model.yaml",
        (("check", "{}/model.yaml"), ("diagnose", "{}/model.yaml", RECORD, "-o", "{}/out")),
    ),
    "model.toml": ("model.toml", (("check", "{}/model.toml"),)),
    "record": (
        "record.csv",
        (
            ("diagnose", MODEL, RECORD, "-o", "{}/out"),
            ("import-record", RECORD, "--model", MODEL, "-o", "{}/out/import.toml"),
            ("diagnose-many", "{}/list.csv", "-o", "{}/out", "--workers", "1"),
        ),
    ),
    "record.parquet": (
        "record.parquet",
        (("diagnose", MODEL, "{}/record.parquet", "-o", "{}/out"),),
    ),
    "contexts": (
        "contexts.csv",
        (
            ("simulate", MODEL, "{}/contexts.csv", "-o", "{}/out/simulated.csv"),
            ("results", MODEL, "{}/contexts.csv", "-o", "{}/out/results.csv"),
        ),
    ),
    "mapping": (
        "import.toml",
        (("diagnose", MODEL, RECORD, "--import", "{}/import.toml", "-o", "{}/out"),),
    ),
    "settings": (
        "settings.json",
        (("run", MODEL, RECORD, "-o", "{}/out", "--settings", "{}/settings.json"),),
    ),
    "settings.toml": (
        "settings.toml",
        (("run", MODEL, RECORD, "-o", "{}/out", "--settings", "{}/settings.toml"),),
    ),
    "criteria": (
        "criteria.json",
        (("diagnose", MODEL, RECORD, "--criteria", "{}/criteria.json", "-o", "{}/out"),),
    ),
    "findings": ("findings.json", (("plan", MODEL, "{}/findings.json"),)),
    "list": ("list.csv", (("diagnose-many", "{}/list.csv", "-o", "{}/out", "--workers", "1"),)),
}
TREES = {
    "settings.json": SETTINGS,
    "settings.toml": SETTINGS,
    "criteria.json": CRITERIA,
    "import.toml": MAPPING,
}


def content(name: str, sound: Path, draw: np.random.Generator) -> bytes:
    """A file that is spoiled, by its name."""
    form = name.rpartition(".")[2]
    known = sound / ("model.json" if name.startswith("model") else name)
    tree = TREES.get(name)
    if tree is None and known.suffix == ".json":
        tree = json.loads(known.read_text("utf-8"))
    if tree is None:
        return damaged(known.read_bytes(), draw)
    as_bytes = toml if form == "toml" else lambda one: dumped(one, form)
    return damaged(as_bytes(tree), draw) if draw.random() < 0.15 else as_bytes(spoiled(tree, draw))


def drawn(number: int, sound: Path) -> tuple[tuple[str, ...], dict[str, bytes]]:
    """The command line of a case, and the file that it is spoiled by."""
    draw = np.random.default_rng(number)
    name, lines = list(READERS.values())[draw.integers(len(READERS))]
    spoilt = content(name, sound, draw)
    return lines[draw.integers(len(lines))], {name: spoilt}


def test_some_spoiled_files(sound: Path, judged_all: Callable[..., None]) -> None:
    judged_all(range(FEW), lambda number: drawn(number, sound))


@pytest.mark.thorough
@pytest.mark.parametrize("place", range(1, TESTS + 1))
def test_spoiled_files(place: int, sound: Path, judged_all: Callable[..., None]) -> None:
    judged_all(range(CASES * place, CASES * (place + 1)), lambda number: drawn(number, sound))
