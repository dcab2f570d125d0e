"""Play in many members of a bridge at once."""

import numpy as np

import rga
from rga.model import read_effect, read_model
from rga_bench.diagnosis.design import Draw


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
