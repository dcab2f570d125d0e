"""The tables."""

from rga_bench.contexts.result import ContextsResult
from rga_bench.contexts.tables.level_tables import order, papers, published, worth
from rga_bench.contexts.tables.method_tables import by_context, by_place, cost
from rga_bench.contexts.tables.targets import targets
from rga_bench.page import MarkdownPage
from rga_bench.text_table import TextTable

NOTES = """\
Means over splits, and half of their 90 % intervals by Student's distribution; differences are
paired: both methods or levels meet the same bridge, rows and noise.

Error: mean over contexts of the mean squared error over that of an even distribution over the
range (range² / 12), so that the middle of the ranges has an Error of 1 on contexts spread evenly.
RG: mean squared gap over rows and sensors.

Tables of levels are played by the loop of `rga run` with its default settings, but for diagnoses,
which are left out: an answer would bring another model. Level A calibrates once, B recalibrates
after alarms, C also stores novel contexts, keeps what was learned under each of the conditions that
there were, and takes it up again where these recur. A twin gets the rows of a calibration, a stream
into which the drift comes, as many rows under the drift as under usual conditions behind it, and
last these; scores are of the latter two halves, as the twin inferred them at the time.

AD: rows from a change to its alarm, both counted, over the changes that were seen, whose share
stands beside it. ARL: rows watched under usual conditions over false alarms, at all drifts
together. A delay means nothing without it.

†: less than what the true contexts leave; the method hides in the contexts what the model gets
wrong. Floors: the noise alone; the model at the true contexts; the model at the contexts that
leave the least gap."""


def page(result: ContextsResult, command: str) -> MarkdownPage:
    """All tables, and what they mean."""
    figures = {"methods.png": "methods"}
    if any(one.played for one in result.outcomes):
        figures["levels.png"] = "levels"
    return MarkdownPage(
        "loi.md",
        "Levels of integration, with every rival beside them",
        f"`{command}`",
        _about(result),
        [order(result), *_tables(result), NOTES],
        figures,
    )


def _about(result: ContextsResult) -> list[str]:
    """Where it was measured, how much, and what was left out."""
    place, setting, sizes = result.machine, result.setting, result.setting.sizes
    named = [f"{name} {number}" for name, number in result.versions.items() if number]
    few = min(setting.few, setting.splits)
    lines = [
        f"{place['processor']}, {place['cores']} cores, {place['system']}",
        ", ".join(named),
        f"seed {setting.seed}; splits of full gap and drifts {setting.splits}, of others {few}",
        f"rows simulated {sizes.source}, unlabelled {sizes.unlabelled}, of a stream {sizes.stream}",
        f"rows of a test {sizes.test}",
    ]
    for name, packages in result.absent.items():
        lines.append(f"{name} is left out: {', '.join(packages)} not installed")
    return lines


def _tables(result: ContextsResult) -> list[TextTable]:
    """All tables."""
    levels = [one for one in papers(result) if one.rows]
    if levels:
        levels.insert(1, published())
    found = [*worth(result), *by_place(result), by_context(result), targets(result), cost(result)]
    return [*levels, *(one for one in found if one.rows)]
