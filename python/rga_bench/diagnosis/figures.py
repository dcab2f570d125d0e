"""The figures of a challenge, each against its target."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.stats import binomtest, bootstrap

from rga_bench.diagnosis.design import NULLS
from rga_bench.diagnosis.field_design import FIELD_NULLS
from rga_bench.diagnosis.judge import DrawOutcome
from rga_bench.diagnosis.reference_fit import NORMAL_90

#: bounds of d_perp between which effects count alike; found above `PLAIN`, mostly above `FAINT`
FAINT, PLAIN = 5.0, 8.0
BINS = (FAINT, PLAIN, 15.0, 30.0, np.inf)
#: d' of each effect of a pair, of what is outside, and of an onset whose error counts
LARGE = 20.0
#: gain of the true model, in noise variances, of which a share says something
WORTH_SHARING = 0.02
#: draws below which a figure is not held against its bounds
FEW = 30
UNSURE = ("unknown", "partial")
#: the ways in which contexts can be known, by their name in an outcome
CONTEXTS = {
    "known": "contexts known",
    "measured": "contexts measured",
    "off": "contexts measured",
    "latent": "a context latent",
}
#: beginnings of the names of records, by the reality that they stand on
PINNED, WELDED = "pinned", "welded"
Bounds = tuple[float, float]


@dataclass(frozen=True)
class ChallengeFigure:
    """A figure with its 90 % interval, and the bounds within which it should lie.

    Attributes:
        name: what is measured.
        value: the figure; None where no draw bears on it.
        low, high: its interval, Wilson's for a rate.
        count: draws that count; `of` those that bear on it.
        least, aim: bounds required and aimed at; None: there are none.
    """

    name: str
    value: float | None
    low: float | None
    high: float | None
    count: int | None
    of: int
    least: Bounds | None = None
    aim: Bounds | None = None

    @property
    def judged(self) -> str:
        """Whether the figure lies within the bounds."""
        if self.value is None or self.least is None or self.aim is None:
            return ""
        if self.of < FEW:
            return "few draws"
        for bounds, word in ((self.aim, "aim"), (self.least, "met")):
            if bounds[0] <= self.value <= bounds[1]:
                return word
        return "missed"


def rate(
    name: str, hits: Iterable[bool], least: Bounds | None = None, aim: Bounds | None = None
) -> ChallengeFigure:
    """A share of draws, with Wilson's interval."""
    known = list(hits)
    if not known:
        return ChallengeFigure(name, None, None, None, 0, 0, least, aim)
    found = binomtest(sum(known), len(known)).proportion_ci(0.9, method="wilson")
    return ChallengeFigure(
        name, sum(known) / len(known), float(found.low), float(found.high), sum(known), len(known),
        least, aim,
    )  # fmt: skip


def middle(
    name: str, values: Sequence[float], least: Bounds, aim: Bounds, share: float | None = None
) -> ChallengeFigure:
    """A mean, or the quantile at a `share`, with a bootstrapped interval."""
    if not values:
        return ChallengeFigure(name, None, None, None, None, 0, least, aim)

    def taken(sample: np.ndarray, axis: int = -1) -> np.ndarray:
        if share is None:
            return np.asarray(sample.mean(axis=axis))
        return np.asarray(np.quantile(sample, share, axis=axis))

    value = float(taken(np.array(values)))
    low = high = value
    if np.ptp(values) > 0:
        found = bootstrap(
            (values,),
            taken,
            confidence_level=0.9,
            method="percentile",
            rng=np.random.default_rng(0),
        ).confidence_interval
        low, high = float(found.low), float(found.high)
    return ChallengeFigure(name, value, low, high, None, len(values), least, aim)


def figures(outcomes: Sequence[DrawOutcome]) -> list[ChallengeFigure]:
    """All figures of a challenge."""
    return [*_finding(outcomes), *_sureness(outcomes), *_gains(outcomes), *_onsets(outcomes)]


def of(outcomes: Sequence[DrawOutcome], stratum: str, null: bool = False) -> list[DrawOutcome]:
    """The outcomes of a stratum, or of its null twins."""
    return [o for o in outcomes if o.draw.stratum == stratum and o.draw.null == null]


def singles(outcomes: Sequence[DrawOutcome], low: float, high: float = np.inf) -> list[DrawOutcome]:
    """Single effects with d_perp from `low` to `high`."""
    return [o for o in of(outcomes, "single") if low <= o.hidden[0]["d_perp"] < high]


def knowledge(one: DrawOutcome) -> str:
    """How much of its surroundings a case knows: its contexts, and whether the model is right."""
    wrong = one.null == "frame" or one.null.startswith(WELDED)
    return "base error" if wrong else CONTEXTS[one.contexts]


def nulls_of(outcomes: Sequence[DrawOutcome]) -> list[str]:
    """Names of the null records that there are, in the order of their designs."""
    present = {o.null for o in outcomes}
    return [name for name in (*NULLS, *FIELD_NULLS) if name in present]


