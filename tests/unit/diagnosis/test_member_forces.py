"""Forces of members with and without causes, by the method of joints."""

from typing import Any

import numpy as np
import pytest

from rga.diagnosis.member_forces import Forces, member_forces
from rga.findings.arrays import DiagnosisArrays
from rga.model import Model, read_effect
from rga.records import Record
from rga.report.figures.member_forces import force_table
from rga.simulation import Simulator

ROWS = 6


def forces(
    model: Model, gauge: float = 1.0, *, falling: bool = False, **causes: dict[str, Any]
) -> Forces | None:
    """Of the small bridge under a growing load on its western half, gauges reading so much."""
    effects = {name: read_effect(one, "test") for name, one in causes.items()}
    extended = model.extended(effects)
    load = 10.0 * np.arange(1, ROWS + 1)
    contexts = {
        "time": 600.0 * np.arange(ROWS),
        "temperature": np.full(ROWS, 10.0),
        "west load": load[::-1] if falling else load,
        "east load": np.zeros(ROWS),
    }
    before, after = (Simulator(one).predict(contexts) for one in (model, extended))
    record = Record(contexts["time"], 0.0, "seconds", tuple(model.sensors), gauge * after, {})
    sensors = len(model.sensors)
    arrays = DiagnosisArrays(
        model, extended, record, np.zeros(ROWS, dtype=bool), np.zeros(sensors, dtype=bool),
        before, after, np.full(sensors, 1e-6), np.ones_like(after), contexts,
    )  # fmt: skip
    return member_forces(arrays)


TWICE = {"kind": "load_scale", "effect": "west", "factor": 2.0}
SPRING = {"kind": "support_spring", "support": "east", "dof": "ux", "stiffness": 1e9}


def test_twice_the_load_is_twice_the_force(model: Model) -> None:
    found = forces(model, heavier=TWICE)
    assert found is not None
    carrying = found.amplitude > 0.01 * found.amplitude.max()
    np.testing.assert_allclose(found.ratio[carrying], 2.0)
    assert found.row == ROWS - 1
    np.testing.assert_allclose(found.extended, 2 * found.given, atol=1e-6)
    # Method of joints at the western support: the diagonal takes V / sin 45 in compression.
    reaction = 60.0 * (1000 * 3 / 4 + 500 / 2)
    diagonal = found.members.index("L0-U1")
    assert found.given[diagonal] == pytest.approx(-reaction * np.sqrt(2))
    assert found.credited is None
    assert found.without == {}


def test_only_rows_in_which_a_cause_acts_count(model: Model) -> None:
    """The load falls, so that the heaviest row of all lies before the cause begins."""
    late = {**TWICE, "onset": 1800.0}
    found = forces(model, falling=True, heavier=late)
    assert found is not None
    assert found.row == 3
    np.testing.assert_allclose(found.extended, 2 * found.given, atol=1e-6)
    carrying = found.amplitude > 0.01 * found.amplitude.max()
    np.testing.assert_allclose(found.ratio[carrying], 2.0)


def test_gauges_give_the_force_of_their_member(model: Model) -> None:
    found = forces(model, 1.1, heavier=TWICE)
    assert found is not None
    number = found.members.index("L0-L1")
    assert found.measured[number] == pytest.approx(2.2, rel=1e-3)
    assert np.isnan(found.measured[found.members.index("L1-U1")])


def test_the_restraint_of_a_bearing_is_not_credited(model: Model) -> None:
    found = forces(model, heavier=TWICE, held=SPRING)
    assert found is not None
    assert found.credited is not None
    chord = found.members.index("L0-L1")
    assert found.ratio[chord] < 1.9
    assert found.credited[chord] == pytest.approx(2.0)
    assert set(found.without) == {"heavier"}
    assert found.without["heavier"][chord] < 1.0


def test_a_cause_at_a_sensor_changes_no_force(model: Model) -> None:
    assert forces(model, off={"kind": "sensor_bias", "sensor": "D1", "offset": 1.0}) is None


def test_members_that_causes_name_stand_first(model: Model) -> None:
    found = forces(model, loss={"kind": "member_stiffness", "member": "L2-L3", "factor": 0.75})
    assert found is not None
    assert force_table(found, model).lines[0][0] != "L2-L3"
    assert force_table(found, model, {"L2-L3"}).lines[0][0] == "L2-L3"
