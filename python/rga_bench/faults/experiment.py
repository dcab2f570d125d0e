"""What a diagnosis makes of records in which channels are broken: every trial diagnosed once."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rga.cli.output import write_json
from rga_bench.experiment import Execution, Experiment
from rga_bench.faults.base import foreign
from rga_bench.faults.comparison import comparisons
from rga_bench.faults.judge import FaultOutcome, judge
from rga_bench.faults.result import FaultsResult
from rga_bench.faults.table import page
from rga_bench.faults.trial import QUICK, QUICK_ROWS, ROWS, FaultTrial, trials
from rga_bench.ledger import outcomes_of, task_versions
from rga_bench.machine import machine
from rga_bench.page import MarkdownPage


@dataclass(frozen=True)
class FaultsExperiment(Experiment[FaultsResult]):
    """What a diagnosis makes of broken channels.

    Attributes:
        trials: the tasks, in the order in which they are begun.
    """

    name = "faults"

    trials: Sequence[FaultTrial]
    options: str = ""

    @classmethod
    def of(cls, seed: int, *, quick: bool, draws: int, data: Path | None, crossing: Path) -> Self:
        """That of a command line (InputError)."""
        rows = QUICK_ROWS if quick else ROWS
        model = crossing if crossing.is_file() else None
        given = [] if data is None else foreign(data, model, rows)
        options = "" if quick else f" --draws {draws}"
        options += "" if data is None else " --data DIR"
        return cls(trials(seed, QUICK if quick else draws, rows, given), options)

    def measure(self, execution: Execution) -> FaultsResult:
        """Outcomes in the order of the trials."""
        outcomes = outcomes_of(judge, self.trials, FaultOutcome, execution)
        return FaultsResult(machine(), task_versions(judge), outcomes)

    def page(self, result: FaultsResult, command: str) -> MarkdownPage:
        """Tables, and every record that was not reported right."""
        return page(result, command)

    def write_figures(self, result: FaultsResult, folder: Path) -> None:
        """Write `faults.json`, from which the tables can be made again."""
        write_json(_found(result), str(folder / "faults.json"))

    def content(self, result: FaultsResult, command: str) -> dict[str, Any]:
        """Outcomes and comparisons."""
        return {"command": command, **_found(result)}


def _found(result: FaultsResult) -> dict[str, Any]:
    compared = [asdict(one) for one in comparisons(result.outcomes)]
    return {**asdict(result), "comparisons": compared}
