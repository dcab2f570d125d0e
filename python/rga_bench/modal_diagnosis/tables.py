"""The tables of a challenge with modes: figures, kinds, campaigns, and what failed."""

from collections import Counter
from collections.abc import Iterator, Sequence

from rga_bench.diagnosis.figures import FAINT, PLAIN, ChallengeFigure, rate
from rga_bench.modal_diagnosis.design import CAMPAIGNS, STRATA, NamedCampaign
from rga_bench.modal_diagnosis.judge import ModalOutcome
from rga_bench.swinging.campaign import Campaign
from rga_bench.swinging.hidden import OF_GAUGES, OF_MODES
from rga_bench.text_table import TextTable

#: d' from which an effect is large
LARGE = 20.0


def modal_tables(outcomes: Sequence[ModalOutcome]) -> list[TextTable]:
    """All tables of a challenge."""
    return [
        TextTable(
            "What was found",
            ("", "measured [%]", "90 % interval", "draws", "asked for [%]"),
            [_row(one) for one in modal_figures(outcomes)],
            numbers=True,
        ),
        TextTable(
            "By kind",
            ("hidden", "cause or rival", "told otherwise", "wrongly named", "within its 90 %"),
            list(_kinds(outcomes)),
            numbers=True,
        ),
        TextTable(
            "By campaign",
            ("campaign", "cause or rival", "null twins named", "null twins unsure", "mispaired"),
            list(_campaigns(outcomes)),
            numbers=True,
        ),
        TextTable(
            "What was not found or falsely named",
            ("draw", "hidden", "verdict", "named"),
            list(_failures(outcomes)),
        ),
    ]


def modal_figures(outcomes: Sequence[ModalOutcome]) -> list[ChallengeFigure]:
    """All figures of a challenge."""
    figures = []
    alone = [o for o in _hidden(outcomes, "modal") if _d_perp(o) is not None]
    for words, low, high, least in (
        (f"modes alone, found, d_perp {PLAIN:g} and more", PLAIN, 1e9, 0.97),
        (f"modes alone, found, d_perp {FAINT:g} to {PLAIN:g}", FAINT, PLAIN, None),
    ):
        several = [o for o in alone if low <= (_d_perp(o) or 0.0) < high]
        bounds = None if least is None else (least, 1.0)
        figures.append(rate(words, (o.found for o in several), bounds, bounds))
    beside = [o for o in _hidden(outcomes, "mixed") if _d_prime(o) >= LARGE]
    figures.append(
        rate(f"beside a record, found, d' {LARGE:g} and more", (o.found for o in beside))
    )
    figures += [
        rate(
            f"{_words(stratum)}, named wrongly",
            (_wrong(o) for o in _hidden(outcomes, stratum)),
            (0.0, 0.02), (0.0, 0.02),
        )
        for stratum in STRATA
    ]  # fmt: skip
    figures += [
        rate(
            f"{_words(stratum)}, a name on a null twin",
            (bool(o.named) for o in outcomes if o.draw.null and o.draw.stratum == stratum),
            (0.0, 0.02), (0.0, 0.02),
        )
        for stratum in STRATA
    ]  # fmt: skip
    plain = [o for o in outcomes if not _campaign(o).swapped]
    right, wrong = (sum(o.paired for o in plain), sum(o.mispaired for o in plain))
    untold = sum(o.mispaired for o in plain if not o.doubtful)
    figures.append(_share("entries paired rightly", right, right + wrong))
    figures.append(_share("or told to be in doubt", right + wrong - untold, right + wrong))
    figures.append(
        rate(
            "90 % intervals of parameters",
            (o.inside for o in outcomes if o.inside is not None),
            (0.85, 0.95), (0.85, 0.95),
        )
    )  # fmt: skip
    return figures


def _share(name: str, count: int, of: int) -> ChallengeFigure:
    """A share of entries, which are no draws of their own: without an interval."""
    value = count / of if of else None
    return ChallengeFigure(name, value, None, None, count, of, (0.99, 1.0), (0.99, 1.0))


