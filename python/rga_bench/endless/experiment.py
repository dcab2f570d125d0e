"""What a row costs a twin that has run for long."""

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, Self

from rga_bench.endless.measure import CALIBRATION, EARLY, PACKET, STRETCH, LongRun, measure
from rga_bench.experiment import Execution, Experiment
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.speed.sized_case import SizedCase
from rga_bench.text_table import TextTable

#: rows of the runs, sensors and panels
SIZES = ((10_000, 84, 10), (100_000, 84, 10), (1_000_000, 12, 10))
QUICK = ((3_000, 12, 10),)


@dataclass(frozen=True)
class EndlessExperiment(Experiment[Sequence[LongRun]]):
    """Runs of several lengths in which nothing happens.

    Attributes:
        cases: in the order in which they are played.
    """

    name = "endless"

    cases: Sequence[SizedCase]

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        sizes = QUICK if quick else SIZES
        return cls([SizedCase(*size, "nothing", seed) for size in sizes])

    def measure(self, execution: Execution) -> list[LongRun]:
        """One after the other."""
        rows = [case.rows for case in self.cases]
        found = []
        for number, case in enumerate(self.cases):
            begun, own = sum(rows[:number]) / sum(rows), case.rows / sum(rows)
            found.append(measure(case, partial(_within, execution.progress, begun, own)))
        return found

    def page(self, result: Sequence[LongRun], command: str) -> MarkdownPage:
        """The table."""
        rows = [
            [
                f"{one.case.rows:,}",
                str(one.case.sensors),
                f"{1e3 * one.early:.2f}",
                f"{1e3 * one.late:.2f}",
                f"{one.ratio:.2f}",
                f"{(one.stored - one.rows_stored) / 1e3:.1f}",
                f"{one.take_up:.1f}",
            ]
            for one in result
        ]
        headings = ["rows", "sensors", f"row behind {EARLY:,} [ms]", "row at the end [ms]"]
        headings += ["ratio", "stored a step beside rows [kB]", "taken up again [s]"]
        return MarkdownPage(
            file="endless.md",
            title="What a row costs a twin that has run for long",
            origin=f"`{command}`",
            about=[
                f"{machine()['processor']}, one core. Level C, all contexts measured.",
                f"Packets of {PACKET} rows; the first {CALIBRATION} rows are for the calibration.",
                f"A row costs the median step of {STRETCH:,} rows over the rows of a packet.",
                "Nothing happens in these runs. Taking one up reads all of its rows.",
            ],
            parts=[TextTable("", headings, rows, numbers=True)],
        )

    def write_figures(self, result: Sequence[LongRun], folder: Path) -> None:
        """There is none."""

    def content(self, result: Sequence[LongRun], command: str) -> dict[str, Any]:
        """Every run."""
        return {
            "command": command,
            "machine": machine(),
            "versions": versions(),
            "runs": [{**asdict(one), "ratio": one.ratio} for one in result],
        }


def _within(progress: Callable[[float], None], begun: float, own: float, share: float) -> None:
    progress(begun + own * share)
