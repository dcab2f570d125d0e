"""Which column is likely which sensor or context variable."""

import re
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher

from rga.errors import InputError
from rga.model import Model
from rga.records.table import Table
from rga.records.units import DIMENSIONS, conversion, unit_of

#: likeness of two names, below which they are not taken for one
ALIKE = 0.8


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


def matches(tables: Sequence[Table], model: Model, taken: Sequence[Sequence[str]]) -> list[Match]:
    """The likeliest column of every channel, each column once.

    Args:
        tables: one of each logger.
        model: names the channels.
        taken: columns of each that hold time or are the format's own.
    """
    likely: list[Match] = []
    for group, table in enumerate(tables):
        for column in table.frame.columns:
            if column in taken[group]:
                continue
            likely += [
                _likeness(table, group, column, name)
                for name in (*model.sensors, *model.context)
                if _fits(table.units.get(column), name, model)
            ]
    likely = [one for one in likely if one.likeness >= ALIKE]
    chosen: dict[str, Match] = {}
    used: set[tuple[int, str]] = set()
    for one in sorted(likely, key=lambda one: -one.likeness):
        if one.name not in chosen and (one.group, one.column) not in used:
            chosen[one.name] = one
            used.add((one.group, one.column))
    for one in _by_unit(tables, model, taken, set(chosen), used):
        chosen[one.name] = one
    return [chosen[name] for name in (*model.sensors, *model.context) if name in chosen]


def folded(name: str) -> str:
    """A name without what people write in different ways: capitals, signs, leading zeros.

    >>> folded("MS_01 (oben)") == folded("ms1 Oben"), folded("Träger")
    (True, 'trager')
    """
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode().lower()
    return re.sub(r"[^a-z0-9]|(?<![0-9])0+(?=[0-9])", "", plain)


def _likeness(table: Table, group: int, column: str, name: str) -> Match:
    bare = table.names.get(column, column)
    if name in (column, bare):
        return Match(name, group, column, 1.0, "the same name")
    one, other = folded(bare), folded(name)
    if one and one == other:
        return Match(name, group, column, 0.95, "the same name but for its writing")
    # S1 and S2 are alike, and are not the same: numbers must agree.
    if re.findall(r"\d+", one) != re.findall(r"\d+", other) or min(len(one), len(other)) < 3:
        return Match(name, group, column, 0.0, "")
    ratio = SequenceMatcher(None, one, other).ratio()
    if one.startswith(other) or other.startswith(one):
        ratio = max(ratio, ALIKE)
    return Match(name, group, column, 0.9 * ratio if ratio < ALIKE else ratio * 0.94, "a like name")


def _fits(unit: str | None, name: str, model: Model) -> bool:
    if unit is None:
        return True
    try:
        conversion(unit, name, model, "")
    except InputError:
        return False
    return True


def _by_unit(
    tables: Sequence[Table],
    model: Model,
    taken: Sequence[Sequence[str]],
    matched: set[str],
    used: set[tuple[int, str]],
) -> list[Match]:
    """A channel and a column that are the only ones of their dimension that are left."""
    left: dict[str, list[str]] = {}
    for name, dimension in _dimensions(model).items():
        if name not in matched and dimension is not None:
            left.setdefault(dimension, []).append(name)
    columns: dict[str, list[tuple[int, str]]] = {}
    for group, table in enumerate(tables):
        for column in table.frame.columns:
            unit = unit_of(table.units[column]) if column in table.units else None
            if unit is not None and column not in taken[group] and (group, column) not in used:
                columns.setdefault(unit.dimension, []).append((group, column))
    return [
        Match(names[0], *columns[dimension][0], 0.5, f"the only {dimension} that is left")
        for dimension, names in left.items()
        if len(names) == 1 and len(columns.get(dimension, [])) == 1
    ]


def _dimensions(model: Model) -> Mapping[str, str | None]:
    found: dict[str, str | None] = {
        name: DIMENSIONS[sensor.kind][0] for name, sensor in model.sensors.items()
    }
    for name, context in model.context.items():
        unit = unit_of(context.unit)
        found[name] = unit.dimension if unit else None
    return found
