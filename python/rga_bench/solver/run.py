"""All measurements in one run."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import date
from functools import partial
from typing import Any

from threadpoolctl import threadpool_limits

from rga_bench.machine import machine, versions
from rga_bench.measurement import Measurement
from rga_bench.solver import condensed, cores, derivatives, end_to_end, large, refactored
from rga_bench.solver.roofs import Roofs, measure_roofs
from rga_bench.solver.setting import SolverSetting

Part = Callable[[SolverSetting, Roofs], list[Measurement]]


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


def measure(
    setting: SolverSetting, progress: Callable[[float], None] | None = None
) -> SolverResult:
    """All figures, on one core unless they say otherwise, after all solvers agree.

    CHOLMOD keeps to one thread only where OMP_THREAD_LIMIT is 1 before OpenMP is loaded, as the
    command sees to.

    Args:
        setting: how much is measured.
        progress: told the share that is done.

    Raises:
        ArithmeticError: two solvers disagree.
    """
    parts: list[Part] = [
        condensed.loads_vary,
        condensed.few_stiffnesses_vary,
        refactored.one_span,
        refactored.ten_spans,
        cores.two_cores,
        *(partial(large.grid, panels) for panels in setting.panels),
        derivatives.derivatives,
        end_to_end.large_displacements,
        end_to_end.whole_model,
        end_to_end.data_set,
    ]
    figures: list[Measurement] = []
    with threadpool_limits(1):
        roofs = measure_roofs(setting)
        for number, part in enumerate(parts, start=1):
            figures += part(setting, roofs)
            if progress is not None:
                progress(number / len(parts))
    if not setting.judged:
        figures = [replace(figure, least=None) for figure in figures]
    day = date.today().isoformat()
    return SolverResult(machine(), versions(), day, setting.seed, roofs, figures)
