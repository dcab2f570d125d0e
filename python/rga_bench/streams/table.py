"""What became of twins on streams, as tables."""

from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np
from scipy.stats import binomtest, bootstrap

from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage
from rga_bench.streams.setting import SORTS
from rga_bench.streams.twin_run import StreamOutcome
from rga_bench.text_table import TextTable

#: rows within which a change is to be named
SOON = 60
CONTEXTS = (
    "inference", "streams", "chosen", "Error", "in 90 % intervals", "gap / noise", "seconds",
)  # fmt: skip
CHANGES = (
    "inference", "streams", "alarm after [rows]", "named after [rows]", f"named within {SOON}",
    "never named", "false versions", "false at the end", "verdicts",
)  # fmt: skip
NOTES = """\
Every twin is played by `rga run` with settings that nobody has touched, but for `inference`. Error
is the squared error of the contexts that nothing measures over that of a guess in the middle of
their ranges, on the rows after the calibration, as the twin inferred them at the time, with its
90 % interval over streams. The gap is that of the middle row, over the variance of the noise. Rows
are counted from a change to its alarm, and to the version of the model that names it, kind and
place; the middle stream is given, and in brackets the tenth and the ninetieth percent of those that
were named. A version is false where it has a cause that is none; so is a cause at the end. The
stiff joints of the frame are true, and count as neither."""


def page(played: Sequence[StreamOutcome], command: str) -> MarkdownPage:
    """The tables, and what they mean."""
    place = machine()
    named = [f"{name} {number}" for name, number in versions().items() if number]
    about = [
        f"{place['processor']}, {place['cores']} cores, {place['system']}",
        ", ".join(named),
        f"{len(played)} streams",
    ]
    parts: list[TextTable | str] = [
        NOTES,
        TextTable("Contexts", CONTEXTS, _rows(played, _contexts), numbers=True),
        TextTable("Changes", CHANGES, _rows(played, _changes), numbers=True),
    ]
    return MarkdownPage(
        "streams.md", "The twin as it is shipped, on streams", f"`{command}`", about, parts
    )


def _rows(
    played: Sequence[StreamOutcome], cells: Callable[[Sequence[StreamOutcome]], list[str]]
) -> list[list[str]]:
    order = list(SORTS)
    ordered = sorted(played, key=lambda one: (order.index(one.sort), one.inference))
    rows: list[list[str]] = []
    for sort, of_sort in groupby(ordered, lambda one: one.sort):
        rows.append([f"{sort}: {SORTS[sort]}"])
        for inference, own in groupby(of_sort, lambda one: one.inference):
            rows.append([inference, *cells(list(own))])
    return rows


def _contexts(played: Sequence[StreamOutcome]) -> list[str]:
    chosen = sorted({one.chosen for one in played})
    counts = [f"{name} {sum(one.chosen == name for one in played)}" for name in chosen]
    return [
        str(len(played)),
        ", ".join(counts),
        _mean([one.error for one in played], ".3f"),
        _mean([one.covered for one in played], ".0%"),
        _mean([one.gap for one in played], ".2f"),
        f"{np.median([one.seconds for one in played]):.0f}",
    ]


def _changes(played: Sequence[StreamOutcome]) -> list[str]:
    changed = played[0].sort in ("structure", "gauge")
    named = [one.named for one in played if one.named is not None]
    verdicts = sorted({one.verdict for one in played})
    soon = sum(rows <= SOON for rows in named)
    return [
        str(len(played)),
        _middle([one.delay for one in played if one.delay is not None]) if changed else "",
        _middle(named) if changed else "",
        _share(soon, len(played)) if changed else "",
        str(len(played) - len(named)) if changed else "",
        _share(sum(one.false_versions > 0 for one in played), len(played)),
        _share(sum(one.false_causes > 0 for one in played), len(played)),
        ", ".join(f"{one} {sum(p.verdict == one for p in played)}" for one in verdicts),
    ]


def _mean(values: Sequence[float], form: str) -> str:
    if len(values) < 2 or np.ptp(values) == 0:
        return format(values[0], form)
    found = bootstrap(
        (values,), np.mean, confidence_level=0.9, method="percentile", rng=np.random.default_rng(0)
    ).confidence_interval
    return f"{np.mean(values):{form}} ({found.low:{form}} to {found.high:{form}})"


def _middle(values: Sequence[int]) -> str:
    if not values:
        return "-"
    low, middle, high = np.quantile(values, [0.1, 0.5, 0.9])
    return f"{middle:.0f} ({low:.0f} to {high:.0f})"


def _share(hits: int, of: int) -> str:
    found = binomtest(hits, of).proportion_ci(0.9, method="wilson")
    return f"{hits} of {of} ({found.low:.0%} to {found.high:.0%})"
