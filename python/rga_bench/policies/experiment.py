"""What each policy of synchronisation costs, and what gap it leaves: a twin for every stream."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rga_bench.experiment import Execution, Experiment
from rga_bench.ledger import outcomes_of
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.policies.setting import PolicySetting, shorter
from rga_bench.policies.table import page
from rga_bench.policies.twin_run import PolicyResult, run_twin


@dataclass(frozen=True)
class PoliciesExperiment(Experiment[Sequence[PolicyResult]]):
    """Policies beside each other.

    Attributes:
        setting: streams, and the twins that run through them.
    """

    name = "policies"

    setting: PolicySetting

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(shorter(seed) if quick else PolicySetting(seed=seed))

    def measure(self, execution: Execution) -> list[PolicyResult]:
        """Results in the order of the tasks."""
        return outcomes_of(run_twin, self.setting.tasks(), PolicyResult, execution)

    def page(self, result: Sequence[PolicyResult], command: str) -> MarkdownPage:
        """The table."""
        return page(result, command)

    def write_figures(self, result: Sequence[PolicyResult], folder: Path) -> None:
        """Write `policies.png`."""
        from rga_bench.policies.plot import plot

        plot(result, folder / "policies.png")

    def content(self, result: Sequence[PolicyResult], command: str) -> dict[str, Any]:
        """Every twin on every stream."""
        return {
            "command": command,
            "machine": machine(),
            "versions": versions(),
            "seed": self.setting.seed,
            "played": [asdict(one) for one in result],
        }
