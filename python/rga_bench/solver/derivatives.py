"""Derivatives of the response, over the time of the response itself."""

from functools import partial

import numpy as np

from rga._core import Condensation
from rga.arrays import FloatArray
from rga.simulation.paths.factorisation import Factorisation
from rga_bench.measurement import Measurement
from rga_bench.solver.agreement import agree
from rga_bench.solver.box_bridge import box_bridge
from rga_bench.solver.roofs import Roofs
from rga_bench.solver.setting import SolverSetting
from rga_bench.timing import shortest

#: sensors and contexts of the Jacobian
SENSORS, DIRECTIONS = 84, 8
#: rows that are checked before anything is timed
CHECKED = 16
#: of differences, relative to the steps of contexts
DIFFERENCED = 1e-7


def derivatives(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """84 sensors by 8 contexts: loads in six of them, and ten stiffnesses in two."""
    bridge = box_bridge(setting.seed, sensors=SENSORS)
    arrays = bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    few = Condensation(*arrays)
    every = Factorisation(*arrays, few.stiffness)
    rows = min(setting.rows, 4096)
    q = setting.draw(rows, len(bridge.loads["forces"]))
    stiffness = (1.0 + 0.5 * setting.draw(rows, len(few.stiffness))) * few.stiffness
    rates = np.zeros((rows, q.shape[1], DIRECTIONS))
    of_terms = np.zeros((rows, len(few.stiffness), DIRECTIONS))
    for direction in range(6):
        rates[:, 2 * direction : 2 * direction + 2, direction] = 1.0
    members = len(bridge.members)
    of_terms[:, :members, 6] = few.stiffness[:members]
    of_terms[:, members:, 7] = few.stiffness[members:]
    figures = []
    for case, path, size in (("C2", few, rows), ("C3", every, 256)):
        given = q[:size], stiffness[:size]
        along = rates[:size], of_terms[:size]
        gradients = setting.draw(size, SENSORS)
        _check(path, *(one[:CHECKED] for one in (*given, *along, gradients)))
        sample, whole, back = shortest(
            [
                partial(path.respond, *given),
                partial(path.differentiate, *given, *along),
                partial(path.pull_back, *given, gradients),
            ],
            2 * setting.seconds,
        )
        for name, taken in (
            (f"Jacobian of {SENSORS} sensors by {DIRECTIONS} contexts", whole),
            ("gradient by all loads and stiffnesses, the adjoint", back),
        ):
            figures.append(Measurement("derivatives", f"{case}, {name}", taken / sample, "samples"))
    return figures


def _check(
    path: Condensation | Factorisation,
    q: FloatArray,
    stiffness: FloatArray,
    rates: FloatArray,
    of_terms: FloatArray,
    gradients: FloatArray,
) -> None:
    """The derivatives against differences, and the adjoint against the derivatives."""
    found = path.differentiate(q, stiffness, rates, of_terms)

    def moved(step: float) -> FloatArray:
        along = [
            (np.ascontiguousarray(q + step * rates[:, :, k]), stiffness + step * of_terms[:, :, k])
            for k in range(DIRECTIONS)
        ]
        return np.stack([path.respond(*given) for given in along], axis=2)

    agree("the Jacobian", found, (moved(1e-4) - moved(-1e-4)) / 2e-4, DIFFERENCED)
    pulled = path.pull_back(q, stiffness, gradients)
    back = np.einsum("tp,tpc->tc", pulled, np.concatenate([rates, of_terms], axis=1))
    agree("the adjoint", back, np.einsum("ts,tsc->tc", gradients, found))
