"""All mistakes of a model file at once, in words."""

from collections.abc import Iterable
from typing import Any, NamedTuple

from pydantic import ValidationError

from rga.errors import InputError, SeveralMistakes
from rga.model.references import REFERENCE, Unread
from rga.model.schema import UNREAD, Model

REMEDY = "see `rga schema model` for what is right"
#: what stands for a part that could not be read, while the others are looked at
STAND_INS = {"rga_model": 1, "name": "model"}
#: length of a value, beyond which it is not shown
LONGEST = 80


class _Place(NamedTuple):
    """Where a mistake stands in the content of a file.

    Attributes:
        keys: that lead there.
        alternative: keys up to a value that may be of several forms; else all keys.
    """

    keys: tuple[str | int, ...]
    alternative: tuple[str | int, ...]


def refusal(error: ValidationError, content: Any, where: str) -> InputError:
    """The error for a file that is no model: what is wrong, every mistake of it.

    Names that stand for nothing are told of the parts that can be read, whatever the others are.

    Args:
        error: of the validation of the content.
        content: of the file.
        where: it stands.
    """
    found = {**_words(error, content), **_misnamed(error, content)}
    texts = list(found.values())
    if len(texts) == 1:
        return InputError(texts[0], where, REMEDY)
    return SeveralMistakes(texts, where, REMEDY)


def _misnamed(error: ValidationError, content: Any) -> dict[tuple[str | int, ...], str]:
    """Mistakes of the parts that can be read, by their places."""
    places = [
        _in_file(one["loc"]) for one in error.errors(include_url=False) if one["type"] != REFERENCE
    ]
    if not isinstance(content, dict) or not places or () in places:
        return {}
    rest, unread = _without(content, places)
    try:
        Model.model_validate(rest, context={UNREAD: unread})
    except ValidationError as further:
        return _words(further, rest)
    return {}


def _without(
    content: dict[str, Any], places: Iterable[tuple[str | int, ...]]
) -> tuple[dict[str, Any], Unread]:
    """A file without the parts that cannot be read, and what these are."""
    rest = dict(content)
    tables: set[str] = set()
    entries: set[tuple[str, str]] = set()
    for part, *inner in places:
        table = str(part)
        if inner and isinstance(content.get(table), dict):
            name = str(inner[0])
            rest[table] = {key: one for key, one in rest[table].items() if key != name}
            entries.add((table, name))
        else:
            tables.add(table)
    for table in tables:
        field = Model.model_fields.get(table)
        if field is not None and field.is_required():
            rest[table] = STAND_INS.get(table, {})
        else:
            rest.pop(table, None)
    return rest, Unread(frozenset(tables), frozenset(entries))


def _words(error: ValidationError, content: Any) -> dict[tuple[str | int, ...], str]:
    """A sentence for each mistake, by its place: the first of those that it may be."""
    best: dict[tuple[str | int, ...], tuple[int, str]] = {}
    for one in error.errors(include_url=False):
        loc = _in_file(one["loc"])
        if one["type"] == REFERENCE:  # a place may hold several of them
            best[(*loc, one["msg"])] = 0, _sentence(loc, one)
            continue
        place = _place(loc, one["type"] == "missing", content)
        # Of the forms that a value may have, that to which it comes nearest.
        depth = len(loc)
        if place.alternative not in best or depth > best[place.alternative][0]:
            best[place.alternative] = depth, _sentence(place.keys, one)
    return {place: words for place, (_, words) in best.items()}


def _in_file(loc: tuple[str | int, ...]) -> tuple[str | int, ...]:
    """Where a part of a model stands in its file: sensors of both sorts stand together."""
    return ("sensors", *loc[1:]) if loc[:1] == ("modal_sensors",) else loc


def _place(loc: tuple[str | int, ...], missing: bool, content: Any) -> _Place:
    keys: list[str | int] = []
    alternative: tuple[str | int, ...] | None = None
    for number, part in enumerate(loc):
        if _has(content, part):
            content = content[part]
        elif not missing or number < len(loc) - 1:
            # A form that the value may have, not a key.
            alternative = tuple(keys) if alternative is None else alternative
            continue
        keys.append(part)
    return _Place(tuple(keys), tuple(keys) if alternative is None else alternative)


def _has(content: Any, part: str | int) -> bool:
    if isinstance(content, list):
        return isinstance(part, int) and part < len(content)
    return isinstance(content, dict) and part in content


def _sentence(keys: tuple[str | int, ...], one: Any) -> str:
    message = one["msg"].removeprefix("Value error, ")
    if one["type"] == "extra_forbidden":
        message = "this key is unknown"
    value = one.get("input")
    shown = f" (value {value!r})" if isinstance(value, str | int | float | list) else ""
    key = ".".join(str(part) for part in keys)
    return f"{key}: {message}{shown if len(shown) < LONGEST else ''}" if key else message
