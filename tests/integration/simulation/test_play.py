"""Play in many members of a bridge at once."""

from typing import Any

import numpy as np
import pytest

import rga
from rga.model import read_effect, read_model
from rga_bench.diagnosis.design import Draw
from rga_bench.synthetic import draw_case


def test_play_in_all_diagonals_of_a_bridge_under_little_load() -> None:
    """Newton's method alone goes round in circles here."""
    case = Draw.parse("41-single-48").case()
    given = read_model(case.model, "bridge")
    place = {"kind": "joint_slip", "group": "diagonals", "slip": 1.35561e-5}
    bridge = given.extended({"slips": read_effect(place, "slips")})
    rng = np.random.default_rng(0)
    for _ in range(4):
        contexts = {"time": case.time}
        for name, variable in bridge.context.items():
            step = 1e-3 * (variable.range[1] - variable.range[0])
            contexts[name] = case.channels[name] + step * rng.normal(size=len(case.time))
        shown = rga.Simulator(bridge).predict(contexts)
        # Play takes up at most so much beside the forces that the loads ask for.
        tight = rga.Simulator(given).predict(contexts)
        assert 0 < np.abs(shown - tight).max() < 2.0


GAP = {"kind": "support_gap", "support": "B1", "dof": "ux", "gap": 4e-4, "stiffness": 4e7}
SLIP = {"kind": "joint_slip", "group": "diagonal", "slip": 3e-4}
STIFF = {"kind": "joint_rigidity", "group": ["diagonal"], "stiffness": 7e7}
ZONE = {"kind": "rigid_end_zone", "group": "diagonal", "length": 0.5}
SLACK = {"kind": "tension_only", "member": "3at-4a", "slack": 0.0}


@pytest.mark.parametrize(
    "places",
    [
        [GAP],
        [SLIP],
        [GAP, SLIP],
        [{**GAP, "profile": "step"}, SLIP],
        [GAP, SLACK],
        [STIFF, ZONE, SLIP],
    ],
)
def test_play_that_grows_is_that_of_each_row(places: list[dict[str, Any]]) -> None:
    """Rows whose laws differ are solved together; a few of them are solved one by one."""
    case = draw_case(5, bridge="pratt", kind="null", rows=80)
    growing = {"onset": 15.0, "profile": "ramp", "end": 70.0}
    effects = {
        str(k): read_effect(
            {**growing, **place} if place not in (SLACK, STIFF, ZONE) else place, str(k)
        )
        for k, place in enumerate(places)
    }
    given = read_model(case.model, "case")
    simulator = rga.Simulator(given.extended(effects))
    contexts = {name: np.nan_to_num(case.channels[name]) for name in given.context}
    contexts["time"] = np.arange(80.0)
    together = simulator.predict(contexts)
    alone = [
        simulator.predict({name: column[k : k + 2] for name, column in contexts.items()})
        for k in range(0, 80, 2)
    ]
    anew = np.concatenate(alone)
    assert np.abs(together - anew).max() <= 1e-9 * np.abs(anew).max()
    tight = rga.Simulator(given).predict(contexts)
    assert np.abs(together - tight).max() > 1e-3 * np.abs(tight).max()


MOVES = {"kind": "support_gap", "dof": "ux", "gap": 1e-4, "stiffness": {"context": "one"}}


def test_stops_at_two_places_are_two_stops() -> None:
    """One stop acts while the other does not: their springs have the same number."""
    case = draw_case(5, bridge="pratt", kind="null", rows=40)
    content = dict(case.model)
    ranges = {"unit": "N/m", "range": [0.0, 9e7]}
    content["context"] = {**content["context"], "one": ranges, "other": ranges}
    stops = {
        "B1": {**MOVES, "support": "B1"},
        "B2": {**MOVES, "support": "B2", "stiffness": {"context": "other"}},
    }
    given = read_model(content, "case")
    simulator = rga.Simulator(given.extended({k: read_effect(v, k) for k, v in stops.items()}))
    turn = np.arange(40) % 2
    contexts = {name: np.nan_to_num(case.channels.get(name, 0.0)) for name in case.model["context"]}
    contexts |= {
        "one": 1e6 * np.arange(40, 80) * turn,
        "other": 1e6 * np.arange(40, 80) * (1 - turn),
    }
    contexts["time"] = np.arange(40.0)
    together = simulator.predict(contexts)
    alone = [
        simulator.predict({name: column[k : k + 1] for name, column in contexts.items()})
        for k in range(40)
    ]
    anew = np.concatenate(alone)
    assert np.abs(together - anew).max() <= 1e-9 * np.abs(anew).max()
