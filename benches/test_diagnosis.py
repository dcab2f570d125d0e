"""What a diagnosis costs: `pytest benches/test_diagnosis.py` (needs pytest-benchmark).

The bridge of the case study with 84 sensors, 300 rows and 1 050 hypotheses, on one core. Every
stiffness is a little off as built, and the contexts are measured.
"""

from pathlib import Path
from typing import Any

import numpy as np
import polars
import pytest

import rga
from rga.model import Model, read_effect, read_model
from rga_bench.synthetic.bridges.case_study import case_study_bridge

SENSORS, ROWS = 84, 300
HIDDEN: dict[str, dict[str, Any]] = {
    "nothing": {},
    "section loss": {"kind": "member_stiffness", "member": "north.L4-L5", "factor": 0.6},
    "bearing": {"kind": "support_spring", "support": "east north", "dof": "ux", "stiffness": 3e7},
    "gauge": {"kind": "sensor_gain", "factor": 0.8},
}


@pytest.fixture(scope="module")
def model() -> Model:
    content = case_study_bridge().model
    sensors = dict(content["sensors"])
    gauged = {sensor.get("member") for sensor in sensors.values()}
    for name in [name for name in content["members"] if name not in gauged]:
        if len(sensors) < SENSORS:
            gauge = {"kind": "strain", "member": name, "unit": "microstrain", "noise": 1.0}
            sensors[f"gauge {name}"] = gauge
    return read_model({**content, "sensors": sensors}, "case study")


@pytest.mark.parametrize("hidden", HIDDEN)
def test_diagnosis(benchmark: Any, tmp_path: Path, model: Model, hidden: str) -> None:
    rng = np.random.default_rng(1)
    built = {
        f"as built {name}": {
            "kind": "member_stiffness",
            "member": name,
            "factor": float(np.exp(0.01 * rng.normal())),
        }
        for name in model.members
    }
    effect = HIDDEN[hidden]
    if hidden == "gauge":
        effect = {**effect, "sensor": list(model.sensors)[7]}
    if effect:
        built["hidden"] = effect
    true = model.extended({name: read_effect(one, name) for name, one in built.items()})
    contexts = {name: rng.uniform(*one.range, ROWS) for name, one in model.context.items()}
    shown = rga.Simulator(true).predict(contexts)
    noise = [sensor.noise or 0.3 for sensor in model.sensors.values()]
    shown += noise * rng.normal(size=shown.shape)
    columns = {**contexts, **dict(zip(model.sensors, shown.T, strict=True))}
    table = polars.DataFrame({"time": 3600.0 * np.arange(ROWS), **columns})
    table.write_csv(tmp_path / "record.csv")
    record = rga.load_record(tmp_path / "record.csv", model)
    findings = benchmark.pedantic(rga.diagnose, (model, record), rounds=1)
    kinds = [cause.effect["kind"] for cause in findings.causes]
    assert kinds == ([effect["kind"]] if effect else [])
