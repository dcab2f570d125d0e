"""The drawn footbridge of the examples: what is hidden in it is found, in its null twin nothing."""

from pathlib import Path

import numpy as np
import pytest

import rga
from findings_invariants import check_invariants
from rga.model import model_content
from rga_bench.synthetic import Case, Conditions, draw_case

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "examples" / "footbridge"


def drawn(kind: str) -> Case:
    """The sample, or its null twin, as it was drawn."""
    return draw_case(
        7,
        bridge="footbridge",
        kind=kind,
        reality="truss",
        rows=160,
        conditions=Conditions(scatter=0.01),
        aims=(25.0, 40.0),
    )


def findings_of(folder: Path) -> rga.Findings:
    model = rga.load_model(folder / "model.json")
    findings = rga.diagnose(model, rga.load_record(folder / "record.csv", model))
    check_invariants(findings)
    return findings


def test_the_readme_shows_the_figure_of_its_cause() -> None:
    (cause,) = findings_of(SAMPLE).causes
    assert cause.effect["kind"] == "support_settlement"
    low = cause.effect["displacement"]["value"]
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"an abutment has settled by {-1e3 * low:.1f} mm" in readme


def test_what_is_hidden_in_it_is_reported(tmp_path: Path) -> None:
    case = drawn("support_settlement")
    case.write(tmp_path)
    model = rga.load_model(SAMPLE / "model.json")
    assert model_content(rga.load_model(tmp_path / "model.json")) == model_content(model)
    shipped, again = (rga.load_record(f / "record.csv", model) for f in (SAMPLE, tmp_path))
    np.testing.assert_allclose(again.readings, shipped.readings, rtol=1e-9)
    assert case.truth["value"] == pytest.approx(-0.00059, abs=0.000005)
    assert case.truth["onset"] == pytest.approx(145800.0)


def test_its_null_twin_has_nothing_wrong(tmp_path: Path) -> None:
    drawn("null").write(tmp_path)
    findings = findings_of(tmp_path)
    assert findings.verdict == "nothing_wrong"
    assert findings.causes == []
