"""What a simulated sample costs, beside other solvers on the same structures."""

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from datetime import date
from functools import partial
from pathlib import Path
from typing import Any, Self

from threadpoolctl import threadpool_limits

from rga_bench.experiment import Execution, Experiment
from rga_bench.machine import machine, versions
from rga_bench.measurement import Measurement
from rga_bench.page import MarkdownPage
from rga_bench.solver import condensed, cores, derivatives, end_to_end, large, refactored
from rga_bench.solver.result import SolverResult
from rga_bench.solver.roofs import Roofs, measure_roofs
from rga_bench.solver.setting import SolverSetting, shorter
from rga_bench.solver.table import page

Part = Callable[[SolverSetting, Roofs], list[Measurement]]


@dataclass(frozen=True)
class SolverExperiment(Experiment[SolverResult]):
    """What a simulated sample costs.

    Attributes:
        setting: how much is measured.
    """

    name = "solver"

    setting: SolverSetting

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(shorter(seed) if quick else SolverSetting(seed=seed))

    def parts(self) -> list[Part]:
        """The tasks; each is timed, so that they run one after the other in this process."""
        return [
            condensed.loads_vary,
            condensed.few_stiffnesses_vary,
            refactored.one_span,
            refactored.ten_spans,
            cores.two_cores,
            *(partial(large.grid, panels) for panels in self.setting.panels),
            derivatives.derivatives,
            end_to_end.large_displacements,
            end_to_end.whole_model,
            end_to_end.data_set,
        ]

    def measure(self, execution: Execution) -> SolverResult:
        """All figures, on one core unless they say otherwise, after all solvers agree.

        CHOLMOD keeps to one thread only where OMP_THREAD_LIMIT is 1 before OpenMP is loaded, as
        the command sees to.

        Raises:
            ArithmeticError: two solvers disagree.
        """
        parts = self.parts()
        figures: list[Measurement] = []
        with threadpool_limits(1):
            roofs = measure_roofs(self.setting)
            for number, part in enumerate(parts, start=1):
                figures += part(self.setting, roofs)
                execution.progress(number / len(parts))
        if not self.setting.judged:
            figures = [replace(figure, least=None) for figure in figures]
        day = date.today().isoformat()
        return SolverResult(machine(), versions(), day, self.setting.seed, roofs, figures)

    def page(self, result: SolverResult, command: str) -> MarkdownPage:
        """The table."""
        return page(result, command)

    def write_figures(self, result: SolverResult, folder: Path) -> None:
        """Write `solver.png`."""
        from rga_bench.solver.plot import plot

        plot(result, folder / "solver.png")

    def content(self, result: SolverResult, command: str) -> dict[str, Any]:
        """All of the result."""
        return {"command": command, **asdict(result)}
