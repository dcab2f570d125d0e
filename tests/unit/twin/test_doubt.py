"""While the twin is in doubt, and where a record is of another structure."""

from typing import Any

import numpy as np
import pytest

from crossed_truss import crossed_truss
from made_findings import cause, findings
from rga.errors import InputError
from rga.findings import Findings
from rga.records import Record
from rga.twin.changes import in_doubt
from rga.twin.hardware.recorded import Recorded

DAMAGE = {"kind": "section_loss", "group": "bottom", "loss": 0.2}


def told(verdict: str, *causes: dict[str, Any]) -> Findings:
    return findings(*causes).model_copy(update={"verdict": verdict})


def test_a_doubt_is_never_calmed() -> None:
    calm = in_doubt(told("nothing_wrong"))
    assert calm.verdict == "unknown"
    assert "in doubt" in calm.unexplained.looks_like
    assert "in doubt" in calm.warnings[-1]


@pytest.mark.parametrize("verdict", ["unknown", "partial"])
def test_what_calms_nobody_keeps_its_verdict(verdict: str) -> None:
    found = in_doubt(told(verdict, cause(DAMAGE)))
    assert found.verdict == verdict
    assert found.unexplained.looks_like == ""
    assert "in doubt" in found.warnings[-1]


def record(*sensors: str) -> Record:
    model = crossed_truss(both_ways=False)
    time = np.arange(4.0)
    measured = {name: np.zeros(4) for name in model.context}
    readings = np.zeros((4, len(sensors)))
    return Record(time, 0.0, "seconds", sensors, readings, measured)


@pytest.mark.parametrize("sensors", [(), ("of another bridge",)])
def test_a_record_of_another_structure_is_refused(sensors: tuple[str, ...]) -> None:
    with pytest.raises(InputError, match=r"no sensor"):
        Recorded(record(*sensors), crossed_truss(both_ways=False))
