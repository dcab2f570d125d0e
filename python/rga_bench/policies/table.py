"""The comparison as a table."""

from collections.abc import Sequence
from itertools import groupby

from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.policies.mean_results import Means, means
from rga_bench.policies.twin_run import PolicyResult
from rga_bench.text_table import TextTable

#: measure and format of each column
COLUMNS = {
    "recalibrations": ("recalibrations", ".3g"),
    "alarms": ("alarms", ".3g"),
    "diagnoses requested": ("diagnoses", ".3g"),
    "optimiser steps": ("steps", ".0f"),
    "simulations": ("simulations", ".0f"),
    "gap [-]": ("gap", ".2f"),
    "RG [mm²]": ("rg", ".3f"),
    "rows out of sync": ("out_of_sync", ".1%"),
    "seconds": ("seconds", ".0f"),
}
NOTES = """\
Means over the streams of a sort. All costs are those after the first calibration, which every twin
of a stream has in common. Nothing is hidden in the structure, and no diagnosis is made: those that
a twin requested, because a recalibration did not bring the gap down, are counted.

The gap is the mean over rows and sensors of the squared gap over the variance of the noise, RG the
mean of the squared gap over displacement sensors, both as the twin stood at the time, before a
recalibration looked back. A row is out of sync where its gap is 1.8 times what noise and scatter
let expect. Contexts are inferred by networks. On the null twin nothing drifts: all that is spent
there is waste."""


def page(played: Sequence[PolicyResult], command: str) -> MarkdownPage:
    """The table, and what it means."""
    return MarkdownPage(
        "policies.md",
        "What each policy of synchronisation costs",
        f"`{command}`",
        _about(played),
        [_table(played), NOTES],
        {"policies.png": "cost against gap"},
    )


def _about(played: Sequence[PolicyResult]) -> list[str]:
    """Where it was measured, and how much."""
    place = machine()
    named = [f"{name} {number}" for name, number in versions().items() if number]
    seeds = len({one.seed for one in played})
    return [
        f"{place['processor']}, {place['cores']} cores, {place['system']}",
        ", ".join(named),
        f"{seeds} {'streams' if seeds > 1 else 'stream'} of each sort",
    ]


def _table(played: Sequence[PolicyResult]) -> TextTable:
    """Policies under each sort of stream."""
    rows = []
    for stream, places in groupby(means(played).items(), lambda one: one[0][0]):
        rows.append([stream])
        rows += [[policy, *_cells(measured)] for (_, policy), measured in places]
    return TextTable("", ["policy", *COLUMNS], rows, numbers=True)


def _cells(measured: Means) -> list[str]:
    return [format(measured[name], form) for name, form in COLUMNS.values()]
