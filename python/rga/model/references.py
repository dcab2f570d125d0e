"""Names in one part of a model file that must stand in another."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import dist
from typing import TYPE_CHECKING, Any, LiteralString

from pydantic import ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

from rga.model.parameter import Driven, listed

if TYPE_CHECKING:
    from rga.model.effect import Effect
    from rga.model.schema import Model

#: below which a member has no length [m]
SHORTEST = 1e-9
#: where a mistake stands, key by key, and what it is
Mistake = tuple[tuple[str, ...], str]


@dataclass(frozen=True)
class Unread:
    """What a file has, but in a form that could not be read: names of it count as known.

    Attributes:
        tables: whole parts of the file.
        entries: (part, name).
    """

    tables: frozenset[str] = frozenset()
    entries: frozenset[tuple[str, str]] = frozenset()

    def touches(self, table: str) -> bool:
        """Whether a part of the file was read in part only, or not at all."""
        return table in self.tables or any(own == table for own, _ in self.entries)

    def __bool__(self) -> bool:
        return bool(self.tables or self.entries)


#: type of a mistake that shows beside other parts of the file only
REFERENCE: LiteralString = "reference"
EVERYTHING_READ = Unread()
#: letters of a name
LONGEST_NAME = 200
#: parts of a model whose entries have names
NAMED = (
    "materials", "sections", "nodes", "members", "supports", "masses", "context", "effects",
    "points", "modes", "sensors", "modal_sensors",
)  # fmt: skip


def refuse(title: str, mistakes: Iterator[Mistake], of: LiteralString = REFERENCE) -> None:
    """Raise all mistakes together, if there are any (ValidationError).

    Args:
        title: of what is refused.
        mistakes: where and what.
        of: this type.
    """
    found = [
        InitErrorDetails(
            type=PydanticCustomError(of, "{what}", {"what": what}), loc=place, input=None
        )
        for place, what in mistakes
    ]
    if found:
        raise ValidationError.from_exception_data(title, found)


def mistakes(model: "Model", unread: Unread = EVERYTHING_READ) -> Iterator[Mistake]:
    """Names that stand for nothing in a model, and parts that do not fit each other.

    Args:
        model: of which every part is valid by itself.
        unread: what its file has besides.
    """
    yield from _unwritable(model)
    names = _Names(model, unread)
    for name, member in model.members.items():
        place = ("members", name)
        yield from names.missing("nodes", member.nodes, (*place, "nodes"))
        yield from _without_length(model, member.nodes, (*place, "nodes"))
        yield from names.missing("sections", [member.section], (*place, "section"))
        yield from names.missing("materials", [member.material], (*place, "material"))
    for name, support in model.supports.items():
        yield from names.missing("nodes", [support.node], ("supports", name, "node"))
    for number, spring in enumerate(model.springs):
        ends = [end for end in (spring.node, spring.to) if end is not None]
        yield from names.missing("nodes", ends, (f"springs[{number}]",))
    for number, tie in enumerate(model.ties):
        yield from names.missing("nodes", tie.nodes, (f"ties[{number}]",))
    for name, mass in model.masses.items():
        yield from names.missing("nodes", listed(mass.node), ("masses", name, "node"))
        yield from names.missing("groups", listed(mass.group), ("masses", name, "group"))
    yield from _columns(model)
    for name, sensor in model.sensors.items():
        yield from names.missing("members", listed(sensor.member), ("sensors", name, "member"))
        places = [place for place in (sensor.node, sensor.relative_to) if place is not None]
        yield from names.missing("nodes", places, ("sensors", name))
    yield from _modal(model, names)
    for name, effect in model.effects.items():
        yield from effect_mistakes(model, effect, ("effects", name), unread)


def _modal(model: "Model", names: "_Names") -> Iterator[Mistake]:
    """What points, modes and their sensors name that there is not."""
    for name, point in model.points.items():
        yield from names.missing("nodes", [point.node], ("points", name, "node"))
    for name, mode in model.modes.items():
        yield from names.missing("points", mode.shape, ("modes", name, "shape"))
        yield from names.missing("modes", mode.cluster, ("modes", name, "cluster"))
    for name, sensor in model.modal_sensors.items():
        place = ("sensors", name)
        yield from names.missing("modes", [sensor.mode], (*place, "mode"))
        yield from names.missing("points", listed(sensor.point), (*place, "point"))
        read = model.modes.get(sensor.mode)
        if sensor.point is None or read is None or read.computed is not None:
            continue
        if not read.shape:
            yield place, f"mode {sensor.mode!r} has no shape: give 'shape' or 'computed'"
        elif sensor.point not in read.shape:
            yield place, f"mode {sensor.mode!r} has no motion at point {sensor.point!r}"


def _unwritable(model: "Model") -> Iterator[Mistake]:
    """Names that no file, page or message can hold."""
    named = {"name": [model.name], "groups": list(model.groups)}
    named |= {part: list(getattr(model, part)) for part in NAMED}
    for part, names in named.items():
        for name in names:
            if len(name) > LONGEST_NAME or not name.isprintable():
                shown = ascii(name[:40]) + "..." * (len(name) > 40)
                what = f"{shown} is no name: write at most {LONGEST_NAME} letters and signs"
                yield (part,), what


def effect_mistakes(
    model: "Model", effect: "Effect", where: tuple[str, ...], unread: Unread = EVERYTHING_READ
) -> Iterator[Mistake]:
    """What an effect names that is not in a model, and whether it fits the model.

    Args:
        model: that it is to act on.
        effect: valid by itself.
        where: it stands.
        unread: what the file of the model has besides.
    """
    names, whole = _Names(model, unread), True
    for found in _misplaced(names, effect, where):
        whole = False
        yield found
    # A part that was not read might be what the effect needs.
    if whole and not unread:
        try:
            effect.check(model)
        except ValueError as error:
            yield where, str(error)


def _misplaced(names: "_Names", effect: "Effect", where: tuple[str, ...]) -> Iterator[Mistake]:
    for field, mark in effect.place_fields().items():
        named = getattr(effect, field)
        if named is None or mark.of not in names.tables:
            continue
        if not named:
            yield (*where, field), f"names no {mark.of}; name one of the model"
        for one in listed(named):
            if not names.has(mark.of, one):
                yield (*where, field), f"there is no {mark.of} {one!r} in the model"
    for node in getattr(effect, "nodes", ()):
        if not names.has("node", node):
            yield where, f"there is no {node!r} in nodes"
    for context in sorted(effect.drivers()):
        if not names.has("context", context):
            yield where, f"there is no context {context!r} in the model"
    for key, parameter in effect.parameters().items():
        value = getattr(effect, key)
        if isinstance(value, Driven) and (mistake := value.mistake(parameter.neutral)):
            yield (*where, key), mistake


def _without_length(
    model: "Model", nodes: tuple[str, str], place: tuple[str, ...]
) -> Iterator[Mistake]:
    one, other = nodes
    if one == other:
        yield place, f"both ends are node {one!r}"
    elif {one, other} <= model.nodes.keys() and (
        dist(model.nodes[one], model.nodes[other]) < SHORTEST
    ):
        yield place, "the member has no length"


def _columns(model: "Model") -> Iterator[Mistake]:
    """Names that two columns of a record would have."""
    for table in ("sensors", "context"):
        if "time" in getattr(model, table):
            yield (table,), "'time' is the column of the time: choose another name"
    for name in sorted(model.sensors.keys() & model.context.keys()):
        yield ("sensors", name), "a context variable has the same name"


class _Names:
    """Names that a model file has, by what they are of."""

    def __init__(self, model: "Model", unread: Unread) -> None:
        self._unread = unread
        self.tables: dict[str, Any] = {
            "member": model.members,
            "group": model.groups,
            "support": model.supports,
            "mass": model.masses,
            "sensor": model.sensors,
            "context": model.context,
            "effect": model.effects,
            "material": model.materials,
            "point": model.points,
            "mode": model.modes,
            "section": model.sections,
            "node": model.nodes,
        }

    def has(self, of: str, name: str) -> bool:
        if name in self.tables[of]:
            return True
        if of == "group":
            return self._unread.touches("members")
        part = {"context": "context", "mass": "masses"}.get(of, f"{of}s")
        return part in self._unread.tables or (part, name) in self._unread.entries

    def missing(self, table: str, names: Any, place: tuple[str, ...]) -> Iterator[Mistake]:
        """Mistakes for those of some names that are not in a part of the file."""
        for name in names:
            if not self.has(table.removesuffix("s"), name):
                yield place, f"there is no {name!r} in {table}"
