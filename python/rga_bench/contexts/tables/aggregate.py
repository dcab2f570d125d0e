"""Outcomes of each row, split by split."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from rga_bench.contexts.floors import FLOORS
from rga_bench.contexts.score import Score
from rga_bench.contexts.setting import DRIFTING
from rga_bench.contexts.stream_results import StreamResult
from rga_bench.contexts.tables.spread import Mean
from rga_bench.contexts.task_run import TaskOutcome

#: a number of each split
Values = Mapping[int, float]
#: behind an RG that is less than what the true contexts leave
HIDES = " †"


def scores(
    outcomes: Sequence[TaskOutcome],
    row: str,
    gap: str,
    manner: str,
    of: Callable[[Score], float | None],
) -> Values:
    """A number of the scores of a row at level A, before any drift."""
    own = [one for one in outcomes if (one.row, one.gap, one.manner) == (row, gap, manner)]
    found = {one.split: of(one.score) for one in own}
    return {split: value for split, value in found.items() if value is not None}


def at_level(
    outcomes: Sequence[TaskOutcome], row: str, drifts: Sequence[str], level: str
) -> Mapping[int, list[StreamResult]]:
    """Results of a row at a level, by split; empty where it ran through none."""
    found = {
        one.split: [p for p in one.played if p.level == level and p.drift in drifts]
        for one in outcomes
        if one.row == row and one.manner == DRIFTING
    }
    return {split: played for split, played in found.items() if played}


def over_drifts(
    results: Mapping[int, Sequence[StreamResult]], of: Callable[[StreamResult], float | None]
) -> Values:
    """The mean over drifts of a number of the results."""
    found = {split: [of(one) for one in played] for split, played in results.items()}
    known = {split: [one for one in values if one is not None] for split, values in found.items()}
    return {split: float(np.mean(values)) for split, values in known.items() if values}


def mean(values: Values) -> Mean | None:
    """Over the splits; None without any."""
    return Mean.of(list(values.values())) if values else None


def paired(values: Values, than: Values) -> Mean | None:
    """The mean difference over the splits that both have."""
    return mean({split: values[split] - than[split] for split in values if split in than})


def whole(of: Callable[[Score], float | None]) -> Callable[[StreamResult], float | None]:
    """The mean of both halves of the test rows."""

    def mean_of_both(played: StreamResult) -> float | None:
        ordinary, drifted = of(played.ordinary), of(played.drifted)
        return None if ordinary is None or drifted is None else (ordinary + drifted) / 2.0

    return mean_of_both


def coverage(score: Score) -> float | None:
    """Share of the contexts that 90 % intervals hold."""
    return None if score.coverage is None else float(np.mean(score.coverage))


def gap_text(row: str, gap: Mean | None, true: Mean | None) -> str:
    """An RG in words, marked where a method leaves less than the true contexts do."""
    if gap is None:
        return ""
    hides = row not in FLOORS and true is not None and gap.value < true.value
    return gap.text(".3g") + (HIDES if hides else "")