def _finding(outcomes: Sequence[DrawOutcome]) -> list[ChallengeFigure]:
    nulls = [o for o in outcomes if o.draw.null]
    pairs = [o for o in of(outcomes, "pair") if all(one["d_prime"] >= LARGE for one in o.hidden)]
    plain = [o for o in pairs if all(one["d_perp"] >= PLAIN for one in o.hidden)]
    return [
        rate(
            f"found, d_perp {PLAIN:g} and more",
            (o.found for o in singles(outcomes, PLAIN)),
            (0.97, 1.0), (0.99, 1.0),
        ),
        rate(
            f"found, d_perp {FAINT:g} to {PLAIN:g}",
            (o.found for o in singles(outcomes, FAINT, PLAIN)),
            (0.85, 1.0), (0.92, 1.0),
        ),
        rate(f"pair found, d' {LARGE:g} each", (o.found for o in pairs), (0.90, 1.0), (0.97, 1.0)),
        rate(f"  of these d_perp {PLAIN:g} each", (o.found for o in plain)),
        *(
            rate(
                f"a name on a null record: {null}",
                (bool(o.named) for o in nulls if o.null == null),
                (0.0, 0.02), (0.0, 0.005),
            )
            for null in nulls_of(outcomes)
        ),
        *(
            rate(
                f"  on all null records, {reality}",
                (bool(o.named) for o in nulls if o.null.startswith(reality)),
                (0.0, 0.02), (0.0, 0.005),
            )
            for reality in (PINNED, WELDED)
            if any(o.null.startswith(reality) for o in outcomes)
        ),
        rate(
            "a false name beside a single effect that was found",
            (not all(one["hidden"] for one in o.named) for o in of(outcomes, "single") if o.found),
        ),
    ]  # fmt: skip


def _sureness(outcomes: Sequence[DrawOutcome]) -> list[ChallengeFigure]:
    outside = [o for o in of(outcomes, "outside") if o.hidden[0]["d_prime"] >= LARGE]
    apart = [o for o in outside if o.hidden[0]["d_perp"] >= LARGE]
    inside = [*of(outcomes, "single"), *of(outcomes, "pair")]
    figures = []
    for several, which in ((outside, "d'"), (apart, "d_perp")):
        figures += [
            rate(
                f"outside, {which} {LARGE:g}: unknown or partial",
                (o.verdict in UNSURE for o in several),
                (0.90, 1.0), (0.97, 1.0),
            ),
            rate(
                f"outside, {which} {LARGE:g}: wrongly named",
                (o.verdict in ("named", "ambiguous") for o in several),
                (0.0, 0.04), (0.0, 0.01),
            ),
        ]  # fmt: skip
    figures += [
        rate(
            "unknown or partial, though the vocabulary has it",
            (o.verdict in UNSURE for o in inside),
            (0.0, 0.05), (0.0, 0.02),
        ),
        rate("unknown on a null record", (o.verdict in UNSURE for o in outcomes if o.draw.null)),
    ]  # fmt: skip
    broken = [o.broken_told for o in outcomes if o.broken_told is not None]
    if broken:
        figures.append(rate("a broken channel is a cause or a rival", broken))
    return figures + [
        rate(
            f"90 % intervals of parameters: {known}",
            (
                abs(off) <= NORMAL_90
                for o in inside
                if knowledge(o) == known
                for off in _deviations(o)
            ),
            (0.85, 0.95), (0.88, 0.92),
        )
        for known in (*dict.fromkeys(CONTEXTS.values()), "base error")
    ]  # fmt: skip


def _deviations(one: DrawOutcome) -> list[float]:
    return [off for by_parameter in one.deviations.values() for off in by_parameter.values()]


def share_gained(one: DrawOutcome) -> float | None:
    """Gain of what was found, in that of the true model, on unseen sensors and days, -1 to 1."""
    if one.gaps is None:
        return None
    possible = one.gaps["given"] - one.gaps["true"]
    if possible < WORTH_SHARING:
        return None
    return float(np.clip((one.gaps["given"] - one.gaps["found"]) / possible, -1.0, 1.0))


def _gains(outcomes: Sequence[DrawOutcome]) -> list[ChallengeFigure]:
    by_bin = [
        middle(
            f"share of the true gain, d_perp {low:g} to {high:g}",
            [
                share
                for o in singles(outcomes, low, high)
                if (share := share_gained(o)) is not None
            ],
            (0.95, 1.0), (0.99, 1.0),
        )
        for low, high in pairwise(BINS)
    ]  # fmt: skip
    return [
        *by_bin,
        rate(
            "90 % interval of the gain",
            (o.gain_covered for o in outcomes if o.gain_covered is not None),
            (0.85, 0.95), (0.88, 0.92),
        ),
        rate(
            "advice separates rivals when simulated",
            (separates for o in outcomes for separates in o.advice),
            (0.90, 1.0), (0.97, 1.0),
        ),
    ]  # fmt: skip


def _onsets(outcomes: Sequence[DrawOutcome]) -> list[ChallengeFigure]:
    late = [one for o in outcomes for one in o.onsets]
    large = [
        onset["error"]
        for o in outcomes
        for onset in o.onsets
        for one in o.hidden
        if one["kind"] == onset["kind"] and not onset["ramp"] and one["d_prime"] >= LARGE
    ]
    return [
        *(
            rate(
                f"onset within its 90 % interval: {word}",
                (one["inside"] for one in late if one["ramp"] == ramp),
                (0.85, 0.95), (0.88, 0.92),
            )
            for ramp, word in ((False, "a jump"), (True, "a ramp"))
        ),
        middle(f"onset, error at d' {LARGE:g}: median", large, (0.0, 0.05), (0.0, 0.02), 0.5),
        middle("  nine in ten within", large, (0.0, 0.05), (0.0, 0.02), 0.9),
    ]  # fmt: skip
