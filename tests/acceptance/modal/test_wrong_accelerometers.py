"""Accelerometers that are turned, dead, off or exchanged are found beside a structure, and alone.

The truth is a frame with scatter, solved by plain NumPy; who analyses it holds a truss.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from independent.accelerometers import at_some, exchanged, noise_alone, scaled
from independent.mixed_bridge import mixed
from independent.modal_bridge import Hidden, measured
from rga.diagnosis import diagnose, diagnose_modes
from rga.findings import Findings
from rga.findings.phrases import effect_words
from rga.model import read_effect
from rga.planning.planner import plan
from rga.records.modal.record import ModalRecord
from rga.report.text.actions import actions

thorough = pytest.mark.thorough
SEEDS = [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 4))]
Spoil = Callable[[ModalRecord], ModalRecord]
POINT, OTHER = "b3n z", "t3n y"
TWELVE = (
    "b1n y", "b3n y", "b5n y", "b1n z", "b3n z", "b5n z",
    "b1s z", "b3s z", "b5s z", "t1n y", "t3n y", "b3s y",
)  # fmt: skip
EIGHT = ("b1n y", "b1n z", "b3n y", "b3n z", "b5n z", "t3n y", "b3s z", "t1s y")


def turned(record: ModalRecord) -> ModalRecord:
    return scaled(record, {POINT: -1.0})


def zeros(record: ModalRecord) -> ModalRecord:
    return scaled(record, {POINT: 0.0})


def noise(record: ModalRecord) -> ModalRecord:
    return noise_alone(record, POINT, 1)


def half(record: ModalRecord) -> ModalRecord:
    return scaled(record, {POINT: 0.5})


def swapped(record: ModalRecord) -> ModalRecord:
    return exchanged(record, POINT, OTHER)


def places(findings: Findings) -> list[tuple[str, object]]:
    """Kinds of the causes at points, and where."""
    return [
        (str(one.effect["kind"]), one.effect.get("point") or one.effect.get("points"))
        for one in findings.causes
        if "point" in one.effect or "points" in one.effect
    ]


@pytest.mark.parametrize("seed", SEEDS)
def test_a_turned_one_is_named_and_what_to_do_about_it(seed: int) -> None:
    model, record = measured(seed, Hidden())
    findings = diagnose_modes(model, turned(record))
    assert findings.verdict == "named"
    (cause,) = findings.causes
    assert places(findings) == [("sensor_gain", POINT)]
    low, high = cause.effect["factor"]["ci90"]
    assert low < -1.0 < high < -0.5
    assert effect_words(cause.effect).startswith("sensor gain at point b3n z: factor -")
    assert ("inspect", "the fixing and the direction of the sensor at point b3n z") in actions(
        cause.effect
    )
    assert f"another accelerometer beside point {POINT}" in cause.separated_by
    assert "MAC" in cause.why
    # A mode that is not known with it turned has its name back.
    assert findings.warnings == []


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("spoil", [zeros, noise])
def test_a_dead_one_is_named(seed: int, spoil: Spoil) -> None:
    model, record = measured(seed, Hidden())
    findings = diagnose_modes(model, spoil(record))
    assert findings.verdict == "named"
    assert places(findings) == [("sensor_fault", POINT)]
    assert findings.causes[0].effect["mode"] == "dead"
    assert f"Channels that do not work: point {POINT}." in findings.sentence()


@pytest.mark.parametrize("seed", SEEDS)
def test_one_that_shows_half_is_named_with_its_factor(seed: int) -> None:
    model, record = measured(seed, Hidden())
    findings = diagnose_modes(model, half(record))
    assert findings.verdict == "named"
    assert places(findings) == [("sensor_gain", POINT)]
    low, high = findings.causes[0].effect["factor"]["ci90"]
    assert 0.3 < low < 0.5 < high < 0.7


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    "point", ["b3s y", *(pytest.param(p, marks=thorough) for p in TWELVE[:-1])]
)
def test_one_that_shows_half_is_named_among_few(seed: int, point: str) -> None:
    """Of few points one that is wrong is a large share of what can be said of all."""
    model, record = measured(seed, Hidden(), modes=4)
    findings = diagnose_modes(model, scaled(at_some(record, TWELVE), {point: 0.5}))
    assert findings.verdict == "named"
    assert places(findings) == [("sensor_gain", point)]
    low, high = findings.causes[0].effect["factor"]["ci90"]
    assert 0.3 < low < 0.5 < high < 0.7


@pytest.mark.parametrize("seed", SEEDS)
def test_one_that_shows_too_much_is_named_with_its_factor(seed: int) -> None:
    model, record = measured(seed, Hidden())
    findings = diagnose_modes(model, scaled(record, {POINT: 1.5}))
    assert findings.verdict == "named"
    assert places(findings) == [("sensor_gain", POINT)]
    low, high = findings.causes[0].effect["factor"]["ci90"]
    assert 1.2 < low < 1.5 < high < 1.8


@pytest.mark.parametrize("seed", SEEDS)
def test_one_that_is_turned_in_the_middle_is_told_with_its_moment(seed: int) -> None:
    model, record = measured(seed, Hidden())
    late = record.windows >= 20
    shapes = np.where(late[:, None], turned(record).shapes, record.shapes)
    findings = diagnose_modes(model, replace(record, shapes=shapes))
    assert findings.verdict in ("partial", "unknown")
    assert all("point" in one.effect for one in findings.causes)
    assert f"{POINT} from 72000.0 on" in findings.unexplained.looks_like


@pytest.mark.parametrize("seed", SEEDS)
def test_two_that_are_exchanged_are_named(seed: int) -> None:
    model, record = measured(seed, Hidden())
    findings = diagnose_modes(model, swapped(record))
    assert findings.verdict == "named"
    assert places(findings) == [("sensor_swap", [POINT, OTHER])]


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=thorough) for seed in range(1, 6))])
def test_of_right_ones_nothing_is_named(seed: int) -> None:
    model, record = measured(seed, Hidden())
    for some in (record, at_some(record, TWELVE), at_some(record, EIGHT)):
        findings = diagnose_modes(model, some)
        assert findings.causes == []
        assert findings.verdict == "nothing_wrong"


@pytest.mark.parametrize(
    ("spoil", "kind"),
    [
        (turned, "sensor_gain"),
        pytest.param(noise, "sensor_fault", marks=thorough),
        pytest.param(half, "sensor_gain", marks=thorough),
        pytest.param(swapped, "sensor_swap", marks=thorough),
    ],
)
def test_beside_soft_bearings_both_are_named(spoil: Spoil, kind: str) -> None:
    soft = Hidden(spring={"b0n": 1.5e7, "b0s": 1.5e7})
    model, record = measured(0, soft)
    findings = diagnose_modes(model, spoil(record))
    found = {one.effect["kind"]: one.effect for one in findings.causes}
    assert found.keys() == {"support_flexibility", kind}
    assert set(found["support_flexibility"]["support"]) == {"west n", "west s"}
    assert places(findings)[0][0] == kind


def test_what_is_known_of_points_is_no_cause_and_is_planned_around() -> None:
    model, record = measured(0, Hidden())
    known = read_effect({"kind": "sensor_gain", "point": POINT, "factor": -1.0}, "known")
    dead = read_effect({"kind": "sensor_fault", "point": OTHER, "mode": "dead"}, "dead")
    model = model.extended({"known": known, "dead": dead})
    findings = diagnose_modes(model, scaled(turned(record), {OTHER: 30.0}))
    assert findings.causes == []
    assert findings.verdict == "nothing_wrong"
    assert findings.warnings == []
    found = diagnose_modes(measured(0, Hidden())[0], turned(record))
    assert plan(measured(0, Hidden())[0], found, sensors=1, positions=0).separations


def test_modes_beside_a_record_name_it_too() -> None:
    model, record, modal = mixed(0, Hidden())
    findings = diagnose(model, record, modal=turned(modal))
    assert places(findings) == [("sensor_gain", POINT)]
    assert findings.causes[0].onset is None
    assert np.isfinite(findings.causes[0].log_odds)
