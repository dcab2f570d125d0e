"""What a second core adds, beside what it adds to a product of matrices."""

import os
from functools import partial

import numpy as np
from threadpoolctl import threadpool_limits

from rga import _core
from rga_bench.measurement import Measurement
from rga_bench.solver.box_bridge import box_bridge, samples
from rga_bench.solver.roofs import Roofs
from rga_bench.solver.setting import SolverSetting
from rga_bench.timing import shortest

#: of the product
SIZE = 1536
LEAST = 0.9


def two_cores(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """C3 on two cores over one; nothing on a machine that has one."""
    if (os.cpu_count() or 1) < 2:
        return []
    bridge = box_bridge(setting.seed)
    solver = _core.Refactored(bridge.structure, bridge.loads, bridge.outputs)
    factors, q = samples(bridge, setting.rows // 16, setting.seed)
    one, other = setting.draw(SIZE, SIZE), setting.draw(SIZE, SIZE)
    product = np.empty_like(one)

    def multiply(threads: int) -> None:
        with threadpool_limits(threads):
            np.matmul(one, other, out=product)

    if not (solver.respond(factors, q, 2) == solver.respond(factors, q, 1)).all():
        raise ArithmeticError("C3 has other bits on two cores than on one")
    alone, ours, product_alone, theirs = shortest(
        [
            *(partial(solver.respond, factors, q, threads) for threads in (1, 2)),
            *(partial(multiply, threads) for threads in (1, 2)),
        ],
        4 * setting.seconds,
    )
    figure = Measurement("two cores over one", "C3", alone / ours, "times")
    return [figure.beside("NumPy GEMM", product_alone / theirs, LEAST)]
