"""What the page says of a cause: its place, its values, how sure it is and what rivals it."""

from dataclasses import dataclass
from typing import Any

from rga.findings.phrases import kind_words
from rga.findings.schema import Cause
from rga.model.effect import Effect
from rga.model.schema import Model
from rga.quantities import DASH, number, quantity, short
from rga.report.drawing.places import place_names

#: keys of an effect that are neither place nor parameter
OTHER = {"kind", "onset", "end", "profile"}
D_PRIME = "d\N{PRIME}"
LOG_ODDS = (
    "natural logarithm of how much better the data are explained with this cause than without it, "
    "all places and kinds tried counted; 4.6 is a hundred to one"
)
SIZE = (
    "size of the effect in units of all that could look like it by chance: noise, errors of the "
    "measured contexts, scatter of the members; below 3 it cannot be distinguished from chance"
)
APART = (
    f"what is left of {D_PRIME} once all that the nearest rival can imitate is taken off; where it "
    "is small, these sensors cannot separate the two"
)


@dataclass(frozen=True)
class Card:
    """A cause in words.

    Attributes:
        title: kind of the effect; values: name, value with its unit and interval.
        facts: name, value, what the name means.
    """

    title: str
    words: str
    status: str
    place: str
    values: list[tuple[str, str]]
    onset: str
    facts: list[tuple[str, str, str]]
    why: str
    rivals: list[str]
    rivals_omitted: int
    separated_by: str


def card(cause: Cause, model: Model, words: str, rivals: list[str]) -> Card:
    """The card of a cause, given its words and those of its rivals."""
    effect = cause.effect
    return Card(
        title=kind_words(str(effect.get("kind", "cause"))),
        words=words,
        status=cause.status,
        place=place(effect),
        values=values(effect, model),
        onset=onset(cause),
        facts=[
            ("log-odds", number(cause.log_odds), LOG_ODDS),
            (D_PRIME, number(cause.d_prime), SIZE),
            ("d_perp", number(cause.d_perp), APART),
        ],
        why=cause.why,
        rivals=rivals,
        rivals_omitted=cause.rivals_omitted,
        separated_by=cause.separated_by,
    )


def plain(key: str) -> str:
    """A key as words.

    >>> plain("support_spring")
    'support spring'
    """
    return key.replace("_", " ")


def place(effect: dict[str, Any]) -> str:
    """The place of an effect in words."""
    found: dict[str, list[str]] = {}
    for of, name in place_names(effect):
        found.setdefault(of, []).append(name)
    return "; ".join(f"{plain(of)} {', '.join(names)}" for of, names in found.items())


def values(effect: dict[str, Any], model: Model) -> list[tuple[str, str]]:
    """Parameters of an effect with their units and intervals."""
    kind = Effect.vocabulary.get(str(effect.get("kind")))
    units = {name: kind.unit(name, effect) for name in kind.parameters()} if kind else {}
    known = set(kind.place_fields()) if kind else set()
    found = []
    for key, value in effect.items():
        if key in OTHER | known or value is None or (kind and key not in units):
            continue
        unit = own_unit(units.get(key, "-"), effect, model)
        if isinstance(value, dict) and "value" in value:
            found.append((plain(key), quantity(value["value"], unit, value.get("ci90"))))
        elif isinstance(value, int | float) and not isinstance(value, bool):
            found.append((plain(key), quantity(float(value), unit)))
        else:
            found.append((plain(key), generic(value)))
    return found


def own_unit(unit: str, effect: dict[str, Any], model: Model) -> str:
    """The unit with the word `unit` replaced by that of the sensor or context in question."""
    sensor = model.sensors.get(str(effect.get("sensor")))
    context = model.context.get(str(effect.get("context")))
    own = sensor.unit if sensor else context.unit if context else None
    return unit.replace("unit", own) if own else unit


def onset(cause: Cause) -> str:
    """When the cause begins, as the record writes time."""
    if cause.onset is None:
        return "throughout the record"
    grows = ""
    if cause.effect.get("profile") == "ramp":
        end = cause.effect.get("end")
        grows = ", growing to " + ("the last row" if end is None else moment(end))
    said = f"from {moment(cause.onset)}{grows}"
    if cause.onset_ci90 is not None and cause.onset_ci90[0] != cause.onset_ci90[1]:
        first, last = cause.onset_ci90
        said += f" (90\u00a0% interval {moment(first)} to {moment(last)})"
    return said


def moment(time: float | str) -> str:
    """A time as the record writes it."""
    return time.replace("T", " ") if isinstance(time, str) else f"{short(time, 6)}\u00a0s"


def generic(value: Any, unit: str = "-") -> str:
    """Any value of a findings file in words."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, int | float):
        return quantity(float(value), unit)
    if isinstance(value, dict):
        if "value" in value and isinstance(value["value"], int | float):
            return quantity(float(value["value"]), unit, value.get("ci90"))
        return "; ".join(f"{plain(str(key))} {generic(one, unit)}" for key, one in value.items())
    if isinstance(value, list | tuple):
        return ", ".join(generic(one, unit) for one in value)
    return DASH if value is None else str(value)
