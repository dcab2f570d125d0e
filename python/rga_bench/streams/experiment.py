"""The twin as it is shipped, measured on streams whose truth is known."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rga_bench.experiment import Execution, Experiment
from rga_bench.ledger import outcomes_of
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.streams.setting import StreamSetting, shorter
from rga_bench.streams.table import page
from rga_bench.streams.twin_run import StreamOutcome, run_twin


@dataclass(frozen=True)
class StreamsExperiment(Experiment[Sequence[StreamOutcome]]):
    """Ways to infer contexts in the loop that is shipped.

    Attributes:
        setting: streams, and the twins that run through them.
    """

    name = "streams"

    setting: StreamSetting

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(shorter(seed) if quick else StreamSetting(seed=seed))

    def measure(self, execution: Execution) -> list[StreamOutcome]:
        """Results in the order of the tasks."""
        return outcomes_of(run_twin, self.setting.tasks(), StreamOutcome, execution)

    def page(self, result: Sequence[StreamOutcome], command: str) -> MarkdownPage:
        """The tables."""
        return page(result, command)

    def write_figures(self, result: Sequence[StreamOutcome], folder: Path) -> None:
        """None stands beside the page."""

    def content(self, result: Sequence[StreamOutcome], command: str) -> dict[str, Any]:
        """Every twin on every stream."""
        return {
            "command": command,
            "machine": machine(),
            "versions": versions(),
            "seed": self.setting.seed,
            "played": [asdict(one) for one in result],
        }
