"""Targets of the table, and what was found."""

from collections.abc import Callable

from rga_bench.contexts.floors import FLOORS
from rga_bench.contexts.result import ContextsResult
from rga_bench.contexts.rows import METHODS, ORACLE, PAPERS
from rga_bench.contexts.score import Score
from rga_bench.contexts.setting import LEVELS
from rga_bench.contexts.stream_results import StreamResult
from rga_bench.contexts.tables.aggregate import (
    Values,
    at_level,
    coverage,
    mean,
    over_drifts,
    scores,
    whole,
)
from rga_bench.contexts.tables.level_tables import NULL, RECURRING
from rga_bench.text_table import TextTable

#: share of what there is to gain, and coverage, by load tests: at least, and the aim
TARGETS = {
    0: ("0.71; 0.79", "0.80; 0.88 to 0.92"),
    20: ("0.80; 0.91", "0.85; 0.88 to 0.92"),
}


def targets(result: ContextsResult) -> TextTable:
    """Figures under the full gap, those of methods of the best one of its sort.

    The best is that of the least Error at level A, on the very rows that it is judged by.
    """
    rows = []
    for load_tests, (share, held) in TARGETS.items():
        best = _best(result, load_tests)
        if best is None:
            continue
        gained = {
            split: (1.0 - own) / (1.0 - floor)
            for split, own in _first(result, best, _error).items()
            for floor in (_first(result, ORACLE, _error).get(split),)
            if floor is not None
        }
        name = f"{best}, {load_tests or 'no'} load tests"
        rows.append([f"(1 - Error) / (1 - floor): {name}", _text(gained, ".2f"), share])
        covered = _text(_first(result, best, coverage), ".2f")
        rows.append([f"coverage of 90 % intervals: {name}", covered, held])
        if not load_tests:
            rows += _levels(result, best)
    physics, plain = (
        _first(result, PAPERS[one], lambda score: score.rg)
        for one in ("with physics", "without physics")
    )
    found = _text(_change(physics, plain), "+.1%")
    rows.append(["RG with physics against without, level A", found, "-42 %; -80 %"])
    return TextTable("Targets", ["figure", "found", "at least; aim"], [r for r in rows if r[1]])


def _levels(result: ContextsResult, row: str) -> list[list[str]]:
    """What recalibration is worth to a method."""
    once = [one for one in result.setting.drifts if one not in (NULL, RECURRING)]

    def of(drifts: list[str], level: str, number: Callable[[StreamResult], float | None]) -> Values:
        return over_drifts(at_level(result.outcomes, row, drifts, level), number)

    a, b, c = LEVELS
    them = ", ".join(once)
    figures = [
        (f"Error on drifted rows ({them}), B against A", once, b, a, _drifted, "-20 %; -30 %"),
        (f"Error on ordinary rows ({them}), B against A", once, b, a, _ordinary, "no loss"),
        ("Error on recurrence, C against B", [RECURRING], c, b, whole(_error), "less"),
        (f"Error on drifted rows ({them}), C against B", once, c, b, _drifted, ""),
        ("RG on recurrence, C against B", [RECURRING], c, b, whole(_rg), ""),
        ("recalibrations on recurrence, C against B", [RECURRING], c, b, _learned, "; -50 %"),
    ]
    return [
        [
            f"{name}: {row}",
            _text(_change(of(drifts, now, number), of(drifts, then, number)), "+.1%"),
            wanted,
        ]
        for name, drifts, now, then, number, wanted in figures
    ]


def _best(result: ContextsResult, load_tests: int) -> str | None:
    errors = {
        row: found.value
        for row in result.rows
        if row not in FLOORS
        and not METHODS[row].oracle
        and METHODS[row].load_tests == load_tests
        and (found := mean(_first(result, row, _error))) is not None
    }
    return min(errors, key=lambda row: errors[row], default=None)


def _first(result: ContextsResult, row: str, of: Callable[[Score], float | None]) -> Values:
    """A number of a row at level A, under the full gap and the first manner of contexts."""
    return scores(result.outcomes, row, result.setting.gaps[-1], result.setting.manners[0], of)


def _change(values: Values, than: Values) -> Values:
    """Relative differences of the splits that both have."""
    return {k: one / than[k] - 1.0 for k, one in values.items() if than.get(k)}


def _text(values: Values, form: str) -> str:
    found = mean(values)
    return "" if found is None else found.text(form)


def _error(score: Score) -> float | None:
    return score.error


def _rg(score: Score) -> float:
    return score.rg


def _drifted(played: StreamResult) -> float | None:
    return played.drifted.error


def _ordinary(played: StreamResult) -> float | None:
    return played.ordinary.error


def _learned(played: StreamResult) -> float:
    return played.recalibrations
