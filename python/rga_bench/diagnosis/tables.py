"""The tables of a challenge in plain text: figures, kinds, confusion, failures."""

from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np

from rga_bench.diagnosis.design import SINGLES
from rga_bench.diagnosis.figures import (
    FAINT,
    LARGE,
    PLAIN,
    UNSURE,
    Bounds,
    ChallengeFigure,
    figures,
    of,
    share_gained,
    singles,
)
from rga_bench.diagnosis.judge import DrawOutcome
from rga_bench.diagnosis.reference_fit import NORMAL_90
from rga_bench.field import INSIDE

#: standard deviations beyond which an estimate is listed as a failure
FAR = 4.0
#: of either generator, that the vocabulary has
KINDS = tuple(dict.fromkeys((*SINGLES, *INSIDE)))


def tables(outcomes: Sequence[DrawOutcome]) -> str:
    """All tables of a challenge."""
    middle, slow = np.quantile([o.seconds for o in outcomes], [0.5, 0.95])
    parts = [
        f"{len(outcomes)} diagnoses, {middle:.1f} s each (median), {slow:.1f} s at the 95 %\n",
        *_figures(figures(outcomes)),
        "\nsingle effects by kind",
        *_kinds(outcomes),
        "\nwhat single effects were named (d_perp 5 and more)",
        *_confusion(outcomes),
        "\nwhat stands outside the vocabulary, by kind",
        *_outside(outcomes),
        "\nby structure",
        *_structures(outcomes),
        "\nfailures; `rga benchmark diagnosis --case ID -o DIR` draws and writes a case",
        *failures(outcomes),
    ]
    return "\n".join(parts) + "\n"


def _figures(several: Sequence[ChallengeFigure]) -> Iterator[str]:
    yield f"{'':50} {'measured':>8} {'90 % interval':>15} {'draws':>11} {'least':>10} {'aim':>10}"
    for one in several:
        bounds = f"{_bounds(one.least):>10} {_bounds(one.aim):>10}  {one.judged}"
        if one.value is None:
            yield f"{one.name:50} {'none':>8} {'':15} {'':11} {bounds}".rstrip()
            continue
        interval = f"{_percent(one.low)} to {_percent(one.high)}"
        count = str(one.of) if one.count is None else f"{one.count} of {one.of}"
        line = f"{one.name:50} {_percent(one.value):>8} {interval:>15} {count:>11} {bounds}"
        yield line.rstrip()


def _percent(value: float | None) -> str:
    return "" if value is None else f"{100 * value:.1f}"


def _bounds(bounds: Bounds | None) -> str:
    if bounds is None:
        return ""
    low, high = (f"{100 * one:g}" for one in bounds)
    return (
        f">= {low}" if bounds[1] == 1.0 else f"<= {high}" if bounds[0] == 0.0 else f"{low}..{high}"
    )


def _kinds(outcomes: Sequence[DrawOutcome]) -> Iterator[str]:
    head = (f"d_perp {PLAIN:g}+", f"{FAINT:g} to {PLAIN:g}", "below", "intervals", "gain", "unsure")
    yield f"{'':22}" + "".join(f"{word:>12}" for word in head)
    bins = ((PLAIN, np.inf), (FAINT, PLAIN), (0.0, FAINT))
    for kind in KINDS:
        own = [o for o in of(outcomes, "single") if o.hidden[0]["kind"] == kind]
        if not own:
            continue
        found = [
            _ratio([o.found for o in singles(outcomes, *limits) if o.hidden[0]["kind"] == kind])
            for limits in bins
        ]
        off = [x for o in own for x in o.deviations.get(kind, {}).values()]
        shares = [share for o in own if (share := share_gained(o)) is not None]
        cells = [
            *found,
            _ratio([abs(x) <= NORMAL_90 for x in off]),
            f"{np.mean(shares):.2f}" if shares else "-",
            _ratio([o.verdict in UNSURE for o in own]),
        ]
        yield f"{kind:22}" + "".join(f"{cell:>12}" for cell in cells)


def _ratio(hits: Sequence[bool]) -> str:
    return f"{sum(hits)} of {len(hits)}" if hits else "-"


def named_as(one: DrawOutcome) -> str:
    """What a hidden effect was named: its kind, another, or nothing."""
    hidden = one.hidden[0]
    if hidden["cause"] is not None:
        return str(hidden["kind"])
    if hidden["found"]:
        return "among the rivals"
    if one.named:
        kind = str(one.named[0]["kind"])
        return f"{kind} elsewhere" if kind == hidden["kind"] else kind
    return "unknown" if one.verdict in UNSURE else "nothing"


