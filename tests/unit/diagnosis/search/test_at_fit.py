"""What a large cause leaves is straight where it is fitted, though the search posed it beside."""

import numpy as np
import pytest

from known_problem import candidate
from rga.building import howe_truss
from rga.diagnosis.preparation.prepare import prepare
from rga.diagnosis.residuals.curvature import curves
from rga.diagnosis.search.laplace import extended, fit
from rga.diagnosis.search.linearised import pose, resimulated
from rga.diagnosis.search.stepwise import Found, settled
from rga.model import read_effect
from rga.records import Record
from rga.simulation import Simulator

ROWS, STEP = 354, 4 * 3600.0
LATE = ROWS // 2 * STEP


def found(beside: float) -> Found:
    """A chord that loses a quarter halfway, fitted where the record is posed so far from it [z]."""
    truss = howe_truss(
        "roof", "17.5 m", "2.1 m", 7, chords="SHS 100x6.3", diagonals="SHS 70x5", material="S275"
    )
    truss.context("snow", "kN/m2", (0, 2.5), noise=0.03)
    down = dict.fromkeys(truss.nodes_in("top chord"), "13 kN")
    truss.load_case("snow load", down=down, context="snow")
    truss.sensors("strain", ["L1-L2", "L2-L3", "L3-L4", "L5-L6", "U2-U3", "U4-U5"], noise=1.0)
    truss.sensors("displacement", ["L2", "L3", "L5"], direction="z", noise="0.05 mm")
    model, draw = truss.build(), np.random.default_rng(1)
    time = STEP * np.arange(ROWS)
    snow = 1.3 + 0.8 * np.sin(time / 3.6e5) + 0.3 * np.sin(time / 6.1e4)
    lost = {"kind": "member_stiffness", "member": "L3-L4", "factor": 0.75, "onset": LATE}
    true = Simulator(model.extended({"lost": read_effect(lost, "lost")}))
    readings = true.predict({"snow": snow, "time": time})
    readings += draw.normal(0.0, [one.noise for one in model.sensors.values()], readings.shape)
    measured = {"snow": snow + draw.normal(0.0, 0.03, ROWS)}
    record = Record(time, 0.0, "seconds", tuple(model.sensors), readings, measured)
    base, data = Simulator(model), prepare(model, record, lambda done: None).data
    start = settled(base, data)
    causes = [candidate(start, "member_stiffness", member="L3-L4").beginning(LATE)]
    z = fit(start, base, causes, [-0.5]).z
    problem = pose(extended(base, causes, z), data, start)
    z = fit(problem, base, causes, z).z
    current = fit(problem, base, causes, z)
    problem = resimulated(problem, extended(base, causes, current.z + beside), data)
    return Found(problem, current, base, ((),), (1e5,))


@pytest.mark.parametrize("beside", [0.0, 0.15])
def test_what_it_leaves_is_looked_at_where_it_is_fitted(beside: float) -> None:
    one = found(beside)
    assert bool(curves(one.problem)) == bool(beside), "posed beside, the record looks curved"
    assert curves(one.at_fit) == []
