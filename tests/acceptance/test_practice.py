"""The practice cases of a foreign finite-element program, where they are at hand."""

import json
from pathlib import Path
from typing import Any

import pytest

import rga
from findings_invariants import check_invariants

CASES = Path(__file__).parents[3] / "shared" / "measured" / "practice"
pytestmark = pytest.mark.skipif(not CASES.is_dir(), reason="the practice cases are not here")


def diagnosed(case: str) -> tuple[dict[str, Any], rga.Findings]:
    folder = CASES / case
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    findings = rga.diagnose(model, record)
    check_invariants(findings)
    return truth, findings


@pytest.mark.parametrize("case", ["01", "02"])
def test_nothing_hidden_nothing_named(case: str) -> None:
    truth, findings = diagnosed(case)
    assert truth["kind"] == "null"
    stiff = ["joint_rigidity"] if truth["reality"] == "frame" else []
    assert [c.effect["kind"] for c in findings.causes if c.effect["kind"] not in stiff] == []


@pytest.mark.parametrize(
    "case", ["03", *(pytest.param(case, marks=pytest.mark.thorough) for case in ("04", "05")), "06"]
)
def test_the_hidden_effect_is_named(case: str) -> None:
    truth, findings = diagnosed(case)
    (cause,) = findings.causes
    assert cause.effect["kind"] == truth["kind"]
    assert {name: cause.effect[name] for name in truth["place"]} == truth["place"]
    assert cause.onset == truth["onset"]
    (estimate,) = (v for v in cause.effect.values() if isinstance(v, dict) and "ci90" in v)
    low, high = estimate["ci90"]
    width = high - low
    # Twice the 90 % interval: it must hold nine times in ten, and these are four cases.
    assert low - width / 2 <= truth["value"] <= high + width / 2
    assert findings.gap.held_out.gain_ci90[0] > 0


def test_what_no_kind_explains_is_unknown() -> None:
    truth, findings = diagnosed("07")
    assert truth["kind"] == "unknown"
    assert findings.verdict == "unknown"
    assert findings.causes == []
    assert findings.unexplained.share > 0.02
