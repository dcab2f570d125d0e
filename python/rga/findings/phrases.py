"""Findings in plain words."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from rga.model import Effect

if TYPE_CHECKING:
    from rga.findings.schema import Cause, Findings

PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"))
#: units whose large values read better with a prefix
SCALED = ("N/m", "N m/rad", "N")
RIVALS = 3


def effect_words(effect: Mapping[str, Any]) -> str:
    """An effect in words, with values and intervals.

    >>> factor = {"value": 1.25, "ci90": [1.2, 1.3]}
    >>> effect_words({"kind": "sensor_gain", "sensor": "S1", "factor": factor})
    'sensor gain of S1: factor 1.25 [1.2, 1.3]'
    """
    kind = Effect.vocabulary.get(effect["kind"])
    places = list(kind.place_fields()) if kind else []
    place = place_words(effect[name] for name in places if effect.get(name) is not None)
    values = "; ".join(
        f"{name.replace('_', ' ')} {quantity(effect[name], kind.unit(name, effect))}"
        for name in (kind.parameters() if kind else ())
        if kind and effect.get(name) is not None
    )
    mode = f" ({effect['mode']})" if "mode" in effect else ""
    of = f" of {place}" if place else ""
    return (
        f"{effect['kind'].replace('_', ' ')}{of}{mode}"
        + (f": {values}" if values else "")
        + _onset(effect)
    )


def place_words(places: Iterable[Any]) -> str:
    """The parts of a place in words.

    >>> place_words(["east", "ux"])
    'east, ux'
    """
    return ", ".join(_place(place) for place in places)


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
    if unit in ("-", "unit", ""):
        return shown
    # That of a sensor's effect is counted in the sensor's own unit.
    return f"{shown} {prefix}{unit.replace('unit/', 'per ')}"


def verdict_sentence(findings: "Findings") -> str:
    """The verdict in a few sentences."""
    faults = [c.effect["sensor"] for c in findings.causes if c.effect["kind"] == "sensor_fault"]
    causes = [c for c in findings.causes if c.effect["kind"] != "sensor_fault"]
    told = []
    if causes:
        told.append(f"What the model leaves out: {'; and '.join(map(_cause_words, causes))}.")
        held = findings.gap.held_out
        low, high = held.gain_ci90
        moves = "falls" if held.gain > 0 else "rises"
        doubt = "" if low > 0 else "; so the gain is not sure"
        told.append(
            f"By readings that no step saw the gap {moves} from {held.before:.3g} to "
            f"{held.after:.3g} times the noise (gain {held.gain:.3g}, 90 % interval {low:.3g} to "
            f"{high:.3g}{doubt})."
        )
    elif findings.verdict == "nothing_wrong":
        told.append("Nothing is wrong with the model that these data could show.")
    elif findings.verdict == "unknown":
        told.append("The model is wrong, and no kind of effect that is known explains it.")
    elif findings.verdict == "unidentifiable":
        told.append("What was asked cannot show in these data.")
    if faults:
        told.append(f"Channels that do not work: {', '.join(map(str, faults))}.")
    if findings.misfits and findings.verdict != "nothing_wrong":
        told.append(f"Channels that work and do not fit: {', '.join(findings.misfits)}.")
    if findings.verdict in ("partial", "unknown"):
        told.append(f"What stays unexplained: {findings.unexplained.looks_like}.")
    return " ".join(told)


def _cause_words(cause: "Cause") -> str:
    """A cause in words, and what these data cannot tell it from."""
    likeliest = effect_words(cause.effect)
    if not cause.rivals:
        return likeliest
    others = [effect_words(rival) for rival in cause.rivals[:RIVALS]]
    if more := len(cause.rivals) + cause.rivals_omitted - len(others):
        others.append(f"one of {more} more")
    return f"either {likeliest}, or what these data cannot tell from it: {', or '.join(others)}"


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


def _prefix(size: float, unit: str) -> tuple[float, str]:
    if unit in SCALED:
        for scale, prefix in PREFIXES:
            if size >= scale:
                return scale, prefix
    return 1.0, ""
