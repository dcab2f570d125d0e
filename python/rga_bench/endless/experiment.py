"""What a twin costs that goes on for ever, and whether anything is lost on the way."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any, Self

from rga_bench.endless.fleet import BEFORE, Fleet, fleet
from rga_bench.endless.measure import EARLY, PACKET, STRETCH, TURNS, LongRun, measure
from rga_bench.endless.same_bits import SameBits, cuts, kills
from rga_bench.endless.stream import Progress
from rga_bench.experiment import Execution, Experiment
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.text_table import TextTable

#: rows, sensors and panels of long runs
PANELS = 10
SIZES = ((20_000, 84, PANELS), (1_000_000, 84, PANELS))
#: cuts, kills, and minutes of 50 bridges with 84 sensors
CUTS, KILLS, MINUTES = 100, 1_000, 30
ABOUT = (
    "{}. Live twins on SQLite, level C, all contexts measured; nothing happens. Rows are fed and "
    "played; feeding is part of the time."
)
HOW = (
    f"Packets of {PACKET} rows. A row costs the median of {TURNS} stretches of {STRETCH} rows, "
    f"measured by turns on the run that is old and on one that begins anew (behind {EARLY:,} rows)."
)
TAKEN_UP = (
    "Taken up by a new process: the time is without starting Python and loading rga, the memory is "
    "all of the process, and in brackets what it was before."
)
#: shares of the time that the parts take
SHARES = (0.7, 0.1, 0.1, 0.1)


@dataclass(frozen=True)
class Endless:
    """All that was measured."""

    runs: Sequence[LongRun]
    disturbed: Sequence[SameBits]
    fleet: Fleet


@dataclass(frozen=True)
class EndlessExperiment(Experiment[Endless]):
    """Runs of several lengths, runs that are disturbed, and many bridges at once.

    Attributes:
        sizes: rows, sensors and panels of the long runs.
        cuts, kills: how often runs are disturbed.
        bridges, sensors, minutes: of the fleet.
        seed: of what is drawn.
    """

    name = "endless"

    sizes: Sequence[tuple[int, int, int]]
    cuts: int
    kills: int
    bridges: int
    sensors: int
    minutes: int
    seed: int

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        if quick:
            return cls([(4_000, 12, PANELS)], 2, 3, 2, 12, 3, seed)
        return cls(SIZES, CUTS, KILLS, 50, 84, MINUTES, seed)

    def measure(self, execution: Execution) -> Endless:
        """One after the other."""
        shares = iter(SHARES)
        begun = 0.0

        def stage() -> Progress:
            nonlocal begun
            first, own = begun, next(shares)
            begun += own
            return partial(_within, execution.progress, first, own)

        long_runs = stage()
        rows = [one[0] for one in self.sizes]
        runs = [
            measure(
                *size,
                self.seed,
                partial(_within, long_runs, sum(rows[:k]) / sum(rows), rows[k] / sum(rows)),
            )
            for k, size in enumerate(self.sizes)
        ]
        disturbed = [
            cuts(self.cuts, self.seed, stage()),
            kills(self.kills, self.seed, stage()),
        ]
        together = fleet(self.bridges, self.sensors, self.minutes, self.seed, stage())
        return Endless(runs, disturbed, together)

    def page(self, result: Endless, command: str) -> MarkdownPage:
        """The tables."""
        return MarkdownPage(
            file="endless.md",
            title="A twin without end",
            origin=f"`{command}`",
            about=[ABOUT.format(machine()["processor"]), HOW, TAKEN_UP],
            parts=[_long(result.runs), _disturbed(result.disturbed), _fleet(result.fleet)],
        )

    def write_figures(self, result: Endless, folder: Path) -> None:
        """There is none."""

    def content(self, result: Endless, command: str) -> dict[str, Any]:
        """Everything."""
        return {
            "command": command,
            "machine": machine(),
            "versions": versions(),
            "runs": [{**asdict(one), "ratio": one.ratio} for one in result.runs],
            "disturbed": [asdict(one) for one in result.disturbed],
            "fleet": asdict(result.fleet),
        }


def _long(runs: Sequence[LongRun]) -> TextTable:
    rows = [
        [
            f"{one.rows:,}",
            str(one.sensors),
            f"{1e3 * one.early:.2f}",
            f"{1e3 * one.late:.2f}",
            f"{one.ratio:.2f}",
            f"{(one.stored - one.rows_stored) / 1e3:.1f}",
            f"{one.taken_up:,}",
            f"{one.take_up:.2f}",
            f"{one.memory / 1e6:.0f} ({one.loaded / 1e6:.0f})",
        ]
        for one in runs
    ]
    headings = ["rows", "sensors", "early row [ms]", "late row [ms]", "ratio"]
    headings += ["stored a step beside rows [kB]", "taken up behind", "in [s]", "memory [MB]"]
    return TextTable("What a row costs", headings, rows, numbers=True)


def _disturbed(found: Sequence[SameBits]) -> TextTable:
    rows = [
        [
            one.what,
            *(
                f"{number:,}"
                for number in (one.times, one.runs, one.rows, one.lost, one.doubled, one.differing)
            ),
        ]
        for one in found
    ]
    headings = ["runs", "times", "runs", "rows of each", "lost", "doubled", "with other bits"]
    return TextTable("What is lost", headings, rows, numbers=True)


def _fleet(one: Fleet) -> TextTable:
    row = [
        str(one.bridges),
        str(one.sensors),
        str(one.minutes),
        f"{100 * one.load:.1f}",
        f"{one.median:.1f}",
        f"{one.slowest:.1f}",
    ]
    headings = ["bridges", "sensors on each", "minutes", "share of two cores [%]"]
    headings += ["minute taken in within [s]", "slowest [s]"]
    title = f"A row a minute from many bridges, behind {BEFORE} rows of each"
    return TextTable(title, headings, [row], numbers=True)


def _within(progress: Progress, begun: float, own: float, share: float) -> None:
    progress(begun + own * share)
