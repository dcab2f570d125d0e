"""What broken channels do to a diagnosis, as tables."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from rga_bench.diagnosis.figures import rate
from rga_bench.faults.comparison import Comparison, comparisons
from rga_bench.faults.library import FAULTS
from rga_bench.faults.result import FaultsResult
from rga_bench.faults.trial import LEFT_OUT
from rga_bench.page import MarkdownPage
from rga_bench.text_table import TextTable

HEADINGS = [
    "",
    "records",
    "unmoved %",
    "reported %",
    "both %",
    "as a cause %",
    "hidden kept %",
    "calm, wrong %",
    "time",
    "worst",
]
#: how many channels, and from when on
WAYS = {
    "one channel, from the first row": ("whole",),
    "one channel, from an onset": ("late",),
    "one channel": ("whole", "late"),
    "two channels": ("pair",),
    "three of twenty": ("several",),
    "three of twenty left out, none broken": (LEFT_OUT,),
}
NOTES = """\
Unmoved: the causes that are no sensor's are those of the sound record. Reported: every broken
channel is a cause of a sensor's kind, among the rivals of a cause, or in a warning that the sound
record does not have; as a cause: not in a warning alone. Hidden kept: what is hidden, and was found
in the sound record, is still found. Calm, wrong: `nothing_wrong` or `named`, with a broken channel
unreported, with the gap rising on held-out rows, or with nothing wrong at a gap above 2. Time: of
the processor, over that of the sound record, median and worst. Intervals are Wilson's, at 90 %.
Records that lose channels without a fault bound what the other channels can show."""


def page(result: FaultsResult, command: str) -> MarkdownPage:
    """The tables, what is meant, and every record that was not reported right."""
    failed = [one for one in comparisons(result.outcomes) if _failure(one)]
    failures = "\n".join(["## Failures", "", *(f"- {_line(one)}" for one in failed)])
    return MarkdownPage(
        "faults.md",
        "What broken channels do to a diagnosis",
        f"`{command}`",
        _about(result),
        [NOTES, *_tables(result), failures],
    )


def _about(result: FaultsResult) -> list[str]:
    """How much was measured, and by what."""
    several = comparisons(result.outcomes)
    records = len({one.outcome.base for one in several})
    named = [f"{name} {number}" for name, number in result.versions.items()]
    return [f"{len(several)} diagnoses of {records} records", ", ".join(named)]


def _tables(result: FaultsResult) -> list[TextTable]:
    several = comparisons(result.outcomes)
    single = [one for one in several if one.outcome.way in WAYS["one channel"]]

    def of_fault(name: str) -> list[Comparison]:
        return [one for one in single if one.outcome.fault == name]

    def of_ways(name: str) -> list[Comparison]:
        return [one for one in several if one.outcome.way in WAYS[name]]

    def of_source(name: str) -> list[Comparison]:
        return [one for one in single if _source(one) == name]

    sources = dict.fromkeys(_source(one) for one in single)
    return [
        _table("By the channels that break", WAYS, of_ways),
        _table("One channel, by its fault", FAULTS, of_fault),
        _table("One channel, by its record", sources, of_source),
    ]


def _source(one: Comparison) -> str:
    return one.outcome.base.split("-")[0].split("/")[0]


def _table(
    title: str, names: Iterable[str], chosen: Callable[[str], list[Comparison]]
) -> TextTable:
    return TextTable(title, HEADINGS, [[name, *_cells(chosen(name))] for name in names])


def _cells(several: Sequence[Comparison]) -> list[str]:
    if not several:
        return ["-"] * (len(HEADINGS) - 1)
    times = [one.times for one in several]
    return [
        str(len(several)),
        _share(one.unmoved for one in several),
        _share(one.told for one in several),
        _share(one.unmoved and one.told for one in several),
        _share(one.named for one in several),
        _share(one.kept for one in several if one.kept is not None),
        _share(one.calm for one in several),
        f"{np.median(times):.2f}",
        f"{max(times):.1f}",
    ]


def _share(hits: Iterable[bool]) -> str:
    one = rate("", hits)
    if one.value is None or one.low is None or one.high is None:
        return "-"
    return f"{100 * one.value:.0f} ({100 * one.low:.0f}..{100 * one.high:.0f})"


def _failure(one: Comparison) -> str:
    """What is wrong with a diagnosis; nothing where all is right."""
    if one.outcome.error:
        return one.outcome.error
    words = {
        "calm": one.calm,
        "moved": not one.unmoved,
        "unreported": not one.told,
    }
    return ", ".join(word for word, is_so in words.items() if is_so)


def _line(one: Comparison) -> str:
    outcome = one.outcome
    gone = "; ".join(f"{each['sensor']} {each['fault']} @{each['row']}" for each in outcome.broken)
    causes = "; ".join(
        " ".join(str(value) for key, value in cause.items() if key != "rivals")
        for cause in outcome.causes
    )
    return f"{_failure(one)}: {outcome.id} ({gone}) -> {outcome.verdict}: {causes or 'nothing'}"
