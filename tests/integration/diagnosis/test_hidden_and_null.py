"""What is hidden is told as what it is and from when on it acts; its null twin names nothing.

The readings come from physics of their own (rga_bench.synthetic).
"""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest

from rga import Findings
from rga.findings.schema import Cause
from rga_bench.diagnosis.design import Draw
from rga_bench.synthetic import Case, Conditions, draw_case

Diagnosed = Callable[[Case], Findings]


@dataclass(frozen=True)
class Hidden:
    """An effect in a case of the footbridge, or its null twin."""

    seed: int
    kind: str
    rows: int = 100
    aims: tuple[float, float] = (20.0, 40.0)
    null: bool = False

    @property
    def id(self) -> str:
        return f"{self.seed}-{self.kind}"

    def case(self) -> Case:
        return draw_case(
            self.seed,
            bridge="footbridge",
            kind="null" if self.null else self.kind,
            reality="truss",
            rows=self.rows,
            conditions=Conditions(scatter=0.01, ramps=True),
            aims=self.aims,
        )


RAMP = Hidden(10, "support_settlement", rows=160)
JUMP = Hidden(9, "support_settlement", rows=160)
SILENT = Hidden(1, "sensor_fault")
GRADIENT = Hidden(2014, "thermal_gradient")
SOFTENING = Hidden(22, "unknown", rows=160, aims=(100.0, 120.0))
#: from the blind challenge
HEAVIER, FRICTION, THERMOMETER = map(Draw.parse, ("7-single-11", "7-single-8", "7-single-22"))
EVERY = (RAMP, JUMP, SILENT, GRADIENT, SOFTENING, HEAVIER, FRICTION, THERMOMETER)


@pytest.mark.parametrize("hidden", EVERY, ids=lambda one: one.id)
def test_its_null_twin_names_nothing(hidden: Hidden | Draw, diagnosed: Diagnosed) -> None:
    findings = diagnosed(replace(hidden, null=True).case())
    assert findings.causes == []
    assert findings.verdict == "nothing_wrong"


def only_cause(findings: Findings, truth: dict[str, Any]) -> Cause:
    """The one cause, of the kind and at the place that are true."""
    (cause,) = findings.causes
    assert cause.effect["kind"] == truth["kind"]
    assert {name: cause.effect[name] for name in truth["place"]} == truth["place"]
    return cause


def holds(cause: Cause, truth: dict[str, Any]) -> bool:
    """Whether the 90 % interval, made wider by half of it to either side, holds the true value."""
    low, high = cause.effect[truth["parameter"]]["ci90"]
    more = (high - low) / 2
    return bool(low - more < truth["value"] < high + more)


def test_a_ramp_is_reported_as_a_ramp(diagnosed: Diagnosed) -> None:
    case = RAMP.case()
    truth = case.truth
    cause = only_cause(diagnosed(case), truth)
    assert cause.effect["profile"] == "ramp"
    assert holds(cause, truth)
    length = truth["end"] - truth["onset"]
    assert abs(cause.effect["onset"] - truth["onset"]) < length / 4
    assert abs(cause.effect["end"] - truth["end"]) < length / 4


def test_a_jump_is_reported_as_a_jump(diagnosed: Diagnosed) -> None:
    case = JUMP.case()
    truth = case.truth
    assert truth["end"] is None
    cause = only_cause(diagnosed(case), truth)
    assert cause.effect.get("profile", "step") == "step"
    assert holds(cause, truth)
    step = case.time[1] - case.time[0]
    assert abs(cause.effect["onset"] - truth["onset"]) <= 2 * step


def test_a_channel_that_falls_silent_is_reported_with_its_moment(diagnosed: Diagnosed) -> None:
    case = SILENT.case()
    truth = case.truth
    assert case.time[0] < truth["onset"] < case.time[-1]
    cause = only_cause(diagnosed(case), truth)
    assert cause.effect["mode"] == truth["mode"]
    step = case.time[1] - case.time[0]
    assert abs(cause.effect["onset"] - truth["onset"]) <= 2 * step


def test_a_gradient_that_does_not_follow_the_temperature(diagnosed: Diagnosed) -> None:
    case = GRADIENT.case()
    assert case.truth["parameter"] == "difference"
    cause = only_cause(diagnosed(case), case.truth)
    assert holds(cause, case.truth)
    assert "ratio" not in cause.effect


def test_softening_under_load_has_no_name(diagnosed: Diagnosed) -> None:
    case = SOFTENING.case()
    assert case.truth["variant"] == "softening"
    findings = diagnosed(case)
    assert findings.verdict == "unknown"
    assert findings.causes == []
    assert "bends" in findings.unexplained.looks_like


def test_a_load_that_scatter_could_take_up_is_found(diagnosed: Diagnosed) -> None:
    case = HEAVIER.case()
    assert abs(case.truth["value"] - 1) < 0.1
    cause = only_cause(diagnosed(case), case.truth)
    assert cause.log_odds > 30
    assert holds(cause, case.truth)
    assert cause.onset is None


def test_a_bearing_that_sticks_is_found(diagnosed: Diagnosed) -> None:
    case = FRICTION.case()
    cause = only_cause(diagnosed(case), case.truth)
    assert cause.log_odds > 30
    assert holds(cause, case.truth)


def test_what_always_acts_is_not_reported_with_an_onset(diagnosed: Diagnosed) -> None:
    case = THERMOMETER.case()
    assert case.truth["onset"] is None
    cause = only_cause(diagnosed(case), case.truth)
    assert cause.onset is None
    assert holds(cause, case.truth)


PROCESS = """
import sys
from rga import diagnose, load_model, load_record
folder = sys.argv[1]
model = load_model(f"{folder}/model.json")
print(diagnose(model, load_record(f"{folder}/record.csv", model)).to_json())
"""


def test_the_same_record_gives_the_same_bits(diagnosed: Diagnosed, tmp_path: Path) -> None:
    """Twice in this process, and in one of more threads that puts names in another order."""
    case = draw_case(1, bridge="footbridge", kind="load_scale", rows=80)
    case.write(tmp_path)
    first = diagnosed(case).to_json()
    assert json.loads(first)["causes"]
    assert diagnosed(case).to_json() == first
    pools = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "RAYON_NUM_THREADS")
    done = subprocess.run(
        [sys.executable, "-c", PROCESS, str(tmp_path)],
        env={**os.environ, "PYTHONHASHSEED": "1", **dict.fromkeys(pools, "3")},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == first
