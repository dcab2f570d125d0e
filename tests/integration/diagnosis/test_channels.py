"""Gauges that spike by themselves, and gauges that leave together as the bridge has changed."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rga import Findings, Simulator, load_model, load_record
from rga.diagnosis.preparation.prepare import prepare
from rga.errors import InputError
from rga.model import read_effect, read_model
from rga.report import write_report
from rga_bench.diagnosis.design import Draw
from rga_bench.synthetic import Case

Diagnosed = Callable[[Case], Findings]


@pytest.fixture(scope="module")
def healthy() -> Case:
    return Draw.parse("5005-single-7-null").case()


def changed(case: Case, effect: dict[str, object]) -> Case:
    """The case with what an effect changes in a simulation added to its readings."""
    model = read_model(case.model, "footbridge")
    contexts = {"time": case.time, **{name: case.channels[name] for name in model.context}}
    other = model.extended({"hidden": read_effect(effect, "hidden")})
    change = Simulator(other).predict(contexts) - Simulator(model).predict(contexts)
    added = dict(zip(model.sensors, change.T, strict=True))
    return replace(
        case,
        channels={
            name: column + added[name] if name in added else column
            for name, column in case.channels.items()
        },
    )


def kinds(findings: Findings) -> list[str]:
    return [cause.effect["kind"] for cause in findings.causes]


def test_a_bearing_that_sticks_convicts_no_gauge(healthy: Case, diagnosed: Diagnosed) -> None:
    stuck = {"kind": "support_spring", "support": "rocker", "dof": "ux", "stiffness": 4e7}
    findings = diagnosed(changed(healthy, {**stuck, "onset": 400000.0}))
    assert kinds(findings) == ["support_spring"]
    assert kinds(diagnosed(healthy)) == []


def test_a_gauge_that_spikes_is_convicted(healthy: Case, diagnosed: Diagnosed) -> None:
    column = healthy.channels["w2"].copy()
    column[3::25] += 60 * healthy.model["sensors"]["w2"]["noise"]
    findings = diagnosed(replace(healthy, channels={**healthy.channels, "w2": column}))
    assert [(c.effect["kind"], c.effect["sensor"]) for c in findings.causes] == [
        ("sensor_fault", "w2")
    ]


def warnings(case: Case, folder: Path) -> list[str]:
    case.write(folder)
    model = load_model(folder / "model.json")
    record = load_record(folder / "record.csv", model)
    return prepare(model, record, lambda done: None).warnings


def test_another_unit_and_a_context_that_stands_still_are_warned_of(
    healthy: Case, tmp_path: Path
) -> None:
    sensors = healthy.model["sensors"]
    milli = {
        name: 1e3 * column if name in sensors else column
        for name, column in healthy.channels.items()
    }
    (warning,) = warnings(replace(healthy, channels=milli), tmp_path)
    assert "check the units" in warning
    kelvin = healthy.channels["air"] + 273.15
    *_, warning = warnings(replace(healthy, channels={**healthy.channels, "air": kelvin}), tmp_path)
    assert "air lies outside its range" in warning
    assert "in every row" in warning
    still = healthy.channels["air"].copy()
    still[120:] = still[120]
    (warning,) = warnings(replace(healthy, channels={**healthy.channels, "air": still}), tmp_path)
    assert "air reads" in warning
    assert "last 180 of 300 rows" in warning
    assert warnings(healthy, tmp_path) == []


@pytest.mark.thorough
def test_a_swap_has_a_report(healthy: Case, diagnosed: Diagnosed, tmp_path: Path) -> None:
    one, other = healthy.channels["w2"], healthy.channels["w6"]
    channels = {**healthy.channels, "w2": other, "w6": one}
    findings = diagnosed(replace(healthy, channels=channels))
    assert kinds(findings) == ["sensor_swap"]
    write_report(findings, tmp_path / "report.html")
    assert "w2" in (tmp_path / "report.html").read_text(encoding="utf-8")


def silenced(case: Case, silent: list[str]) -> Case:
    """The case with channels that end with their first readings."""
    dead = {name: case.channels[name].copy() for name in silent}
    for column in dead.values():
        column[5:] = np.nan
    return replace(case, channels={**case.channels, **dead})


def test_few_channels_without_a_reading_are_told_of(
    healthy: Case, diagnosed: Diagnosed, tmp_path: Path
) -> None:
    silent = list(healthy.model["sensors"])[:2]
    findings = diagnosed(silenced(healthy, silent))
    assert findings.verdict == "nothing_wrong"
    assert any(f"or hardly any: {', '.join(silent)}; " in one for one in findings.warnings)
    assert not set(silent) & set(findings.gap.by_sensor)
    write_report(findings, tmp_path / "report.html")
    assert "have no reading" in (tmp_path / "report.html").read_text("utf-8")


def test_where_most_have_none_nothing_is_called_right(
    healthy: Case, diagnosed: Diagnosed, tmp_path: Path
) -> None:
    names = list(healthy.model["sensors"])
    findings = diagnosed(silenced(healthy, names[: len(names) * 2 // 3]))
    assert findings.verdict == "unknown"
    assert "have no reading" in findings.unexplained.looks_like
    with pytest.raises(InputError, match="no channel has a reading"):
        diagnosed(silenced(healthy, names))
