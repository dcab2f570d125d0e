"""Ways to infer contexts, at every level of integration: every row of the table on every split."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rga.errors import InputError
from rga_bench.contexts.floors import FLOORS
from rga_bench.contexts.result import ContextsResult
from rga_bench.contexts.rows import METHODS, QUICK, applies
from rga_bench.contexts.setting import ContextsSetting, shorter
from rga_bench.contexts.tables.table import page
from rga_bench.contexts.task_run import TaskOutcome, run_task
from rga_bench.experiment import Execution, Experiment
from rga_bench.ledger import outcomes_of
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage


@dataclass(frozen=True)
class ContextsExperiment(Experiment[ContextsResult]):
    """Ways to infer contexts.

    Attributes:
        setting: how much is run.
    """

    #: levels of integration
    name = "loi"

    setting: ContextsSetting
    options: str = ""

    @classmethod
    def of(cls, seed: int, *, quick: bool, splits: int) -> Self:
        """That of a command line."""
        usual = ContextsSetting(seed=seed, splits=splits)
        setting = shorter(seed, (*FLOORS, *QUICK)) if quick else usual
        options = "" if quick or splits == ContextsSetting.splits else f" --splits {splits}"
        return cls(setting, options)

    def measure(self, execution: Execution) -> ContextsResult:
        """Outcomes in the order of the tasks.

        Raises:
            InputError: as of every experiment; or there is no such row, drift or manner.
        """
        wanted = (*FLOORS, *METHODS) if self.setting.rows is None else self.setting.rows
        for name in wanted:
            if name not in METHODS and name not in FLOORS:
                known = ", ".join((*FLOORS, *METHODS))
                raise InputError(f"there is no row {name!r}", "rows", f"give some of {known}")
        absent = {
            name: missing
            for name in wanted
            if name in METHODS and (missing := METHODS[name].missing)
        }
        rows = tuple(name for name in wanted if name not in absent)
        tasks = [task for task in self.setting.tasks(rows) if applies(task)]
        outcomes = outcomes_of(run_task, tasks, TaskOutcome, execution)
        return ContextsResult(machine(), versions(), self.setting, rows, absent, outcomes)

    def page(self, result: ContextsResult, command: str) -> MarkdownPage:
        """All tables."""
        return page(result, command)

    def write_figures(self, result: ContextsResult, folder: Path) -> None:
        """Write `methods.png`, and `levels.png` where there were drifts."""
        from rga_bench.contexts.tables.plot import plot

        plot(result, folder)

    def content(self, result: ContextsResult, command: str) -> dict[str, Any]:
        """All of the result."""
        return {"command": command, **asdict(result)}
