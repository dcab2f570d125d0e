"""The blind challenge: every draw diagnosed and scored once."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

from rga.errors import InputError
from rga_bench.diagnosis.blind_draw import draws
from rga_bench.diagnosis.design import QUICK, Draw
from rga_bench.diagnosis.field_design import GENERATORS
from rga_bench.diagnosis.figures import figures
from rga_bench.diagnosis.judge import DrawOutcome, judge
from rga_bench.diagnosis.tables import tables
from rga_bench.experiment import Execution, Experiment
from rga_bench.ledger import outcomes_of, task_versions
from rga_bench.page import PlainPage


@dataclass(frozen=True)
class DiagnosisExperiment(Experiment[Sequence[DrawOutcome]]):
    """The blind challenge.

    Attributes:
        seed: of all draws.
        count: hidden effects; each stands beside its null twin.
        generator: what makes the cases, one of `GENERATORS`.
    """

    name = "diagnosis"

    seed: int
    count: int
    generator: str = "bridges"

    @classmethod
    def of(cls, seed: int, *, quick: bool, count: int, generator: str) -> Self:
        """That of a command line (InputError)."""
        if generator not in GENERATORS:
            remedy = f"give one of {', '.join(GENERATORS)}"
            raise InputError(f"there is no generator {generator!r}", "--generator", remedy)
        return cls(seed, QUICK if quick else count, generator)

    def draws(self) -> Sequence[Draw]:
        """The tasks, in the order in which they are begun."""
        return draws(self.seed, self.count, GENERATORS[self.generator])

    def measure(self, execution: Execution) -> list[DrawOutcome]:
        """Outcomes in the order of the draws.

        Raises:
            InputError: as of every experiment; or no draw was finished in time.
        """
        outcomes = outcomes_of(judge, self.draws(), DrawOutcome, execution)
        if not outcomes:
            raise InputError("no draw was finished", "--minutes", "give more of them")
        return outcomes

    def page(self, result: Sequence[DrawOutcome], command: str) -> PlainPage:
        """All tables."""
        return PlainPage("tables.txt", tables(result))

    def write_figures(self, result: Sequence[DrawOutcome], folder: Path) -> None:
        """Write `calibration.png` and `confusion.png`."""
        from rga_bench.diagnosis.plots import plot

        plot(result, folder)

    def content(self, result: Sequence[DrawOutcome], command: str) -> dict[str, Any]:
        """Figures and outcomes."""
        return {
            "seed": self.seed,
            "generator": self.generator,
            "versions": task_versions(judge),
            "figures": [{**asdict(one), "judged": one.judged} for one in figures(result)],
            "outcomes": [asdict(one) for one in result],
        }
