"""What the machine can do at most, measured in the same run."""

from dataclasses import dataclass

import numpy as np

from rga_bench.solver.setting import SolverSetting
from rga_bench.timing import shortest

SIZES = (512, 768, 1024, 1536)
#: of the arrays that bandwidth is measured with: beyond the caches
BYTES = 2**27


@dataclass(frozen=True)
class Roofs:
    """Of one core.

    Attributes:
        arithmetic: of a product of matrices [floating-point operations/s].
        copied: bytes read and written by a copy [1/s].
        read: bytes read by a scalar product [1/s].
    """

    arithmetic: float
    copied: float
    read: float


def measure_roofs(setting: SolverSetting) -> Roofs:
    """The best that NumPy reaches."""
    source = np.ones(BYTES // 8)
    target = np.empty_like(source)
    copied, read = shortest(
        [lambda: np.copyto(target, source), lambda: source @ source], setting.seconds
    )
    return Roofs(
        max(product_rate(size, setting) for size in SIZES), 2 * BYTES / copied, BYTES / read
    )


def product_rate(size: int, setting: SolverSetting) -> float:
    """Floating-point operations of a product of square matrices [1/s]."""
    one, other = setting.draw(size, size), setting.draw(size, size)
    result = np.empty_like(one)
    taken = shortest([lambda: np.matmul(one, other, out=result)], setting.seconds / len(SIZES))
    return 2 * size**3 / taken[0]
