"""Which column is likely which sensor or context variable."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

from rga.errors import InputError
from rga.model import Model
from rga.records.drafting.places import is_number, named_places, places_of, words_of
from rga.records.table import Table
from rga.records.units import DIMENSIONS, conversion, unit_of

#: likeness of two names, below which they are not taken for one
ALIKE = 0.8
#: likeness of names that differ in nothing but their writing
WRITTEN = 0.95


@dataclass(frozen=True)
class Match:
    """A column that is taken for a channel.

    Attributes:
        name: sensor or context variable.
        group: number of the logger.
        column: of its files.
        likeness: of the names, 1 where they are the same.
        why: in words.
    """

    name: str
    group: int
    column: str
    likeness: float
    why: str


@dataclass(frozen=True)
class _Column:
    """A column that may be a channel.

    Attributes:
        places: members and nodes that its name tells of.
    """

    group: int
    name: str
    bare: str
    unit: str | None
    places: frozenset[str]

    @property
    def dimension(self) -> str | None:
        unit = unit_of(self.unit) if self.unit is not None else None
        return unit.dimension if unit else None


def matches(
    tables: Sequence[Table], model: Model, taken: Sequence[Sequence[str]]
) -> tuple[list[Match], list[str]]:
    """The likeliest column of every channel, each column once.

    By its name; else by the member or node in its name and a unit of the sensor's kind; else as the
    only one of its dimension.

    Args:
        tables: one of each logger.
        model: names the channels.
        taken: columns of each that hold time or are the format's own.

    Returns:
        The matches, and in words where several columns or sensors were as likely.
    """
    places = places_of(model)
    columns = [
        _Column(
            group,
            column,
            bare := table.names.get(column, column),
            table.units.get(column),
            named_places(bare, places),
        )
        for group, table in enumerate(tables)
        for column in table.frame.columns
        if column not in taken[group]
    ]
    chosen: dict[str, Match] = {}
    used: set[tuple[int, str]] = set()

    def choose(likely: Sequence[Match]) -> None:
        for one in sorted(likely, key=lambda one: -one.likeness):
            if one.name not in chosen and (one.group, one.column) not in used:
                chosen[one.name] = one
                used.add((one.group, one.column))

    def left() -> tuple[list[_Column], list[str]]:
        free = [one for one in columns if (one.group, one.name) not in used]
        return free, [name for name in (*model.sensors, *model.context) if name not in chosen]

    choose([one for one in _by_name(*left(), model) if one.likeness >= WRITTEN])
    at_places, unsure = _by_place(*left(), model)
    choose(at_places)
    choose([one for one in _by_name(*left(), model) if one.likeness >= ALIKE])
    choose(_by_unit(*left(), model))
    found = [chosen[name] for name in (*model.sensors, *model.context) if name in chosen]
    return found, [doubt for name, doubt in unsure.items() if name not in chosen]


def fits(unit: str | None, name: str, model: Model) -> bool:
    """Whether what a channel measures may be in a unit; one that is not stated may be any."""
    if unit is None:
        return True
    try:
        conversion(unit, name, model, "")
    except InputError:
        return False
    return True


def folded(name: str) -> str:
    """A name without what people write in different ways: capitals, signs, leading zeros.

    >>> folded("MS_01 (oben)") == folded("ms1 Oben"), folded("Träger")
    (True, 'trager')
    """
    return "".join(words_of(name))


def _by_name(columns: Sequence[_Column], names: Sequence[str], model: Model) -> Iterator[Match]:
    for column in columns:
        for name in names:
            if fits(column.unit, name, model):
                likeness, why = _likeness(column, name, model)
                yield Match(name, column.group, column.name, likeness, why)


def _likeness(column: _Column, name: str, model: Model) -> tuple[float, str]:
    if name in (column.name, column.bare):
        return 1.0, "the same name"
    one, other = folded(column.bare), folded(name)
    if one and one == other:
        return WRITTEN, "the same name but for its writing"
    # S1 and S2 are alike, and are not the same: numbers must agree.
    if re.findall(r"\d+", one) != re.findall(r"\d+", other) or min(len(one), len(other)) < 3:
        return 0.0, ""
    if _elsewhere(column, name, model):
        return 0.0, ""
    ratio = SequenceMatcher(None, one, other).ratio()
    if one.startswith(other) or other.startswith(one):
        ratio = max(ratio, ALIKE)
    return 0.9 * ratio if ratio < ALIKE else ratio * 0.94, "a like name"


def _place(name: str, model: Model) -> str | None:
    """The member or node that a sensor is on; None: it is a context."""
    sensor = model.sensors.get(name)
    return None if sensor is None else sensor.member or sensor.node


def _elsewhere(column: _Column, name: str, model: Model) -> bool:
    """Whether a column tells of a member or node that is not the sensor's."""
    place = _place(name, model)
    told = {one for one in column.places if not is_number(one)}
    return bool(told) and place is not None and place not in told


def _by_place(
    columns: Sequence[_Column], names: Sequence[str], model: Model
) -> tuple[list[Match], dict[str, str]]:
    """Sensors and columns of one place that have no other; and by sensor, where they have."""
    likely: dict[str, list[_Column]] = {}
    for name in names:
        place = _place(name, model)
        at_place = [one for one in columns if place in one.places and fits(one.unit, name, model)]
        if at_place:
            likely[name] = at_place
    found, unsure = [], {}
    for name, at_place in likely.items():
        place = _place(name, model) or ""
        first = at_place[0]
        rivals = [one for one, others in likely.items() if first in others]
        if len(at_place) == len(rivals) == 1 and first.unit and not is_number(place):
            kind = "member" if model.sensors[name].member else "node"
            why = f"it names the {kind} {place!r}, in {first.unit}"
            found.append(Match(name, first.group, first.name, 0.9, why))
        else:
            shown = ", ".join(repr(one.name) for one in at_place[:5])
            more = f" and {len(at_place) - 5} more" if len(at_place) > 5 else ""
            unsure[name] = f"{name} may be {shown}{more}"
            if len(rivals) > 1:
                unsure[name] += ", as may " + ", ".join(one for one in rivals[:6] if one != name)
    return found, unsure


def _by_unit(columns: Sequence[_Column], names: Sequence[str], model: Model) -> list[Match]:
    """A channel and a column that are the only ones of their dimension that are left."""
    left: dict[str, list[str]] = {}
    for name, dimension in _dimensions(model).items():
        if name in names and dimension is not None:
            left.setdefault(dimension, []).append(name)
    measured: dict[str, list[_Column]] = {}
    for column in columns:
        if column.dimension is not None:
            measured.setdefault(column.dimension, []).append(column)
    found = []
    for dimension, channels in left.items():
        alone = measured.get(dimension, [])
        if len(channels) == len(alone) == 1 and not _elsewhere(alone[0], channels[0], model):
            why = f"the only {dimension} that is left"
            found.append(Match(channels[0], alone[0].group, alone[0].name, 0.5, why))
    return found


def _dimensions(model: Model) -> Mapping[str, str | None]:
    found: dict[str, str | None] = {
        name: DIMENSIONS[sensor.kind][0] for name, sensor in model.sensors.items()
    }
    for name, context in model.context.items():
        unit = unit_of(context.unit)
        found[name] = unit.dimension if unit else None
    return found
