"""A part of the structure that stiffens when it freezes is named, and other weather is not.

The truth is a frame with scatter whose modes are computed anew at every kelvin, by plain NumPy; who
analyses it holds a truss that no temperature changes.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from independent.dense_modes import dense_mode_shapes
from independent.modal_bridge import Hidden, measured, truth
from rga.diagnosis import diagnose_modes
from rga.findings import Findings
from rga.model import Model, read_effect
from rga.model.parameter import Estimated
from rga.model.schema import ContextVariable
from rga.records.modal.record import ModalRecord

MODES, WINDOWS, SCATTERED = 6, 60, 1000
KELVINS = np.arange(-16.0, 24.0)
thorough = pytest.mark.thorough
SEEDS = [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 4))]


def air(time: np.ndarray) -> np.ndarray:
    """A cold spell and its days, over the windows [degC]."""
    hours = time / 3600.0
    return np.asarray(3 + 12 * np.sin(2 * np.pi * hours / WINDOWS) + 4 * np.sin(hours * np.pi / 12))


def frequencies(seed: int, hidden: Hidden) -> np.ndarray:
    return dense_mode_shapes(truth(np.random.default_rng(seed + SCATTERED), hidden, True), MODES)[0]


def in_weather(seed: int, courses: np.ndarray) -> tuple[Model, ModalRecord]:
    """The truss with a temperature that moves no mode, and modes that move, [kelvins, modes]."""
    model, record = measured(seed, Hidden(), MODES, WINDOWS)
    model = model.model_copy(
        update={"context": {"air": ContextVariable(unit="degC", range=(-20.0, 40.0))}}
    )
    warm = {
        "kind": "temperature",
        "groups": dict.fromkeys(model.groups, 1.0),
        "delta": {"context": "air", "minus": 10.0},
    }
    model = model.extended({"warm": read_effect(warm, "warm")})
    usual = frequencies(seed, Hidden())
    mode = np.abs(np.log(record.frequency[:, None] / usual)).argmin(axis=1)
    here = air(record.time)
    factor = [
        np.exp(np.interp(at, KELVINS, courses[:, one])) for at, one in zip(here, mode, strict=True)
    ]
    return model, replace(
        record, frequency=record.frequency * np.array(factor), contexts={"air": here}
    )


def moved(seed: int, hidden: list[Hidden]) -> np.ndarray:
    """What ln f moves by at every kelvin, against the warmest."""
    several = np.array([frequencies(seed, one) for one in hidden])
    return np.asarray(np.log(several / several[-1]))


def freezing(seed: int, group: str, below: float, kink: float) -> np.ndarray:
    """What a group does to ln f whose stiffness follows the temperature below a kink."""
    factors = 1.0 + below * np.minimum(KELVINS - kink, 0.0)
    return moved(seed, [Hidden(stiffness={group: one}) for one in factors])


def frozen_bearings(seed: int) -> np.ndarray:
    """What bearings do to ln f that hold the better sideways the colder it is."""
    held = 2e7 * np.exp(0.15 * np.maximum(-KELVINS, 0.0))
    return moved(seed, [Hidden(spring={"b0n": one, "b0s": one}) for one in held])


def weather_of_its_own(seed: int, sort: str) -> np.ndarray:
    """What the weather does to each mode that is no part of the structure's doing."""
    rng = np.random.default_rng(seed)
    slope, frost = 2e-4 * rng.uniform(0.7, 1.3, MODES), 1.5e-3 * rng.uniform(0.7, 1.3, MODES)
    if sort == "one mode":
        slope, frost = (4.0 * one * (np.arange(MODES) == seed % MODES) for one in (slope, frost))
    if sort == "any":
        slope, frost = 5e-4 * rng.standard_normal(MODES), 3e-3 * rng.standard_normal(MODES)
    return -np.outer(KELVINS, slope) - np.outer(np.minimum(KELVINS, 0.0), frost)


def found(findings: Findings, name: str) -> float:
    value = findings.causes[0].effect[name]
    assert isinstance(value, dict)
    return Estimated(**value).value


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("group", "below", "kink"),
    [
        ("bottom bracing", -0.012, 1.5),
        pytest.param("bottom n", -0.012, -1.0, marks=thorough),
    ],
)
def test_what_freezes_is_named_with_its_kink(
    seed: int, group: str, below: float, kink: float, tmp_path: Path
) -> None:
    findings = diagnose_modes(*in_weather(seed, freezing(seed, group, below, kink)))
    (cause,) = findings.causes
    named = [cause.effect, *cause.rivals]
    assert {one["kind"] for one in named} == {"stiffness_temperature"}
    assert group in [one["group"] for one in named]
    # A truss leaves more of a mode to its bracing than a frame does.
    assert 0.5 < found(findings, "below") / below < 1.3
    assert abs(found(findings, "kink") - kink) < 2.0
    assert findings.verdict == "partial"
    assert "bearings and soil that freeze" in findings.unexplained.looks_like
    floor = findings.gap.noise_floor
    assert findings.gap.after - floor < 0.5 * (findings.gap.before - floor)
    findings.write(tmp_path)
    assert "Natural frequencies over air." in (tmp_path / "report.html").read_text("utf-8")


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    "sort", ["all alike", *(pytest.param(one, marks=thorough) for one in ("one mode", "any"))]
)
def test_weather_that_no_part_explains_is_no_cause(seed: int, sort: str) -> None:
    findings = diagnose_modes(*in_weather(seed, weather_of_its_own(seed, sort)))
    assert findings.causes == []


@thorough
def test_of_frozen_bearings_nothing_is_certain() -> None:
    findings = diagnose_modes(*in_weather(0, frozen_bearings(0)))
    assert findings.verdict in ("partial", "unknown", "nothing_wrong")
    assert not findings.causes or "bearings and soil" in findings.unexplained.looks_like


def test_where_no_temperature_was_measured_none_is_followed(tmp_path: Path) -> None:
    model, record = in_weather(0, np.zeros((len(KELVINS), MODES)))
    findings = diagnose_modes(model, replace(record, contexts={}))
    assert findings.causes == []
    findings.write(tmp_path)
    report = (tmp_path / "report.html").read_text("utf-8")
    assert "Natural frequencies over time." in report
    assert "Natural frequencies over air." not in report
