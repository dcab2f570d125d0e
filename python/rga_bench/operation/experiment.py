"""Live operation: what is lost where something is killed, and what a packet costs."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any, Self, get_args

from rga.twin.versions import written
from rga_bench.endless.stream import Progress, Stream, settings
from rga_bench.experiment import Execution, Experiment
from rga_bench.machine import machine, versions
from rga_bench.operation.kills import Killed, Losses, losses
from rga_bench.operation.rates import DENSE, Rate, rate
from rga_bench.page import MarkdownPage
from rga_bench.text_table import TextTable

#: sensors and panels of the bridge, and packets of one reading and of a dense second
SENSORS, PANELS = 84, 10
SMALL, LARGE = 20_000, 600
#: kills of each sort, and packets that are sent between two of them
KILLS, BETWEEN = 200, 20
#: readings a second of a dense bridge
READINGS = DENSE[0] * DENSE[1]
ABOUT = (
    "{}. A service (`rga serve`) with one twin on SQLite; mosquitto is between it and the logger "
    "where a broker is named. The logger numbers its packets, reads what is acknowledged end to "
    "end, and sends again; 5 % of its packets come twice, 10 % out of order."
)
HOW = (
    "Rates: packets wait in the broker, and are taken out on one core, by a subscriber that keeps "
    "none, and by a twin that keeps each on the disk before it is acknowledged, and makes rows."
)


@dataclass(frozen=True)
class Operation:
    """All that was measured."""

    rates: Sequence[Rate]
    losses: Sequence[Losses]


@dataclass(frozen=True)
class OperationExperiment(Experiment[Operation]):
    """Rates, and kills of each sort.

    Attributes:
        small, large: packets of one reading, and of a dense second.
        kills: of each sort.
        seed: of what is drawn.
    """

    name = "operation"

    small: int
    large: int
    kills: int
    seed: int

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(500, 20, 1, seed) if quick else cls(SMALL, LARGE, KILLS, seed)

    def measure(self, execution: Execution) -> Operation:
        """One after the other."""
        stream = Stream(SENSORS, PANELS, settings(10, calibration_rows=100), self.seed)
        model = json.loads(written(stream.model)[0])
        rates = [
            rate(self.small, 1, 1, model, stream.settings),
            rate(self.large, *DENSE, model, stream.settings),
        ]
        execution.progress(0.1)
        rows, found = max(100, BETWEEN * self.kills), []
        every = get_args(Killed)
        for number, killed in enumerate(every):
            share = partial(_within, execution.progress, 0.1 + 0.9 * number / len(every))
            record = stream.rows(0, rows)
            found.append(
                losses(killed, self.kills, model, stream.settings, record, self.seed, share)
            )
        return Operation(rates, found)

    def page(self, result: Operation, command: str) -> MarkdownPage:
        """The tables."""
        return MarkdownPage(
            file="operation.md",
            title="Live operation",
            origin=f"`{command}`",
            about=[ABOUT.format(machine()["processor"]), HOW],
            parts=[_rates(result.rates), _losses(result.losses)],
        )

    def write_figures(self, result: Operation, folder: Any) -> None:
        """There is none."""

    def content(self, result: Operation, command: str) -> dict[str, Any]:
        """Everything."""
        return {
            "command": command,
            "machine": machine(),
            "versions": versions(),
            "rates": [asdict(one) | {"ratio": one.ratio} for one in result.rates],
            "losses": [asdict(one) for one in result.losses],
        }


def _rates(found: Sequence[Rate]) -> TextTable:
    rows = [
        [
            f"{one.packets:,}",
            f"{one.size:,}",
            f"{one.values:,}",
            f"{one.bare:,.0f}",
            f"{one.durable:,.0f}",
            f"{one.ratio:.2f}",
            f"{one.durable * one.values:,.0f}",
            f"{100 * READINGS / (one.durable * one.values):.2g}",
        ]
        for one in found
    ]
    headings = ["packets", "bytes", "readings in each", "bare [1/s]", "durable [1/s]", "ratio"]
    headings += ["readings [1/s]", "of a core for 84 x 250 Hz [%]"]
    return TextTable("What a packet costs", headings, rows, numbers=True)


def _losses(found: Sequence[Losses]) -> TextTable:
    rows = [
        [one.killed]
        + [
            f"{number:,}"
            for number in (
                one.times, one.packets, one.lost, one.doubled, one.unaccounted, one.differing,
            )
        ]
        for one in found
    ]  # fmt: skip
    headings = ["killed", "times", "packets", "lost", "doubled", "unaccounted", "rows that differ"]
    return TextTable("What is lost", headings, rows, numbers=True)


def _within(progress: Progress, begun: float, share: float) -> None:
    progress(begun + 0.3 * share)
