"""What several tests share: a small bridge, and the command line as a user meets it."""

import gc
import json
from collections.abc import Callable
from copy import deepcopy
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import polars as pl
import pytest
from hypothesis import settings

from findings_invariants import check_invariants
from rga.cli import main
from rga.diagnosis import diagnose
from rga.findings import Findings
from rga.model import Model, load_model, read_effect, read_model
from rga.records import Record, load_record
from rga.simulation import Simulator
from rga.twin.settings import Settings
from rga_bench.synthetic import Case


def pytest_configure() -> None:
    """Modules and tests are gathered without a search for garbage: hardly any of it is.

    A machine that does other work beside the tests is no fault: no time is asked of a case.
    """
    gc.disable()
    settings.register_profile("any time", deadline=None)
    settings.load_profile("any time")


def pytest_collection_finish() -> None:
    """What was gathered stays to the end: a search for garbage need not go through it again."""
    gc.collect()
    gc.freeze()
    # A search now and then: what is no longer needed is mostly freed without one.
    gc.set_threshold(50_000, 20, 20)
    gc.enable()


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
def without_reports(monkeypatch: pytest.MonkeyPatch) -> None:
    """Findings are written without reports: drawing one takes longer than many a diagnosis."""
    monkeypatch.setattr("rga.report.write_report", lambda findings, path: path)
    monkeypatch.setattr("rga.report.write_run_report", lambda history, findings, path: path)


@pytest.fixture(scope="session")
def diagnosed(tmp_path_factory: pytest.TempPathFactory) -> Callable[[Case], Findings]:
    """Diagnoses a case from its files."""

    def diagnosis(case: Case) -> Findings:
        folder = tmp_path_factory.mktemp("case")
        case.write(folder)
        model = load_model(folder / "model.json")
        findings = diagnose(model, load_record(folder / "record.csv", model))
        check_invariants(findings)
        return findings

    return diagnosis


@pytest.fixture(scope="session")
def bars() -> dict[str, Any]:
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
def two_bars(bars: dict[str, Any]) -> dict[str, Any]:
    """A copy of it, to be changed."""
    return deepcopy(bars)


@pytest.fixture
def model_file(tmp_path: Path, two_bars: dict[str, Any]) -> Path:
    """The two bars as a file."""
    path = tmp_path / "model.json"
    path.write_text(json.dumps(two_bars), encoding="utf-8")
    return path


@pytest.fixture(scope="session")
def small_bridge() -> dict[str, Any]:
    """A model file: a plane truss of four panels, its temperature measured, its two loads not."""
    nodes = {f"L{i}": [3.0 * i, 0, 0] for i in range(5)}
    nodes |= {f"U{i}": [3.0 * i, 0, 3.0] for i in range(1, 4)}
    bars = {
        "bottom chord": ["L0-L1", "L1-L2", "L2-L3", "L3-L4"],
        "top chord": ["U1-U2", "U2-U3"],
        "verticals": ["L1-U1", "L2-U2", "L3-U3"],
        "diagonals": ["L0-U1", "L4-U3", "U1-L2", "L2-U3"],
    }
    sensors: dict[str, Any] = {
        f"D{i}": {
            "kind": "displacement",
            "node": f"L{i}",
            "direction": [0, 0, 1],
            "unit": "mm",
            "noise": 0.05,
        }
        for i in (1, 2, 3)
    }
    sensors["DX"] = {**sensors["D1"], "node": "L4", "direction": [1, 0, 0]}
    for bar in ("L0-L1", "L2-L3", "U1-U2", "U2-U3", "L0-U1", "U1-L2", "L2-U3"):
        strain = {"kind": "strain", "member": bar, "unit": "microstrain", "noise": 1.0}
        sensors[f"S {bar}"] = strain
    load = {"unit": "kN", "range": [0, 100]}
    return {
        "rga_model": 1,
        "name": "small bridge",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
        "sections": {"bar": {"A": 0.004}},
        "nodes": nodes,
        "members": {
            bar: {"nodes": bar.split("-"), "section": "bar", "material": "steel", "groups": [group]}
            for group, members in bars.items()
            for bar in members
        },
        "supports": {
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": "L4", "fixed": ["uz"]},
        },
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40], "noise": 0.3},
            "west load": load,
            "east load": load,
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": dict.fromkeys(bars, 1.0),
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "west": {
                "kind": "nodal_load",
                "forces": {"L1": [0, 0, -1000], "L2": [0, 0, -500]},
                "factor": {"context": "west load"},
            },
            "east": {
                "kind": "nodal_load",
                "forces": {"L3": [0, 0, -1000], "L2": [0, 0, -500]},
                "factor": {"context": "east load"},
            },
        },
        "sensors": sensors,
    }


