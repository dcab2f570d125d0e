"""Tables of levels: the paper's, and what recalibration and stored states are worth."""

from collections.abc import Sequence

import numpy as np

from rga_bench.contexts.floors import FLOORS, TRUE_CONTEXT
from rga_bench.contexts.result import ContextsResult
from rga_bench.contexts.rows import PAPERS
from rga_bench.contexts.score import Score
from rga_bench.contexts.setting import LEVELS
from rga_bench.contexts.stream_results import StreamResult
from rga_bench.contexts.tables.aggregate import (
    at_level,
    gap_text,
    mean,
    over_drifts,
    paired,
    whole,
)
from rga_bench.measurement import digits
from rga_bench.text_table import TextTable

#: Error [-], RG [mm^2] and AD [rows] in the paper's table, by its columns and levels
PUBLISHED = {
    "residual loss": {"A": (0.466, 352), "B": (0.387, 301, 56.8), "C": (0.392, 298, 57.1)},
    "without physics": {"A": (0.681, 512), "B": (0.674, 520, 70.2), "C": (0.672, 526, 69.8)},
    "with physics": {"A": (0.405, 297), "B": (0.376, 259, 49.4), "C": (0.379, 261, 50.3)},
}
#: the paper's columns, the best first, which are in this order at every level
ORDER = ("with physics", "residual loss", "without physics")
NULL, RECURRING = "none", "recurring"


def published() -> TextTable:
    """What the paper reports of its own bridge."""
    rows = [
        [column, *(" / ".join(f"{one:g}" for one in of_level[level]) for level in LEVELS)]
        for column, of_level in PUBLISHED.items()
    ]
    headings = ["the paper's column", *(f"{level}: Error / RG / AD" for level in LEVELS)]
    return TextTable("The paper's own numbers, of its own bridge, not to be mixed", headings, rows)


def order(result: ContextsResult) -> str:
    """Whether methods are in the paper's order."""
    drifts = _drifts(result)
    played = {one.row for one in result.outcomes if one.played}
    if not drifts or not {PAPERS[one] for one in ORDER} <= played:
        return "The paper's order cannot be judged: not all of its columns were run."
    found = []
    for level in LEVELS:
        for name, of in (("Error", _error), ("RG", _rg)):
            values = [
                mean(over_drifts(at_level(result.outcomes, PAPERS[one], drifts, level), whole(of)))
                for one in ORDER
            ]
            known = [one.value for one in values if one is not None]
            found.append((f"{name} at {level}", known == sorted(known)))
    where = [name for name, there in found if there]
    methods = ", then ".join(PAPERS[one] for one in ORDER)
    if len(where) == len(found):
        return f"The paper's order ({methods}) appears here in Error and RG at every level."
    other = "nowhere" if not where else "only in " + ", ".join(where)
    return f"The paper's order ({methods}) does not appear here as a whole: {other}."


def papers(result: ContextsResult) -> list[TextTable]:
    """The paper's table: pooled over drifts, and of each drift."""
    drifts = _drifts(result)
    if not drifts:
        return []
    tables = [_levels(result, "The paper's table, all drifts together", drifts)]
    return tables + [_levels(result, f"Drift: {one}", [one]) for one in result.setting.drifts]


def worth(result: ContextsResult) -> list[TextTable]:
    """What recalibration changes, drift by drift, and that it forgets."""
    parts = {
        "once": [one for one in _drifts(result) if one != RECURRING],
        "on recurrence": [one for one in _drifts(result) if one == RECURRING],
        "on the null twin": [one for one in result.setting.drifts if one == NULL],
    }
    return [_worth(result, name, drifts) for name, drifts in parts.items() if drifts]


def _levels(result: ContextsResult, title: str, drifts: Sequence[str]) -> TextTable:
    headings = ["method"]
    for level in LEVELS:
        headings += [f"{level}: Error", "RG [mm²]", *([] if level == "A" else ["AD (seen)"])]
    true = mean(over_drifts(at_level(result.outcomes, TRUE_CONTEXT, drifts, LEVELS[0]), whole(_rg)))
    rows = []
    for row in _streamed(result):
        cells = [row]
        for level in LEVELS:
            results = at_level(result.outcomes, row, drifts, level)
            error, gap = (mean(over_drifts(results, whole(of))) for of in (_error, _rg))
            cells.append("" if error is None else error.text(".3f"))
            cells.append(gap_text(row, gap, true))
            if level != "A":
                cells.append(_delay([one for several in results.values() for one in several]))
        everywhere = at_level(result.outcomes, row, result.setting.drifts, LEVELS[1])
        rows.append([*cells, _arl([one for several in everywhere.values() for one in several])])
    return TextTable(title, [*headings, "ARL"], rows)


def _worth(result: ContextsResult, name: str, drifts: Sequence[str]) -> TextTable:
    headings = [
        "method", "Error, drifted: A", "B - A", "C - B", "ordinary: B - A", "C - A",
        "recalibrations: B", "C", "C - B", "recalled: C",
    ]  # fmt: skip

    rows = []
    for row in _streamed(result):
        if row in FLOORS:
            continue
        a, b, c = (at_level(result.outcomes, row, drifts, level) for level in LEVELS)
        drifted = [over_drifts(one, lambda played: played.drifted.error) for one in (a, b, c)]
        ordinary = [over_drifts(one, lambda played: played.ordinary.error) for one in (a, b, c)]
        learned = [over_drifts(one, lambda played: played.recalibrations) for one in (b, c)]
        differences = [
            (mean(drifted[0]), ".3f"),
            (paired(drifted[1], drifted[0]), "+.3f"),
            (paired(drifted[2], drifted[1]), "+.3f"),
            (paired(ordinary[1], ordinary[0]), "+.3f"),
            (paired(ordinary[2], ordinary[0]), "+.3f"),
            (mean(learned[0]), ".2f"),
            (mean(learned[1]), ".2f"),
            (paired(learned[1], learned[0]), "+.2f"),
            (mean(over_drifts(c, lambda played: played.recalled)), ".2f"),
        ]
        cells = ["" if one is None else one.text(form) for one, form in differences]
        rows.append([row, *cells])
    title = f"What recalibration changes: drifts {name} ({', '.join(drifts)})"
    return TextTable(title, headings, rows)


def _streamed(result: ContextsResult) -> list[str]:
    """Rows that ran through streams."""
    return [
        row for row in result.rows if at_level(result.outcomes, row, result.setting.drifts, "A")
    ]


def _delay(played: Sequence[StreamResult]) -> str:
    """Mean delay of the changes that were seen, and the share of them."""
    delays = [one for several in played for one in several.delays]
    seen = [one for one in delays if one is not None]
    if not delays:
        return ""
    return f"{digits(float(np.mean(seen))) if seen else '-'} ({len(seen) / len(delays):.0%})"


def _arl(played: Sequence[StreamResult]) -> str:
    """Rows watched over false alarms."""
    watched, alarms = sum(one.watched for one in played), sum(one.false_alarm for one in played)
    if not watched:
        return ""
    return digits(watched / alarms) if alarms else f"> {digits(watched)}"


def _drifts(result: ContextsResult) -> list[str]:
    return [one for one in result.setting.drifts if one != NULL]


def _error(score: Score) -> float | None:
    return score.error


def _rg(score: Score) -> float | None:
    return score.rg
