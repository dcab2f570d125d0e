"""A user's script: its types are checked by `mypy --strict`, and it is not run.

What is refused must stay refused: `mypy --strict` complains where an ignored error is none.
"""

from pathlib import Path
from typing import assert_type

import numpy as np
import polars as pl
from numpy.typing import NDArray

import rga
from rga.checking import CheckResult
from rga.checking.finding import Severity
from rga.detection import Alarm, SyncMonitor, rows_between
from rga.model import Model
from rga.records import Record

Array = NDArray[np.float64]


def diagnoses(folder: Path) -> str:
    model = rga.load_model(folder / "model.json")
    assert_type(model, Model)
    record = rga.load_record(folder / "record.csv", model)
    assert_type(record, Record)
    found = rga.diagnose(model, record, seed=3)
    assert_type(found, rga.Findings)
    rga.diagnose(record, model)  # type: ignore[arg-type]
    rga.diagnose(model)  # type: ignore[call-arg]
    of_files = rga.diagnose("model.json", folder / "record.csv", mapping="import.toml")
    assert_type(of_files, rga.Findings)
    found.write(folder / "out")
    plan = rga.plan(model, found, sensors=1, positions=2)
    assert_type(plan.sentence, str)
    assert_type([cause.log_odds for cause in found.causes], list[float])
    return found.sentence()


def simulates(model: Model) -> Array:
    simulator = rga.Simulator(model)
    shown = simulator.predict({"load": np.array([1.0, 2.0]), "temperature": 10.0})
    assert_type(shown, Array)
    simulator.predict(["load"])  # type: ignore[arg-type]
    return rga.Simulator("model.json").predict(pl.DataFrame({"load": [1.0, 2.0]}))


def checks(model: Model, record: Record) -> bool:
    checked = rga.check(model, record)
    assert_type(checked, CheckResult)
    assert_type([one.severity for one in checked.findings], list[Severity])
    rga.check(record)  # type: ignore[arg-type]
    return rga.check("model.json").ok


def watches(baseline: Array, rows: Array) -> str:
    monitor = SyncMonitor(baseline, arl0=rows_between(1, per="month", rate=1.0))
    assert_type(monitor.update_many(rows), NDArray[np.bool_])
    assert_type(monitor.alarm, Alarm | None)
    monitor.alarm.sentence()  # type: ignore[union-attr]
    return monitor.alarm.sentence() if monitor.alarm else ""
