"""What several tests share: a small bridge, and the command line as a user meets it."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from rga.cli import main


class Outcome(NamedTuple):
    """What a command left behind."""

    code: int
    out: str
    err: str


@pytest.fixture
def rga(capsys: pytest.CaptureFixture[str]) -> Callable[..., Outcome]:
    """Runs a command line and returns its exit code and what it wrote."""

    def run(*arguments: str | Path) -> Outcome:
        capsys.readouterr()
        with pytest.raises(SystemExit) as left:
            main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        return Outcome(int(left.value.code or 0), out, err)

    return run


@pytest.fixture
def two_bars() -> dict[str, Any]:
    """A model file: two bars over a span, a load and a temperature, a deflection and a strain."""
    bar = {"section": "bar", "material": "steel", "groups": ["bars"]}
    return {
        "rga_model": 1,
        "name": "two bars",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
        "sections": {"bar": {"A": 0.01}},
        "nodes": {"W": [0, 0, 0], "T": [3, 0, 4], "E": [6, 0, 0]},
        "members": {"west": {"nodes": ["W", "T"], **bar}, "east": {"nodes": ["T", "E"], **bar}},
        "supports": {
            "W": {"node": "W", "fixed": ["ux", "uy", "uz"]},
            "E": {"node": "E", "fixed": ["ux", "uy", "uz"]},
        },
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40]},
            "load": {"unit": "N", "range": [0, 1e5]},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {"bars": 1.0},
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "weight": {
                "kind": "nodal_load",
                "forces": {"T": [0, 0, -1]},
                "factor": {"context": "load"},
            },
        },
        "sensors": {
            "D1": {
                "kind": "displacement",
                "node": "T",
                "direction": [0, 0, 1],
                "unit": "mm",
                "noise": 0.01,
            },
            "S1": {"kind": "strain", "member": "west", "unit": "microstrain", "noise": 0.5},
        },
    }


@pytest.fixture
def model_file(tmp_path: Path, two_bars: dict[str, Any]) -> Path:
    """The two bars as a file."""
    path = tmp_path / "model.json"
    path.write_text(json.dumps(two_bars), encoding="utf-8")
    return path
