"""What a diagnosis costs: `pytest benches/test_diagnosis.py` (needs pytest-benchmark).

The bridge of the case study with 84 sensors, 300 rows and some 1 050 hypotheses, on one core. Every
stiffness is a little off as built, and the contexts are measured. `rga benchmark diagnosis-speed`
has other sizes, and the shares of the stages.
"""

from typing import Any

import pytest

import rga
from rga_bench.speed.sized_case import EFFECTS, Hidden, SizedCase

SENSORS, ROWS, PANELS = 84, 300, 10


@pytest.mark.parametrize("hidden", ["nothing", *EFFECTS])
def test_diagnosis(benchmark: Any, hidden: Hidden) -> None:
    model, record = SizedCase(ROWS, SENSORS, PANELS, hidden, seed=1).draw()
    findings = benchmark.pedantic(rga.diagnose, (model, record), rounds=1)
    kinds = [cause.effect["kind"] for cause in findings.causes]
    assert kinds == ([EFFECTS[hidden]["kind"]] if hidden in EFFECTS else [])
