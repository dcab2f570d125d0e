"""A broken record's diagnosis held against that of the same record when it was sound."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rga_bench.faults.judge import ERROR, FaultOutcome
from rga_bench.faults.trial import LEFT_OUT, SOUND

#: ratio of the gap to the one before above which it rises
RISING = 1.01
#: the channels that a misfit is compared with are not themselves reported
_LIKE = re.compile(r"its like \([^)]*\)")
#: gap on held-out rows above which "nothing is wrong" is no true word
NEAR_ONE = 2.0


@dataclass(frozen=True)
class Comparison:
    """What the faults of a record changed.

    Attributes:
        outcome: of the broken record.
        unmoved: the causes that are no sensor's are those of the sound record.
        kept: what is known to be hidden, and was found in the sound record, is found; None:
            there is no such thing.
        told: every broken channel is a cause of a sensor's kind, among the rivals of a cause, or
            in a warning that the sound record does not have.
        named: every broken channel is a cause of a sensor's kind, or among the rivals of a cause.
        calm: `nothing_wrong` or `named`, and that is wrong: with a broken channel unreported, with
            the gap rising on held-out rows, or with nothing wrong at a gap above 2.
        times: seconds over those of the sound record.
    """

    outcome: FaultOutcome
    unmoved: bool
    kept: bool | None
    told: bool
    named: bool
    calm: bool
    times: float


def comparisons(outcomes: Sequence[FaultOutcome]) -> list[Comparison]:
    """Of all broken records whose sound twin is there.

    Left out are records in which a channel broke that was broken before.
    """
    sound = {one.base: one for one in outcomes if one.way == SOUND}
    return [
        _compared(one, sound[one.base])
        for one in outcomes
        if one.way != SOUND
        and one.base in sound
        and sound[one.base].verdict != ERROR
        and not any(_is_cause(gone["sensor"], sound[one.base]) for gone in one.broken)
    ]


def _compared(one: FaultOutcome, sound: FaultOutcome) -> Comparison:
    healthy = one.verdict != ERROR
    known = [now for now, before in zip(one.found, sound.found, strict=True) if before]
    gone = [] if one.way == LEFT_OUT else [each["sensor"] for each in one.broken]
    reported = all(_reported(sensor, one, sound) for sensor in gone)
    return Comparison(
        outcome=one,
        unmoved=healthy and _alike(_others(one), _others(sound)),
        kept=all(known) if known else None,
        told=reported and healthy,
        named=healthy and all(_is_named(sensor, one) for sensor in gone),
        calm=_calm(one, reported),
        times=one.seconds / sound.seconds,
    )


def _others(one: FaultOutcome) -> list[dict[str, Any]]:
    """Causes that are no sensor's."""
    return [cause for cause in one.causes if not _sensors(cause)]


def _sensors(effect: dict[str, Any]) -> set[str]:
    """The sensors that an effect is about."""
    named: set[str] = set()
    for key in ("sensor", "sensors"):
        place = effect.get(key)
        if place is not None:
            named |= {place} if isinstance(place, str) else set(place)
    return named


def _alike(now: list[dict[str, Any]], before: list[dict[str, Any]]) -> bool:
    """Each cause has its own: the same kind and place, or one that is the other's rival."""
    left = list(before)
    for cause in now:
        same = next((one for one in left if _same(cause, one)), None)
        if same is None:
            return False
        left.remove(same)
    return not left


def _same(one: dict[str, Any], other: dict[str, Any]) -> bool:
    own, its = ({k: v for k, v in each.items() if k != "rivals"} for each in (one, other))
    return own == its or own in other["rivals"] or its in one["rivals"]


def _reported(sensor: str, one: FaultOutcome, sound: FaultOutcome) -> bool:
    if _is_named(sensor, one):
        return True
    name = re.compile(rf"(?<!\w){re.escape(sensor)}(?!\w)")
    fresh = [text for text in one.warnings if text not in sound.warnings]
    return any(name.search(_LIKE.sub("", text)) for text in fresh)


def _is_named(sensor: str, one: FaultOutcome) -> bool:
    return _is_cause(sensor, one) or any(
        sensor in _sensors(rival) for cause in one.causes for rival in cause["rivals"]
    )


def _is_cause(sensor: str, one: FaultOutcome) -> bool:
    return any(sensor in _sensors(cause) for cause in one.causes)


def _calm(one: FaultOutcome, reported: bool) -> bool:
    if one.verdict not in ("nothing_wrong", "named") or one.before is None or one.after is None:
        return False
    rising = one.verdict == "named" and one.after > RISING * one.before
    untrue = one.verdict == "nothing_wrong" and one.after > NEAR_ONE
    return not reported or rising or untrue
