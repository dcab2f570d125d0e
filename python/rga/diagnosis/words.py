"""Findings in plain words."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from rga.model import Effect

if TYPE_CHECKING:
    from rga.diagnosis.findings import Findings

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"))
#: units whose large values read better with a prefix
SCALED = ("N/m", "N m/rad", "N")


def effect_words(effect: Mapping[str, Any]) -> str:
    """An effect in words, with values and intervals.

    >>> factor = {"value": 1.25, "ci90": [1.2, 1.3]}
    >>> effect_words({"kind": "sensor_gain", "sensor": "S1", "factor": factor})
    'sensor gain of S1: factor 1.25 [1.2, 1.3]'
    """
    kind = Effect.vocabulary.get(effect["kind"])
    parameters = kind.parameters() if kind else {}
    places = list(kind.place_fields()) if kind else []
    place = ", ".join(_place(effect[name]) for name in places if effect.get(name) is not None)
    values = "; ".join(
        f"{name.replace('_', ' ')} {quantity(effect[name], mark.unit)}"
        for name, mark in parameters.items()
        if effect.get(name) is not None
    )
    mode = f" ({effect['mode']})" if "mode" in effect else ""
    onset = f", from {effect['onset']} on" if effect.get("onset") is not None else ""
    of = f" of {place}" if place else ""
    return (
        f"{effect['kind'].replace('_', ' ')}{of}{mode}" + (f": {values}" if values else "") + onset
    )


def quantity(value: Any, unit: str) -> str:
    """A value with its interval and unit, three digits."""
    if isinstance(value, Mapping) and "value" in value:
        low, high = value["ci90"]
        scale, prefix = _prefix(abs(value["value"]), unit)
        shown = f"{value['value'] / scale:.3g} [{low / scale:.3g}, {high / scale:.3g}]"
    elif isinstance(value, int | float):
        scale, prefix = _prefix(abs(value), unit)
        shown = f"{value / scale:.3g}"
    else:
        return str(value)
    return shown if unit in ("-", "unit", "") else f"{shown} {prefix}{unit}"


def verdict_sentence(findings: "Findings") -> str:
    """The verdict in one or two sentences."""
    causes = [cause for cause in findings.causes if cause.effect["kind"] != "sensor_fault"]
    faults = [cause for cause in findings.causes if cause.effect["kind"] == "sensor_fault"]
    named = " and ".join(effect_words(cause.effect) for cause in causes)
    held = findings.gap.held_out
    gained = (
        f" On rows that no step saw the gap falls from {held.before:.3g} to {held.after:.3g} times "
        f"the noise (gain {held.gain:.3g}, 90 % interval {held.gain_ci90[0]:.3g} to "
        f"{held.gain_ci90[1]:.3g})."
    )
    rejected = (
        f" Channels that do not work: {', '.join(str(f.effect['sensor']) for f in faults)}."
        if faults
        else ""
    )
    left = f" What stays unexplained: {findings.unexplained.looks_like}."
    if findings.verdict == "nothing_wrong":
        return "Nothing is wrong with the model that these data could show." + rejected
    if findings.verdict == "unknown":
        return (
            "The model is wrong, and no kind of effect that is known explains it." + left + rejected
        )
    if findings.verdict == "unidentifiable":
        return "What was asked cannot show in these data." + rejected
    if not causes:
        return rejected.strip() + (left if findings.verdict == "partial" else "")
    if findings.verdict == "ambiguous":
        rivals = [effect_words(rival) for cause in causes for rival in cause.rivals[:3]]
        return (
            f"The model is wrong: {named}; {', '.join(rivals)} would explain it as well."
            + gained
            + rejected
        )
    unsure = [cause for cause in causes if cause.status == "ambiguous"]
    also = (
        " These sensors cannot tell it from "
        + ", ".join(effect_words(rival) for cause in unsure for rival in cause.rivals[:2])
        + "."
        if unsure
        else ""
    )
    sentence = f"The model lacks {named}.{also}" + gained + rejected
    return sentence + (left if findings.verdict == "partial" else "")


def _place(place: Any) -> str:
    if isinstance(place, list | tuple):
        if len(place) > 4 and all(isinstance(one, str) for one in place):
            return f"{place[0]} and {len(place) - 1} more"
        return " and ".join(str(one) for one in place)
    return str(place)


def _prefix(size: float, unit: str) -> tuple[float, str]:
    if unit in SCALED:
        for scale, prefix in PREFIXES:
            if size >= scale:
                return scale, prefix
    return 1.0, ""
