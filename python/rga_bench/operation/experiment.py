"""Live operation: what is lost, what a packet costs, and how soon a row is seen."""

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
from rga_bench.operation.pages import PageCost, page_cost
from rga_bench.operation.rates import DENSE, Rate, rate
from rga_bench.operation.tables import loss_table, page_parts, rate_table, unreadable_table
from rga_bench.operation.unreadable import Unreadable, unreadable
from rga_bench.page import MarkdownPage

#: sensors and panels of the bridge, and packets of one reading and of a dense second
SENSORS, PANELS = 84, 10
SMALL, LARGE = 20_000, 600
#: kills of each sort, and packets that are sent between two of them
KILLS, BETWEEN = 200, 20
#: packets among which some payloads cannot be read
READABLE = 5_000
#: sensors and panels of bridges whose pages are looked at, rows for each measure, and viewers
BRIDGES = ((84, PANELS), (500, 50))
ROWS, VIEWERS = 100, 50
ABOUT = (
    "{}. A service (`rga serve`) with one twin on SQLite; mosquitto is between it and the logger "
    "where a broker is named. The logger numbers its packets, reads what is acknowledged end to "
    "end, and sends again; 5 % of its packets come twice, 10 % out of order."
)
HOW = (
    "Rates: packets wait in the broker, and are taken out on one core, by a subscriber that keeps "
    "none, and by a twin that keeps each on the disk before it is acknowledged, and makes rows."
)
SEEN = (
    "Pages: rows are sent one at a time, each when the one before is seen. Times are those that "
    "95 % of the rows keep, from sending what makes a row final until it is seen. A viewer follows "
    "the stream of the bridge, and loads its page again at every row."
)


@dataclass(frozen=True)
class Operation:
    """All that was measured."""

    rates: Sequence[Rate]
    losses: Sequence[Losses]
    unreadable: Unreadable
    pages: Sequence[PageCost]


@dataclass(frozen=True)
class OperationExperiment(Experiment[Operation]):
    """Rates, kills of each sort, what cannot be read, and pages.

    Attributes:
        small, large: packets of one reading, and of a dense second.
        kills: of each sort.
        readable: packets among which some payloads cannot be read.
        bridges: sensors and panels of those whose pages are looked at.
        rows, viewers: that are sent for each measure of a page, and who look at once.
        seed: of what is drawn.
    """

    name = "operation"

    small: int
    large: int
    kills: int
    readable: int
    bridges: Sequence[tuple[int, int]]
    rows: int
    viewers: int
    seed: int

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        if quick:
            return cls(500, 20, 1, 100, BRIDGES[:1], 5, 5, seed)
        return cls(SMALL, LARGE, KILLS, READABLE, BRIDGES, ROWS, VIEWERS, seed)

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
            share = partial(_within, execution.progress, 0.1 + 0.6 * number / len(every))
            record = stream.rows(0, rows)
            found.append(
                losses(killed, self.kills, model, stream.settings, record, self.seed, share)
            )
        unread = unreadable(self.readable, stream, self.seed)
        pages = []
        for number, size in enumerate(self.bridges):
            execution.progress(0.75 + 0.25 * number / len(self.bridges))
            pages.append(page_cost(*size, self.rows, self.viewers, self.seed))
        return Operation(rates, found, unread, pages)

    def page(self, result: Operation, command: str) -> MarkdownPage:
        """The tables."""
        return MarkdownPage(
            file="operation.md",
            title="Live operation",
            origin=f"`{command}`",
            about=[ABOUT.format(machine()["processor"]), HOW, SEEN],
            parts=[
                rate_table(result.rates),
                loss_table(result.losses),
                unreadable_table(result.unreadable),
                *page_parts(result.pages),
            ],
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
            "unreadable": asdict(result.unreadable),
            "pages": [asdict(one) for one in result.pages],
        }


def _within(progress: Progress, begun: float, share: float) -> None:
    progress(begun + 0.2 * share)
