"""The blind challenge with modes: every draw diagnosed and scored once."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np

from rga.errors import InputError
from rga_bench.diagnosis.blind_draw import draws
from rga_bench.experiment import Execution, Experiment
from rga_bench.ledger import outcomes_of, task_versions
from rga_bench.modal_diagnosis.design import QUICK, ModalDraw
from rga_bench.modal_diagnosis.judge import ModalOutcome, judge_modes
from rga_bench.modal_diagnosis.tables import modal_figures, modal_tables
from rga_bench.page import MarkdownPage


@dataclass(frozen=True)
class ModalDiagnosisExperiment(Experiment[Sequence[ModalOutcome]]):
    """The blind challenge with modes.

    Attributes:
        seed: of all draws.
        count: hidden effects; each stands beside its null twin.
        options: that make the same again.
    """

    name = "modal-diagnosis"

    seed: int
    count: int
    options: str = ""

    @classmethod
    def of(cls, seed: int, *, quick: bool, count: int) -> Self:
        """That of a command line."""
        return cls(seed, QUICK, "") if quick else cls(seed, count, f" --draws {count}")

    def draws(self) -> Sequence[ModalDraw]:
        """The tasks, in the order in which they are begun."""
        return draws(self.seed, self.count, ModalDraw)

    def measure(self, execution: Execution) -> list[ModalOutcome]:
        """Outcomes in the order of the draws.

        Raises:
            InputError: as of every experiment; or no draw was finished in time.
        """
        outcomes = outcomes_of(judge_modes, self.draws(), ModalOutcome, execution)
        if not outcomes:
            raise InputError("no draw was finished", "--minutes", "give more of them")
        return outcomes

    def page(self, result: Sequence[ModalOutcome], command: str) -> MarkdownPage:
        """All tables."""
        middle, slow = np.quantile([one.seconds for one in result], [0.5, 0.95])
        hidden = sum(not one.draw.null for one in result)
        about = [
            f"{len(result)} diagnoses, {hidden} of them with something hidden",
            f"{middle:.1f} s each (median), {slow:.1f} s at the 95 %",
            "found: kind and place right, as a cause or among at most three rivals",
            "wrongly named: `named`, and what is hidden is neither a cause nor a rival",
        ]
        return MarkdownPage(
            "modal-diagnosis.md", "The blind challenge with modes", f"`{command}`", about,
            modal_tables(result),
        )  # fmt: skip

    def write_figures(self, result: Sequence[ModalOutcome], folder: Path) -> None:
        """Nothing stands beside the page."""

    def content(self, result: Sequence[ModalOutcome], command: str) -> dict[str, Any]:
        """Figures and outcomes."""
        return {
            "command": command,
            "seed": self.seed,
            "versions": task_versions(judge_modes),
            "figures": [{**asdict(one), "judged": one.judged} for one in modal_figures(result)],
            "outcomes": [asdict(one) for one in result],
        }
