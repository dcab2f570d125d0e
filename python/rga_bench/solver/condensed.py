"""C1 and C2: a fixed structure, or one of which few stiffnesses vary."""

import numpy as np

from rga import _core
from rga._core import Condensation
from rga.arrays import FloatArray
from rga_bench.measurement import Measurement
from rga_bench.solver.agreement import agree
from rga_bench.solver.box_bridge import box_bridge
from rga_bench.solver.from_scratch import FromScratch, whole_factors
from rga_bench.solver.roofs import Roofs
from rga_bench.solver.setting import SolverSetting
from rga_bench.timing import shortest

#: rows that suit NumPy's batches of small solves best: temporary arrays stay in the cache
PART = 4096


def loads_vary(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """C1 beside NumPy's product of matrices, both into memory that is there."""
    bridge, nothing = box_bridge(setting.seed), np.zeros(0, np.int64)
    ours = Condensation(bridge.structure, bridge.loads, bridge.outputs, nothing, nothing)
    matrix = _core.respond(bridge.structure, bridge.loads, bridge.outputs)
    rows = setting.rows
    q, still = setting.draw(rows, len(matrix)), np.zeros((rows, 0))
    found, product = np.empty((rows, matrix.shape[1])), np.empty((rows, matrix.shape[1]))
    agree("C1", ours.respond(q, still), q @ matrix)
    own, peer = shortest(
        [lambda: ours.respond(q, still, 1, found), lambda: np.matmul(q, matrix, out=product)],
        setting.seconds,
    )
    case, share = "C1, loads vary", 8 * sum(matrix.shape) * rows / own / roofs.copied
    return [
        Measurement(case, "samples", rows / own, "/s").beside("NumPy GEMM", rows / peer),
        Measurement(case, "share of the bandwidth of a copy", share),
    ]


def few_stiffnesses_vary(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """C2 beside Woodbury's identity in NumPy; and one sample alone."""
    bridge = box_bridge(setting.seed)
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    rows, part, few = setting.rows, min(setting.rows, PART), 64
    q = setting.draw(rows, len(bridge.loads["forces"]))
    factors = 1.0 + 0.5 * setting.draw(rows, len(ours.stiffness))
    stiffness = factors * ours.stiffness
    plain = FromScratch(bridge).respond(whole_factors(bridge, factors[:few]), q[:few])
    agree("C2", ours.respond(q[:few], stiffness[:few]), plain)
    agree("NumPy Woodbury", woodbury(ours, q[:few], stiffness[:few]), plain)
    found = np.empty((rows, plain.shape[1]))
    own, peer, some, alone = shortest(
        [
            lambda: ours.respond(q, stiffness, 1, found),
            lambda: woodbury(ours, q[:part], stiffness[:part]),
            lambda: ours.respond(q[:1024], stiffness[:1024]),
            lambda: ours.respond(q[:1], stiffness[:1]),
        ],
        setting.seconds,
    )
    case = f"C2, {len(ours.stiffness)} stiffnesses vary"
    return [
        Measurement(case, "samples", rows / own, "/s").beside("NumPy Woodbury", part / peer),
        Measurement(case, "one sample from Python, over the time inside", alone - some / 1024, "s"),
    ]


def woodbury(ours: Condensation, q: FloatArray, stiffness: FloatArray) -> FloatArray:
    """The condensation in NumPy, as one would write it: a batch of small solves."""
    change = stiffness - ours.stiffness
    matrix = np.eye(len(ours.unit)) + ours.unit * change[:, None, :]
    stretch = np.linalg.solve(matrix, (q @ ours.stretched)[:, :, None])[:, :, 0]
    return np.asarray(q @ ours.loaded - (change * stretch) @ ours.influence)