@pytest.fixture(scope="session")
def small_stream(
    small_bridge: dict[str, Any], tmp_path_factory: pytest.TempPathFactory
) -> Callable[..., Path]:
    """Writes model.json, record.csv and settings.json of a short stream on the small bridge.

    It tests the loop, not the finding: the record is the simulator's own, with gains and noise. A
    heavy load comes and goes in rows 60 to 89; from row 105 on a bearing is 2 mm lower (`sinks`).
    """

    def write(*, drifts: bool = True, sinks: bool = True, rows: int = 150) -> Path:
        draw = np.random.default_rng(3)
        time, days = 600.0 * np.arange(rows), np.arange(rows) / 24
        west = 20 + 10 * np.sin(3 * days) + 8 * draw.random(rows)
        if drifts:
            west[60:90] += 70
        contexts = {
            "time": time,
            "temperature": 10 + 6 * np.sin(2 * np.pi * days),
            "west load": west,
            "east load": 25 + 10 * np.cos(2 * days) + 8 * draw.random(rows),
        }
        model = read_model(small_bridge, "small bridge")
        if sinks:
            low = {"kind": "support_settlement", "support": "east", "dof": "uz"}
            low |= {"displacement": -0.002, "onset": 600.0 * 105}
            model = model.extended({"low": read_effect(low, "low")})
        readings = Simulator(model).predict(contexts)
        readings *= 1 + 0.01 * draw.standard_normal(readings.shape[1])
        noise = np.array([sensor.noise for sensor in model.sensors.values()], dtype=float)
        readings += noise * draw.standard_normal(readings.shape)
        measured = contexts["temperature"] + 0.3 * draw.standard_normal(rows)
        folder = tmp_path_factory.mktemp("small")
        columns = {"time": time, "temperature": measured}
        columns |= dict(zip(model.sensors, readings.T, strict=True))
        pl.DataFrame(columns).write_csv(folder / "record.csv")
        (folder / "model.json").write_text(json.dumps(small_bridge), encoding="utf-8")
        training = {"steps": 200, "fine_steps": 60, "reduced_steps": 200, "width": 32}
        training |= {"features": 8, "reduced_width": 32}
        settings = {
            "calibration_rows": 40,
            "packet": 10,
            "detector": "window",
            "window": 30,
            "persistence": [3, 4],
            "settle": 12,
            "design_rows": 256,
            "training": training,
        }
        (folder / "settings.json").write_text(json.dumps(settings), encoding="utf-8")
        return folder

    return write


@pytest.fixture(scope="session")
def measured_bridge(small_bridge: dict[str, Any]) -> dict[str, Any]:
    """A model file: the small bridge, its loads measured too."""
    content: dict[str, Any] = json.loads(json.dumps(small_bridge))
    for load in ("west load", "east load"):
        content["context"][load]["noise"] = 0.1
    return content


@pytest.fixture(scope="session")
def measured_record() -> Callable[..., Record]:
    """A record of the measured bridge: 100 rows of the simulator's own, with noise.

    It tests what is done with findings, not the finding.
    """

    def record(model: Model, *hidden: dict[str, Any], rows: int = 100) -> Record:
        draw = np.random.default_rng(4)
        time = 600.0 * np.arange(rows)
        contexts = {
            "temperature": 10 + 6 * np.sin(2 * np.pi * time / 86400),
            "west load": 20 + 30 * draw.random(rows),
            "east load": 20 + 30 * draw.random(rows),
        }
        effects = {str(k): read_effect(one, "hidden") for k, one in enumerate(hidden)}
        readings = Simulator(model.extended(effects)).predict({"time": time, **contexts})
        noise = np.array([sensor.noise for sensor in model.sensors.values()], dtype=float)
        readings = readings + noise * draw.standard_normal(readings.shape)
        measured = {
            name: column + model.context[name].noise * draw.standard_normal(rows)
            for name, column in contexts.items()
        }
        return Record(time, 0.0, "seconds", tuple(model.sensors), readings, measured)

    return record


@pytest.fixture
def few_methods(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """The methods of the levels of integration, for a while, and thresholds of short streams."""
    from context_tasks import nearest
    from rga_bench.contexts.rows import METHODS, Row

    methods = {
        "prior mean": METHODS["prior mean"],
        "nearest": Row(nearest),
        "absent": Row(nearest, needs=("no_such_package",)),
    }
    for module in ("experiment", "task_run", "tables.targets"):
        monkeypatch.setattr(f"rga_bench.contexts.{module}.METHODS", methods)
    monkeypatch.setattr("rga_bench.contexts.twin_run.Settings", partial(Settings, arl0=2000.0))
    return methods
