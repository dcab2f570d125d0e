"""Tables of methods at level A: by gap, by manner of contexts, and by context."""

from collections.abc import Callable, Mapping

import numpy as np

from rga.inference.map.identifiability import BLIND, unseen_share
from rga.inference.networks.design_samples import design
from rga.model import read_model
from rga.simulation import Simulator
from rga_bench.contexts.floors import FLOORS, TRUE_CONTEXT
from rga_bench.contexts.result import ContextsResult
from rga_bench.contexts.rows import ORACLE
from rga_bench.contexts.score import Score
from rga_bench.contexts.tables.aggregate import Values, coverage, gap_text, mean, scores
from rga_bench.measurement import digits
from rga_bench.synthetic.bridges.full_case_study import full_case_study
from rga_bench.text_table import TextTable

#: rows from which follows what sensors see
LOOKED_AT = 512


def by_place(result: ContextsResult) -> list[TextTable]:
    """Error, share of what there is to gain, RG and coverage, by gap and manner of contexts."""
    setting = result.setting
    full, first = setting.gaps[-1], setting.manners[0]
    places = [(gap, first) for gap in setting.gaps]
    places += [(full, manner) for manner in setting.manners[1:]]
    names = [gap if manner == first else f"{gap}, {manner}" for gap, manner in places]

    def table(title: str, rows: tuple[str, ...], cell: Callable[[str, str, str], str]) -> TextTable:
        cells = [[row, *(cell(row, gap, manner) for gap, manner in places)] for row in rows]
        return TextTable(title, ["method", *names], [one for one in cells if any(one[1:])])

    def number(of: Callable[[Score], float | None], form: str) -> Callable[[str, str, str], str]:
        def cell(row: str, gap: str, manner: str) -> str:
            found = mean(scores(result.outcomes, row, gap, manner, of))
            return "" if found is None else found.text(form)

        return cell

    def error(row: str, gap: str, manner: str) -> Values:
        return scores(result.outcomes, row, gap, manner, lambda one: one.error)

    def share(row: str, gap: str, manner: str) -> str:
        own, floor = error(row, gap, manner), error(ORACLE, gap, manner)
        gained = {k: (1.0 - own[k]) / (1.0 - floor[k]) for k in own if k in floor}
        found = mean(gained)
        return "" if found is None else found.text(".2f")

    def gap_left(row: str, gap: str, manner: str) -> str:
        own, true = (
            mean(scores(result.outcomes, one, gap, manner, lambda one: one.rg))
            for one in (row, TRUE_CONTEXT)
        )
        return gap_text(row, own, true)

    methods = tuple(row for row in result.rows if row not in FLOORS)
    tables = [
        table("Error [-], level A", methods, number(lambda one: one.error, ".3f")),
        table(f"(1 - Error) / (1 - Error of “{ORACLE}”), level A", methods, share),
        table("RG [mm²], level A", result.rows, gap_left),
        table("Coverage of 90 % intervals, level A", methods, number(coverage, ".2f")),
    ]
    return [one for one in tables if one.rows]


def by_context(result: ContextsResult) -> TextTable:
    """Error and coverage of each context, under the full gap."""
    contexts = full_case_study()["context"]
    headings = [f"{name} [{variable['unit']}]" for name, variable in contexts.items()]
    rows = [["what noise leaves", *_seen()]]
    for row in result.rows:
        own = [
            one.score
            for one in result.outcomes
            if (one.row, one.gap, one.manner)
            == (row, result.setting.gaps[-1], result.setting.manners[0])
        ]
        errors = [one.errors for one in own if one.errors is not None]
        held = [one.coverage for one in own if one.coverage is not None]
        if errors:
            cells = [digits(one) for one in np.sqrt(np.mean(np.square(errors), axis=0))]
            if held:
                shares = np.mean(held, axis=0)
                cells = [f"{cell} ({part:.0%})" for cell, part in zip(cells, shares, strict=True)]
            rows.append([row, *cells])
    title = "Each context under the full gap: root mean square error (coverage of 90 % intervals)"
    return TextTable(title, ["method", *headings], rows)


def _seen() -> list[str]:
    """How far single rows leave each context open where the model is right, and how blind it is."""
    model = read_model(full_case_study(), "full case study")
    contexts = design(model, LOOKED_AT, latent=list(model.context), seed=0).contexts
    noise = np.array([sensor.noise for sensor in model.sensors.values()], dtype=float)
    left = unseen_share(Simulator(model), contexts, noise)
    ranges = np.array([variable.range for variable in model.context.values()])
    spread = np.sqrt(left) * np.ptp(ranges, axis=1) / np.sqrt(12.0)
    blind = [" not seen" if share > BLIND else "" for share in left]
    return [
        f"{digits(one)}, {share:.0%} of the prior{word}"
        for one, share, word in zip(spread.tolist(), left.tolist(), blind, strict=True)
    ]


def cost(result: ContextsResult) -> TextTable:
    """Seconds of learning and of inference."""
    times: Mapping[str, list[tuple[float, float]]] = {
        row: [
            (one.learning, one.inference)
            for one in result.outcomes
            if one.row == row and one.learning is not None and one.inference is not None
        ]
        for row in result.rows
    }
    rows = [
        [row, digits(learning), digits(1e3 * inference)]
        for row, several in times.items()
        if several
        for learning, inference in (np.median(several, axis=0).tolist(),)
    ]
    return TextTable("Cost, median", ["method", "to learn [s]", "to infer a row [ms]"], rows)
