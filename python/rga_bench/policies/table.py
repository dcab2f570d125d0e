"""The comparison as a table, for a terminal and in Markdown."""

from collections.abc import Sequence
from itertools import groupby

from rich.table import Table
from rich.text import Text

from rga_bench.machine import machine, versions
from rga_bench.policies.run import Means, means
from rga_bench.policies.twin_run import PolicyResult

#: measure and format of each column
COLUMNS = {
    "recalibrations": ("recalibrations", ".3g"),
    "alarms": ("alarms", ".3g"),
    "diagnoses asked": ("diagnoses", ".3g"),
    "optimiser steps": ("steps", ".0f"),
    "simulations": ("simulations", ".0f"),
    "gap [-]": ("gap", ".2f"),
    "RG [mm²]": ("rg", ".3f"),
    "rows out of sync": ("out_of_sync", ".1%"),
    "seconds": ("seconds", ".0f"),
}
HEADINGS = ("policy", *COLUMNS)
NOTES = """\
Means over the streams of a sort. All costs are those after the first calibration, which every twin
of a stream has in common. Nothing is hidden in the structure, and no diagnosis is made: those that
a twin asked for, because a recalibration did not bring the gap down, are counted.

The gap is the mean over rows and sensors of the squared gap over the variance of the noise, RG the
mean of the squared gap over displacement sensors, both as the twin stood at the time, before a
recalibration looked back. A row is out of sync where its gap is beyond what a recalibration may
leave (`recovered`). On the null twin nothing drifts: all that is spent there is waste."""


def about(played: Sequence[PolicyResult]) -> list[str]:
    """Where it was measured, and how much."""
    place = machine()
    named = [f"{name} {number}" for name, number in versions().items() if number]
    seeds = len({one.seed for one in played})
    return [
        f"{place['processor']}, {place['cores']} cores, {place['system']}",
        ", ".join(named),
        f"{seeds} {'streams' if seeds > 1 else 'stream'} of each sort",
    ]


def terminal(played: Sequence[PolicyResult]) -> Table:
    """For rich."""
    table = Table(HEADINGS[0])
    for heading in COLUMNS:
        table.add_column(heading, justify="right")
    for stream, rows in _by_stream(played):
        table.add_section()
        table.add_row(Text(stream, style="bold"))
        for cells in rows:
            table.add_row(*(Text(cell) for cell in cells))
    return table


def markdown(played: Sequence[PolicyResult], command: str) -> str:
    """A page with the table and the figure."""
    lines = ["# What each policy of synchronisation costs", "", f"`{command}`", ""]
    lines += [*(f"- {line}" for line in about(played)), ""]
    lines += [_row(HEADINGS), _row(["---", *["---:"] * len(COLUMNS)])]
    for stream, rows in _by_stream(played):
        lines.append(_row([f"**{stream}**", *[""] * len(COLUMNS)]))
        lines += [_row(cells) for cells in rows]
    return "\n".join([*lines, "", NOTES, "", "![cost against gap](policies.png)", ""])


def _by_stream(played: Sequence[PolicyResult]) -> list[tuple[str, list[list[str]]]]:
    known = means(played)
    return [
        (stream, [[policy, *_cells(known[stream, policy])] for _, policy in places])
        for stream, places in groupby(known, lambda place: place[0])
    ]


def _cells(measured: Means) -> list[str]:
    return [format(measured[name], form) for name, form in COLUMNS.values()]


def _row(cells: Sequence[str]) -> str:
    return f"| {' | '.join(cells)} |"
