"""A measured steel truss bridge, where its record is at hand: `examples/rdso45m`.

Nothing here tells the diagnosis what to find; the checks are of what an engineer would see in
the same channels, and of a verdict that does not hang on names, order or sampling.
"""

import json
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from findings_invariants import check_invariants

EXAMPLE = Path(__file__).parents[2] / "examples" / "rdso45m"
RECORD = Path(__file__).parents[3] / "shared" / "measured" / "rdso45m" / "record_40kmh.txt"
pytestmark = pytest.mark.skipif(not RECORD.is_file(), reason="the measured record is not here")
FLOOR = {"floor_participation", "added_axial_area"}


@pytest.fixture(scope="module")
def findings() -> rga.Findings:
    """The diagnosis of the record as it is."""
    model = rga.load_model(EXAMPLE / "model.json")
    findings = rga.diagnose(model, rga.load_record(RECORD, model))
    check_invariants(findings)
    return findings


def gist(findings: rga.Findings) -> tuple[str, list[tuple[str, Any]]]:
    """Verdict, kinds and places."""
    causes = [(c.effect["kind"], c.effect.get("group")) for c in findings.causes]
    return findings.verdict, causes


def test_the_dead_channel_is_rejected(findings: rga.Findings) -> None:
    faults = [c.effect["sensor"] for c in findings.causes if c.effect["kind"] == "sensor_fault"]
    assert faults == ["S33"]


def test_a_swing_under_the_axles_moves_no_cause(findings: rga.Findings) -> None:
    """The dead channel swings between -14 000 and 17 500 microstrain while the train passes."""
    model = rga.load_model(EXAMPLE / "model.json")
    record = rga.load_record(RECORD, model)
    readings = record.readings.copy()
    passing = np.linspace(0, 1, len(readings))
    own = np.random.default_rng(3).standard_normal(len(readings)).cumsum()
    swing = np.sin(14 * np.pi * passing + 0.02 * own) * np.exp(-(((passing - 0.5) / 0.2) ** 2))
    readings[:, record.sensors.index("S33")] = 1750 + 15750 * swing
    swinging = rga.diagnose(model, replace(record, readings=readings))
    check_invariants(swinging)
    assert gist(swinging) == gist(findings)
    assert swinging.gap.held_out.after < 0.3 * swinging.gap.held_out.before


def test_the_train_is_found(findings: rga.Findings) -> None:
    # The record says about 40 km/h.
    (rate,) = (v for k, v in findings.contexts["train"].items() if k.startswith("rate"))
    assert 36 <= rate * 3.6 <= 44


def test_the_floor_and_not_a_bearing(findings: rga.Findings) -> None:
    structural = [c for c in findings.causes if c.effect["kind"] != "sensor_fault"]
    named = {c.effect["kind"] for c in structural}
    rivals = {rival["kind"] for c in structural for rival in c.rivals}
    assert named & FLOOR
    assert not (named | rivals) & {"support_spring", "bearing_friction", "elastic_modulus"}
    assert findings.verdict == "partial"
    # Tied or through its connections: the lead of one over the other hangs on single channels.
    assert named | rivals >= FLOOR
    assert all(c.separated_by for c in structural)


@pytest.mark.thorough
def test_half_a_crossing_says_the_same() -> None:
    """What hangs on the train's place must not be taken for something that begins on the way."""
    model = rga.load_model(EXAMPLE / "model.json")
    findings = rga.diagnose(model, rga.load_record(RECORD, model).rows(slice(0, 5548, 4)))
    kinds = {cause.effect["kind"] for cause in findings.causes} - {"sensor_fault"}
    assert kinds
    assert kinds <= FLOOR
    assert any("onsets were not looked for" in warning for warning in findings.warnings)


def test_explanations_are_judged_on_unseen_channels(findings: rga.Findings) -> None:
    # The likeliest of each kind: it stands first.
    likeliest = reversed(findings.explanations)
    by_kinds = {tuple(e["kind"] for e in one.effects): one for one in likeliest}
    nothing = by_kinds[()]
    (gains,) = (one for one in findings.explanations if one.words.startswith("a free gain"))
    floor = by_kinds[("floor_participation",)]
    assert floor.remark == "what is named"
    bearing = by_kinds[("support_spring",)]
    assert gains.gap < floor.gap
    assert floor.gap_unseen_channels is not None
    for other in (gains, bearing, nothing):
        assert other.gap_unseen_channels is not None
        assert floor.gap_unseen_channels < other.gap_unseen_channels


def test_the_gain_holds_on_unseen_rows(findings: rga.Findings) -> None:
    held = findings.gap.held_out
    assert held.gain_ci90[0] > 0
    assert held.after < 0.3 * held.before
    (chord,) = (group for group in findings.groups if "bottom chord" in group.group)
    assert chord.before_percent < -20
    assert abs(chord.after_percent) < 5


@pytest.mark.thorough
def test_every_second_sample_gives_the_same_verdict(findings: rga.Findings) -> None:
    model = rga.load_model(EXAMPLE / "model.json")
    record = rga.load_record(RECORD, model)
    half = record.rows(np.arange(len(record.time)) % 2 == 0)
    assert gist(rga.diagnose(model, half)) == gist(findings)


@pytest.mark.thorough
def test_names_and_order_do_not_matter(findings: rga.Findings, tmp_path: Path) -> None:
    content = json.loads((EXAMPLE / "model.json").read_text(encoding="utf-8"))
    mapping = tomllib.loads((EXAMPLE / "import.toml").read_text(encoding="utf-8"))
    names = {old: f"channel {k}" for k, old in enumerate(reversed(content["sensors"]))}
    content["sensors"] = {names[old]: content["sensors"][old] for old in names}
    (tmp_path / "model.json").write_text(json.dumps(content), encoding="utf-8")
    lines = (EXAMPLE / "import.toml").read_text(encoding="utf-8").splitlines()
    for old in mapping["channels"]:
        unit = "mm" if old.startswith("d") else "m/m"
        column = f'column = "{old} ({unit})", unit = "{unit}"'
        new = f'"{names[old]}" = {{ {column}, sign = -1 }}'
        lines = [new if line.startswith(f"{old} =") else line for line in lines]
    (tmp_path / "import.toml").write_text("\n".join(lines), encoding="utf-8")
    model = rga.load_model(tmp_path / "model.json")
    renamed = rga.diagnose(model, rga.load_record(RECORD, model, tmp_path / "import.toml"))
    faults = {c.effect.get("sensor") for c in renamed.causes} - {None}
    assert faults == {names["S33"]}
    assert gist(renamed) == gist(findings)
    assert renamed.gap.held_out.gain == pytest.approx(findings.gap.held_out.gain, rel=0.05)
