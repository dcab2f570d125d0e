"""Findings in plain words."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from rga.model import Effect
from rga.model.effects.sensors.sensor_fault import channel_words, is_fault
from rga.model.parameter import listed

if TYPE_CHECKING:
    from rga.findings.schema import Cause, Findings, HeldOut

#: rivals that a sentence names; it counts the others
RIVALS = 3


def effect_words(effect: Mapping[str, Any]) -> str:
    """An effect in words, with values and intervals.

    >>> factor = {"value": 1.25, "ci90": [1.2, 1.3]}
    >>> effect_words({"kind": "sensor_gain", "sensor": "S1", "factor": factor})
    'sensor gain of S1: factor 1.25 [1.2, 1.3]'
    >>> effect_words({"kind": "sensor_gain", "point": "A1", "factor": -1.0})
    'sensor gain at point A1: factor -1'
    """
    kind = Effect.vocabulary.get(effect["kind"], Effect)
    fields = {name: mark.of for name, mark in kind.place_fields().items() if effect.get(name)}
    place = place_words(effect[name] for name in fields)
    of = f" of {place}" if place else ""
    if set(fields.values()) == {"point"}:
        several = len(listed(effect[next(iter(fields))])) > 1
        of = f" at points {place}" if several else f" at point {place}"
    return f"{kind_words(effect['kind'])}{of}{kind.size_words(effect)}{_onset(effect)}"


def explanation_words(effects: Iterable[Mapping[str, Any]]) -> str:
    """Effects that act together in words: by these an explanation is known again.

    >>> gain = {"kind": "sensor_gain", "sensor": "S1", "factor": 1.2}
    >>> explanation_words([gain, {**gain, "sensor": "S2"}])
    'sensor gain of S1: factor 1.2 + sensor gain of S2: factor 1.2'
    >>> explanation_words([])
    'the model as it is'
    """
    return " + ".join(map(effect_words, effects)) or "the model as it is"


def kind_words(kind: str) -> str:
    """A kind in words, one that is not known too.

    >>> kind_words("sensor_gain"), kind_words("of_my_own")
    ('sensor gain', 'of my own')
    """
    known = Effect.vocabulary.get(kind)
    return known.title if known else kind.replace("_", " ")


def place_words(places: Iterable[Any]) -> str:
    """The parts of a place in words.

    >>> place_words(["east", "ux"])
    'east, ux'
    """
    return ", ".join(_place(place) for place in places)


def few_digits(value: float, digits: int = 2) -> str:
    """A number of so many digits, without a power of ten.

    >>> few_digits(932.4), few_digits(0.001), few_digits(1.26)
    ('930', '0.001', '1.3')
    """
    return f"{float(f'{value:.{digits}g}'):.15g}"


def verdict_sentence(findings: "Findings") -> str:
    """The verdict in a few sentences."""
    faults = [channel_words(c.effect) for c in findings.causes if is_fault(c.effect)]
    causes = [c for c in findings.causes if not is_fault(c.effect)]
    sentences = []
    if causes:
        sentences.append(f"What the model leaves out: {'; and '.join(map(_cause_words, causes))}.")
        held = findings.gap.held_out
        sentences.append(_gain_words(held))
    elif findings.verdict == "nothing_wrong":
        sentences.append("Nothing is wrong with the model that these data could show.")
        if near := not_ruled_out(findings):
            sentences.append(f"Not ruled out, and too little to be named: {'; or '.join(near)}.")
    elif undecided(findings):
        sentences.append(
            "Nothing speaks against the model, and these data cannot decide whether it is right."
        )
    elif findings.verdict == "unknown":
        sentences.append(
            "Something speaks against the model, and no kind of effect that is known explains it."
        )
    elif findings.verdict == "unidentifiable":
        sentences.append("What was sought cannot show in these data.")
    if faults:
        sentences.append(f"Channels that do not work: {', '.join(faults)}.")
    if findings.misfits and findings.verdict != "nothing_wrong":
        sentences.append(f"Channels that work and do not fit: {', '.join(findings.misfits)}.")
    if findings.verdict in ("partial", "unknown"):
        stays = "unexplained" if findings.unexplained.speaks_against else "in doubt"
        sentences.append(f"What stays {stays}: {findings.unexplained.looks_like}.")
    return " ".join(sentences)


def undecided(findings: "Findings") -> bool:
    """Whether no cause is known, and nothing speaks against the model either."""
    return findings.verdict == "unknown" and not findings.unexplained.speaks_against


def _gain_words(held: "HeldOut") -> str:
    """What readings that no step saw say of causes."""
    if held.gain == 0.0:
        return f"By readings that no step saw the gap stays {held.before:.3g} times the noise."
    low, high = held.gain_ci90
    moves = "falls" if held.gain > 0 else "rises"
    unsure = "" if low > 0 else "; so the gain is not sure"
    return (
        f"By readings that no step saw the gap {moves} from {held.before:.3g} to {held.after:.3g} "
        f"times the noise (gain {held.gain:.3g}, 90 % interval {low:.3g} to {high:.3g}{unsure})."
    )


def not_ruled_out(findings: "Findings") -> list[str]:
    """Where nothing is named, what comes so near that no effect at all is hardly likelier."""
    if findings.verdict != "nothing_wrong":
        return []
    least = -findings.criteria.rivals.log_odds
    near = [one for one in findings.explanations if one.effects and one.log_odds > least]
    return [one.words for one in near[:RIVALS]]


def _cause_words(cause: "Cause") -> str:
    """A cause in words, and what these data cannot separate it from."""
    likeliest = effect_words(cause.effect)
    if not cause.rivals:
        return likeliest
    others = [effect_words(rival) for rival in cause.rivals[:RIVALS]]
    if more := len(cause.rivals) + cause.rivals_omitted - len(others):
        others.append(f"one of {more} more")
    return f"either {likeliest}, or what these data cannot separate from it: {', or '.join(others)}"


def _onset(effect: Mapping[str, Any]) -> str:
    if effect.get("onset") is None:
        return ""
    begun = f"from {_moment(effect['onset'])} on"
    if effect.get("profile") != "ramp":
        return f", {begun}"
    full = "" if effect.get("end") is None else f" to {_moment(effect['end'])}"
    return f", growing {begun}{full}"


def _moment(onset: Any) -> str:
    return onset if isinstance(onset, str) else f"{onset:g} s"


def _place(place: Any) -> str:
    if isinstance(place, list | tuple) and all(isinstance(one, int | float) for one in place):
        return f"direction [{', '.join(f'{one:g}' for one in place)}]"
    if isinstance(place, list | tuple):
        if len(place) > 4 and all(isinstance(one, str) for one in place):
            return f"{place[0]} and {len(place) - 1} more"
        return " and ".join(str(one) for one in place)
    return str(place)