def _row(one: ChallengeFigure) -> list[str]:
    if one.value is None:
        return [one.name, "none", "", "", _asked(one)]
    interval = ""
    if one.low is not None and one.high is not None:
        interval = f"{100 * one.low:.1f} to {100 * one.high:.1f}"
    return [one.name, f"{100 * one.value:.1f}", interval, f"{one.count} of {one.of}", _asked(one)]


def _asked(one: ChallengeFigure) -> str:
    if one.least is None:
        return ""
    low, high = (f"{100 * bound:g}" for bound in one.least)
    bounds = f">= {low}" if high == "100" else f"<= {high}" if low == "0" else f"{low} to {high}"
    return f"{bounds} {one.judged}".strip()


def _kinds(outcomes: Sequence[ModalOutcome]) -> Iterator[list[str]]:
    for stratum in STRATA:
        yield [_words(stratum)]
        for kind in (*OF_MODES, *OF_GAUGES):
            own = [o for o in _hidden(outcomes, stratum) if o.hidden and o.hidden["kind"] == kind]
            if own:
                told = [not o.found and not _wrong(o) for o in own]
                inside = [o.inside for o in own if o.inside is not None]
                columns = ([o.found for o in own], told, [_wrong(o) for o in own], inside)
                yield [kind, *map(_ratio, columns)]


def _campaigns(outcomes: Sequence[ModalOutcome]) -> Iterator[list[str]]:
    for one in CAMPAIGNS:
        own = [o for o in outcomes if o.campaign == one.name]
        if not own:
            continue
        nulls = [o for o in own if o.draw.null]
        entries = sum(o.paired + o.mispaired for o in own)
        yield [
            one.name,
            _ratio([o.found for o in own if not o.draw.null]),
            _ratio([bool(o.named) for o in nulls]),
            _ratio([not o.named and o.verdict in ("partial", "unknown") for o in nulls]),
            f"{sum(o.mispaired for o in own)} of {entries}",
        ]


def _failures(outcomes: Sequence[ModalOutcome]) -> Iterator[list[str]]:
    for o in outcomes:
        if o.draw.null and o.named:
            yield [o.id, "nothing", o.verdict, _named(o)]
        if o.hidden is not None and not o.found:
            perp = "" if _d_perp(o) is None else f", d_perp {_d_perp(o):.1f}"
            late = ", late" if o.hidden["onset"] is not None else ""
            hidden = (
                f"{o.hidden['kind']} {_place(o.hidden['place'])}, d' {_d_prime(o):.0f}{perp}{late}"
            )
            yield [f"{o.id}, {o.structure}", hidden, o.verdict, _named(o)]


def _named(one: ModalOutcome) -> str:
    words = [
        f"{cause['kind']} "
        + _place({k: v for k, v in cause.items() if k not in (
            "kind", "onset", "log_odds", "rivals", "hidden")})
        + f" ({cause['log_odds']:.0f}, {cause['rivals']} rivals)"
        for cause in one.named
    ]  # fmt: skip
    return "; ".join(words) or "nothing"


def _place(place: dict[str, object]) -> str:
    words = [
        f"{value[0]} and {len(value) - 1} more" if isinstance(value, list) and value else str(value)
        for value in place.values()
    ]
    return " ".join(words)


def _ratio(hits: Sequence[bool | None]) -> str:
    counts = Counter(bool(one) for one in hits)
    return f"{counts[True]} of {len(hits)}" if hits else "-"


def _wrong(one: ModalOutcome) -> bool:
    """Calmly wrong: named, and what is hidden is neither a cause nor a rival."""
    return one.verdict == "named" and bool(one.named) and not one.among


def _hidden(outcomes: Sequence[ModalOutcome], stratum: str) -> list[ModalOutcome]:
    return [o for o in outcomes if not o.draw.null and o.draw.stratum == stratum]


def _d_perp(one: ModalOutcome) -> float | None:
    return None if one.hidden is None else one.hidden["d_perp"]


def _d_prime(one: ModalOutcome) -> float:
    return 0.0 if one.hidden is None else float(one.hidden["d_prime"])


def _campaign(one: ModalOutcome) -> Campaign:
    named: NamedCampaign = one.draw.measured
    return named.campaign


def _words(stratum: str) -> str:
    return {"modal": "modes alone", "mixed": "beside a record"}[stratum]
