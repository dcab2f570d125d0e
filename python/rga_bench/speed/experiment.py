"""What a diagnosis costs, on one core."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rga_bench.experiment import Execution, Experiment
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.speed.measure import SpeedOutcome, measure
from rga_bench.speed.sized_case import Hidden, SizedCase
from rga_bench.text_table import TextTable

#: rows, sensors and panels
SIZES = ((300, 24, 10), (300, 84, 10), (1200, 24, 10), (300, 84, 22), (10_000, 84, 10))
QUICK = ((100, 12, 10),)
#: what is hidden in the records of every size, and in those of the largest
HIDDEN: tuple[Hidden, ...] = ("nothing", "section loss", "bearing", "broken channel")
LONG, HIDDEN_LONG = 5_000, ("nothing",)


@dataclass(frozen=True)
class SpeedExperiment(Experiment[Sequence[SpeedOutcome]]):
    """Diagnoses of records of several sizes.

    Attributes:
        cases: in the order in which they are diagnosed.
    """

    name = "diagnosis-speed"

    cases: Sequence[SizedCase]

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(
            [
                SizedCase(rows, sensors, panels, hidden, seed)
                for rows, sensors, panels in (QUICK if quick else SIZES)
                for hidden in HIDDEN
                if rows < LONG or hidden in HIDDEN_LONG
            ]
        )

    def measure(self, execution: Execution) -> list[SpeedOutcome]:
        """One after the other; a short one first, so that nothing is imported at a case's cost."""
        measure(SizedCase(*QUICK[0], "nothing", self.cases[0].seed))
        found = []
        for number, case in enumerate(self.cases):
            found.append(measure(case))
            execution.progress((number + 1) / len(self.cases))
        return found

    def page(self, result: Sequence[SpeedOutcome], command: str) -> MarkdownPage:
        """The table."""
        stages = list(result[0].stages)
        headings = ["hidden", "rows", "sensors", "members", "hypotheses", "time [s]"]
        rows = [
            [
                one.case.hidden,
                *map(str, (one.case.rows, one.case.sensors, one.members, one.hypotheses)),
                f"{one.seconds:.1f}",
                *(f"{one.stages[stage] / one.seconds:.0%}" for stage in stages),
                one.verdict,
            ]
            for one in result
        ]
        return MarkdownPage(
            file="diagnosis-speed.md",
            title="What a diagnosis costs",
            origin=f"`{command}`",
            about=[
                f"{machine()['processor']}, one core; time of the processor, imports left out.",
                "Shares of the time by stage, as the diagnosis reports its progress.",
            ],
            parts=[TextTable("", [*headings, *stages, "verdict"], rows, numbers=True)],
        )

    def write_figures(self, result: Sequence[SpeedOutcome], folder: Path) -> None:
        """There is none."""

    def content(self, result: Sequence[SpeedOutcome], command: str) -> dict[str, Any]:
        """Every diagnosis."""
        return {
            "command": command,
            "machine": machine(),
            "versions": versions(),
            "times": [asdict(one) for one in result],
        }
