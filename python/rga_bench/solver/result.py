"""What was measured of solvers."""

from dataclasses import dataclass
from typing import Any

from rga_bench.measurement import Measurement
from rga_bench.solver.roofs import Roofs


@dataclass(frozen=True)
class SolverResult:
    """What was measured, where and when.

    Attributes:
        machine: processor, instruction sets, cores, memory.
        versions: of packages and libraries; None for what is not installed.
        day: ISO 8601.
        seed: of structures, loads and samples.
        roofs: of the machine.
        figures: in order.
    """

    machine: dict[str, Any]
    versions: dict[str, str | None]
    day: str
    seed: int
    roofs: Roofs
    figures: list[Measurement]
