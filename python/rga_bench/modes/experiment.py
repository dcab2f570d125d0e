"""What natural frequencies cost, beside other solvers on the same structures."""

from dataclasses import asdict, dataclass, replace
from datetime import date
from itertools import groupby
from pathlib import Path
from typing import Any, Self

from threadpoolctl import threadpool_limits

from rga_bench.experiment import Execution, Experiment
from rga_bench.machine import machine, versions
from rga_bench.measurement import HEADINGS, Measurement
from rga_bench.modes.diagnosis import diagnosis
from rga_bench.modes.figures import all_vary, few_vary, grid
from rga_bench.modes.setting import ModesSetting, shorter
from rga_bench.page import MarkdownPage
from rga_bench.text_table import TextTable

NOTES = """\
Times as good: of rates, ours over theirs; of times, theirs over ours. Every sample of ours is
proved to a part in 1e9 and checked by a count (Sylvester's law of inertia): no mode is missed; no
peer does that. ARPACK is asked for the same part in 1e9. CHOLMOD keeps its analysis, and fills its
matrix by a product with a constant one; the mode and ordering that are fastest of all are taken. On
the grid each begins from scratch, and CHOLMOD is handed the matrix. Nobody else names causes from
modes and gauges together: a diagnosis is held against the time that is asked for."""


@dataclass(frozen=True)
class ModesResult:
    """What was measured, where and when.

    Attributes:
        machine: processor, instruction sets, cores, memory.
        versions: of packages and libraries; None for what is not installed.
        day: ISO 8601.
        seed: of structures and samples.
        figures: in order.
    """

    machine: dict[str, Any]
    versions: dict[str, str | None]
    day: str
    seed: int
    figures: list[Measurement]


@dataclass(frozen=True)
class ModesExperiment(Experiment[ModesResult]):
    """What natural frequencies cost.

    Attributes:
        setting: how much is measured.
    """

    name = "modes"

    setting: ModesSetting

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(shorter(seed) if quick else ModesSetting(seed=seed))

    def measure(self, execution: Execution) -> ModesResult:
        """All figures on one core, after all solvers agree.

        Raises:
            ArithmeticError: two solvers disagree.
        """
        parts = (all_vary, few_vary, grid, diagnosis)
        figures: list[Measurement] = []
        with threadpool_limits(1):
            for number, part in enumerate(parts, start=1):
                figures += part(self.setting)
                execution.progress(number / len(parts))
        if not self.setting.judged:
            figures = [replace(figure, least=None) for figure in figures]
        day = date.today().isoformat()
        return ModesResult(machine(), versions(), day, self.setting.seed, figures)

    def page(self, result: ModesResult, command: str) -> MarkdownPage:
        """The table."""
        own, known = result.machine, result.versions
        rows = []
        for case, figures in groupby(result.figures, lambda one: one.case):
            rows.append([case])
            rows += [figure.cells() for figure in figures]
        return MarkdownPage(
            "modes.md",
            "What natural frequencies cost",
            f"`{command}` on {result.day}, on one core, after all solvers agreed.",
            [
                f"{own['processor']} with {', '.join(own['instructions'])}",
                f"{own['cores']} cores, {own['memory_GiB']} GiB, {own['system']}",
                ", ".join(f"{name} {number or 'not installed'}" for name, number in known.items()),
                f"seed {result.seed}",
            ],
            [TextTable("", HEADINGS, rows), NOTES],
        )

    def write_figures(self, result: ModesResult, folder: Path) -> None:
        """There are none."""

    def content(self, result: ModesResult, command: str) -> dict[str, Any]:
        """All of the result."""
        return {"command": command, **asdict(result)}
