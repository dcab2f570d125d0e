"""Time and memory of a diagnosis over rows, sensors and members, and where it becomes unusable."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rga_bench.experiment import Execution, Experiment
from rga_bench.ledger import Ledger, task_versions
from rga_bench.limits.one_size import measure
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.text_table import TextTable

#: rows, sensors and panels, of eleven members each and ten a span
SIZES = (
    (1_000, 84, 10), (10_000, 84, 10), (100_000, 84, 10), (1_000_000, 84, 10),
    (1_000, 500, 50), (100_000, 500, 50), (1_000_000, 500, 50),
    (1_000, 84, 100), (1_000, 84, 460), (1_000, 500, 460), (100_000, 500, 460),
)  # fmt: skip
QUICK = ((200, 12, 10),)
#: how long one size may take [s]
LONGEST = 600.0
ABOUT = (
    "{}, one core. Footbridges of spans of 46 m, ten panels each, in which nothing is hidden, all "
    "contexts measured; the records are Parquet files."
)
ENVIRONMENT = os.environ | {"OMP_NUM_THREADS": "1"}
ONE = "rga_bench.limits.one_size"
NONE_SMALLER = "a smaller one did not"


@dataclass(frozen=True)
class SizeOutcome:
    """What a size took.

    Attributes:
        rows, sensors, panels: of the record and the bridge.
        members: of the bridge; None where the time was over.
        reading, diagnosis: time [s]; None where it was over.
        memory: largest of the process, with Python and rga [B].
        verdict: of the diagnosis.
        ended: "yes", "no time", "no memory", or that a smaller one did not.
    """

    rows: int
    sensors: int
    panels: int
    ended: str
    members: int | None = None
    reading: float | None = None
    diagnosis: float | None = None
    memory: int | None = None
    verdict: str = ""

    @property
    def id(self) -> str:
        """Its name in the ledger."""
        return f"{self.rows}-{self.sensors}-{self.panels}"

    def within(self, size: tuple[int, int, int]) -> bool:
        """Whether another size is as large in all."""
        own = (self.rows, self.sensors, self.panels)
        return all(one <= other for one, other in zip(own, size, strict=True))


@dataclass(frozen=True)
class LimitsExperiment(Experiment[Sequence[SizeOutcome]]):
    """Diagnoses of ever larger records.

    Attributes:
        sizes: rows, sensors and panels.
        seed: of what is drawn.
    """

    name = "limits"

    sizes: Sequence[tuple[int, int, int]]
    seed: int

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(QUICK if quick else SIZES, seed)

    def measure(self, execution: Execution) -> list[SizeOutcome]:
        """One after the other, each in processes of its own; none larger than what did not end."""
        ledger: Ledger[SizeOutcome] | None = None
        if execution.folder is not None:
            seeded = task_versions(measure) | {"seed": str(self.seed)}
            ledger = Ledger(execution.folder, SizeOutcome, seeded)
        found: list[SizeOutcome] = []
        for number, size in enumerate(self.sizes):
            outcome = SizeOutcome(*size, NONE_SMALLER)
            if ledger is not None and outcome.id in ledger.outcomes:
                outcome = ledger.outcomes[outcome.id]
            else:
                if not any(one.ended != "yes" and one.within(size) for one in found):
                    outcome = _measured(*size, self.seed)
                if ledger is not None:
                    ledger.add(outcome)
            found.append(outcome)
            execution.progress((number + 1) / len(self.sizes))
        return found

    def page(self, result: Sequence[SizeOutcome], command: str) -> MarkdownPage:
        """The table."""
        headings = ["rows", "sensors", "members", "reading [s]", "diagnosis [s]", "memory [GB]"]
        return MarkdownPage(
            file="limits.md",
            title="How much a diagnosis can be given",
            origin=f"`{command}`",
            about=[
                ABOUT.format(machine()["processor"]),
                f"Whatever takes longer than {LONGEST / 60:.0f} minutes is ended.",
            ],
            parts=[TextTable("", [*headings, "verdict"], [_row(one) for one in result], True)],
        )

    def write_figures(self, result: Sequence[SizeOutcome], folder: Path) -> None:
        """There is none."""

    def content(self, result: Sequence[SizeOutcome], command: str) -> dict[str, Any]:
        """Every size."""
        return {
            "command": command,
            "machine": machine(),
            "versions": versions(),
            "sizes": [asdict(one) for one in result],
        }


def _measured(rows: int, sensors: int, panels: int, seed: int) -> SizeOutcome:
    with tempfile.TemporaryDirectory() as folder:
        numbers = map(str, (rows, sensors, panels, seed))
        command = [sys.executable, "-m", ONE]
        given: dict[str, Any] = {"check": True, "capture_output": True, "env": ENVIRONMENT}
        try:
            subprocess.run([*command, "draw", folder, *numbers], **given)
            done = subprocess.run([*command, "measure", folder], timeout=LONGEST, **given)
        except subprocess.TimeoutExpired:
            return SizeOutcome(rows, sensors, panels, "no time")
        except subprocess.CalledProcessError as error:
            # The system kills what takes more memory than there is.
            if error.returncode in (-9, 137) or b"MemoryError" in error.stderr:
                return SizeOutcome(rows, sensors, panels, "no memory")
            raise
    return SizeOutcome(rows, sensors, panels, "yes", **json.loads(done.stdout))


def _row(one: SizeOutcome) -> list[str]:
    cells = [f"{one.rows:,}", str(one.sensors), str(one.members or f"about {11 * one.panels}")]
    if one.reading is None or one.diagnosis is None or one.memory is None:
        return [*cells, "", "", "", f"not ended: {one.ended}"]
    measured = [f"{one.reading:.1f}", f"{one.diagnosis:.1f}", f"{one.memory / 1e9:.2f}"]
    return [*cells, *measured, one.verdict]
