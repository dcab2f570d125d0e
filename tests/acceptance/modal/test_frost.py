"""Frost beside a change: a bend in what the weather does is no cause, and hides none."""

from pathlib import Path

import numpy as np
import pytest

from rga.diagnosis import diagnose_modes
from rga.diagnosis.modal.likelihood import bent_lines
from rga_bench.diagnosis.hidden import Truth
from rga_bench.swinging import Campaign, draw_modal


@pytest.mark.parametrize("frozen", [-4.0, 0.0, 3.0, 11.0])
def test_a_line_may_bend_anywhere(frozen: float) -> None:
    air = 4.0 + 9.0 * np.sin(np.linspace(0.0, 25.0, 200))
    course = np.minimum(air - frozen, 0.0)
    columns = np.column_stack([np.ones(200), bent_lines({"air": air}, 200).T])
    left = course - columns @ np.linalg.lstsq(columns, course, rcond=None)[0]
    assert np.abs(left).max() < 0.02 * np.ptp(air)


@pytest.mark.thorough
@pytest.mark.parametrize("hidden", [True, False])
def test_a_weak_member_beside_frost_is_among_what_is_named(hidden: bool, tmp_path: Path) -> None:
    case = draw_modal(
        5, structure="jib", kind="member_stiffness" if hidden else "null", welded=False,
        campaign=Campaign(windows=48, weather=True), beside=False, aims=(25.0, 45.0),
    )  # fmt: skip
    case.write(tmp_path)
    findings = diagnose_modes(tmp_path / "model.json", tmp_path / "modes.csv")
    if not hidden:
        assert not findings.causes
        return
    (truth,) = Truth.of(case)
    several = [one for cause in findings.causes for one in (cause.effect, *cause.rivals)]
    assert any(truth.is_at(one) for one in several)
