"""What a user sees: large displacements, a whole model, a data set."""

import numpy as np

from rga import _core
from rga.model import Model
from rga.simulation import Simulator
from rga_bench.measurement import Measurement
from rga_bench.solver.box_bridge import box_bridge
from rga_bench.solver.data_set import data_set_cost
from rga_bench.solver.roofs import Roofs
from rga_bench.solver.setting import SolverSetting
from rga_bench.synthetic.bridges.case_study import case_study_bridge
from rga_bench.timing import shortest


def large_displacements(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """C4 on the bridge of 84 nodes, under a tenth of its loads."""
    bridge = box_bridge(setting.seed)
    q = 0.1 * setting.draw(64, len(bridge.loads["forces"]))
    arrays = bridge.structure, bridge.loads, bridge.outputs
    (taken,) = shortest([lambda: _core.respond_nonlinear(*arrays, q)], setting.seconds)
    return [Measurement("C4, large displacements", "samples", len(q) / taken, "/s")]


def whole_model(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """The case study through `Simulator.predict`: parameters of all effects, then the response."""
    model = Model.model_validate(case_study_bridge().model)
    simulator, many = Simulator(model), min(setting.rows, 4096)
    ranges = {name: variable.range for name, variable in model.context.items()}
    contexts = {name: np.linspace(low, high, many) for name, (low, high) in ranges.items()}
    one = {name: column[:1] for name, column in contexts.items()}
    alone, together = shortest(
        [lambda: simulator.predict(one), lambda: simulator.predict(contexts)], setting.seconds
    )
    case = "case study through Simulator.predict"
    return [
        Measurement(case, "one row", alone, "s"),
        Measurement(case, f"a row of {many}", together / many, "s"),
    ]


def data_set(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """`rga dataset` in a process of its own."""
    memory, taken = data_set_cost(setting.data_set)
    case = f"data set of {setting.data_set / 1e6:g} million rows"
    return [
        Measurement(case, "memory", memory, "MiB"),
        Measurement(case, "rows written", setting.data_set / taken, "/s"),
    ]