def _confusion(outcomes: Sequence[DrawOutcome]) -> Iterator[str]:
    for kind in KINDS:
        own = [o for o in singles(outcomes, FAINT) if o.hidden[0]["kind"] == kind]
        named = Counter(named_as(o) for o in own)
        others = [f"{name} {many}" for name, many in named.most_common() if name != kind]
        if own:
            yield f"{kind:22} {named[kind]:3} of {len(own):<4} {', '.join(others)}".rstrip()


def _outside(outcomes: Sequence[DrawOutcome]) -> Iterator[str]:
    several = [o for o in of(outcomes, "outside") if o.hidden[0]["d_prime"] >= LARGE]
    for kind in dict.fromkeys(o.hidden[0]["kind"] for o in several):
        verdicts = Counter(o.verdict for o in several if o.hidden[0]["kind"] == kind)
        yield f"{kind:22} " + ", ".join(f"{word} {many}" for word, many in verdicts.most_common())


def _structures(outcomes: Sequence[DrawOutcome]) -> Iterator[str]:
    yield f"{'':22}" + "".join(f"{word:>20}" for word in (f"d_perp {PLAIN:g}+", "null, named"))
    for name in dict.fromkeys(o.bridge for o in outcomes):
        own = [o for o in outcomes if o.bridge == name]
        found = _ratio([o.found for o in singles(own, PLAIN)])
        named = _ratio([bool(o.named) for o in own if o.draw.null])
        yield f"{name:22}{found:>20}{named:>20}"


def failures(outcomes: Sequence[DrawOutcome]) -> Iterator[str]:
    """A line for every failure, those of a sort together."""
    lines = [(why, o) for o in outcomes if (why := _failure(o))]
    for why in dict.fromkeys(sorted(why for why, _ in lines)):
        several = [o for other, o in lines if other == why]
        yield f"{why}: {len(several)}"
        yield from (f"  {_line(o)}" for o in several)


def _failure(one: DrawOutcome) -> str:
    if one.draw.null:
        return f"named on a null record, {one.null}" if one.named else ""
    if one.draw.stratum == "outside":
        large = one.hidden[0]["d_prime"] >= LARGE
        return (
            f"outside the vocabulary, reported as {one.verdict}"
            if (large and one.verdict not in UNSURE)
            else ""
        )
    least = FAINT if one.draw.stratum == "single" else LARGE
    size = "d_perp" if one.draw.stratum == "single" else "d_prime"
    if not one.found and all(hidden[size] >= least for hidden in one.hidden):
        return f"{one.draw.stratum} not found"
    if any(abs(x) > FAR for found in one.deviations.values() for x in found.values()):
        return f"truth more than {FAR:g} standard deviations off"
    if one.found and not all(cause["hidden"] for cause in one.named):
        return "a false name beside what was found"
    return "unknown or partial, though the vocabulary has it" if one.verdict in UNSURE else ""


def _line(one: DrawOutcome) -> str:
    hidden = "; ".join(
        f"{h['kind']} {_place(h['place'])}d' {h['d_prime']:.0f}, d_perp {h['d_perp']:.1f}"
        + (f" beside {h['nearest']['kind']}" if h["nearest"] else "")
        + (", late" if h["onset"] is not None else "")
        + (", ramp" if h["end"] is not None else "")
        for h in one.hidden
    )
    named = "; ".join(
        f"{cause['kind']} {_place(cause)}({cause['log_odds']:.0f}, {len(cause['rivals'])} rivals)"
        for cause in one.named
    )
    off = ", ".join(
        f"{name} {x:+.1f} sd"
        for found in one.deviations.values()
        for name, x in found.items()
        if abs(x) > FAR
    )
    under = f"{one.bridge}, {one.null}, {one.contexts}"
    return f"{one.id} ({under}): {hidden or 'nothing'} -> {one.verdict}: {named or 'nothing'} {off}"


def _place(effect: dict[str, object]) -> str:
    apart = ("kind", "hidden", "onset", "log_odds", "d_perp", "rivals", "mode", "dof")
    words = [
        "+".join(map(str, value)) if isinstance(value, list | tuple) else str(value)
        for key, value in effect.items()
        if key not in apart and value is not None
    ]
    return " ".join(words) + " " if words else ""
