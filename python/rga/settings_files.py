"""Files of settings (JSON or TOML), read into frozen classes with one clear error."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from rga.bounded_files import bytes_of, fault_of, toml_of
from rga.errors import InputError, SeveralMistakes

T = TypeVar("T", bound=BaseModel)
#: bytes of a file of settings
LARGEST_SETTINGS = 2**20


def read_table(path: Path, what: str) -> dict[str, object]:
    """The table in a file; its suffix says whether it is TOML or JSON.

    Args:
        path: the file.
        what: it holds, as an error calls it: "settings".

    Raises:
        InputError: the file cannot be read, or holds no table.
    """
    raw = bytes_of(path, what, LARGEST_SETTINGS)
    try:
        text = raw.decode("utf-8-sig")
        content = toml_of(text) if path.suffix == ".toml" else json.loads(text)
    except (ValueError, RecursionError) as error:
        problem = fault_of(error)
        raise InputError(f"these are no {what}: {problem}", str(path), "mend the syntax") from None
    if not isinstance(content, dict):
        raise InputError(
            f"these are no {what}: give a table of {what}", str(path), "mend the syntax"
        )
    # By which an editor completes the file.
    return {key: value for key, value in content.items() if key != "$schema"}


def validated(kind: type[T], content: dict[str, object], where: str, what: str) -> T:
    """A table as the class of its settings.

    Args:
        kind: the class.
        content: the table.
        where: it stands, for an error.
        what: it holds, as an error calls it: "settings".

    Raises:
        InputError: a setting is unknown or impossible; where several are, with all of them
            (`SeveralMistakes`).
    """
    try:
        return kind.model_validate(content)
    except ValidationError as error:
        found = _without_those_that_follow(error.errors(include_url=False))
        told = list(dict.fromkeys(f"{_place(one['loc'], content)}{in_words(one)}" for one in found))
        if len(told) > 1:
            raise SeveralMistakes(told, where, "correct each of them") from None
        remedy = "correct the value"
        if found[0]["type"] in _OF_KEYS:
            remedy = _known_keys(kind, found[0]["loc"], what)
        raise InputError(told[0], where, remedy) from None


def _without_those_that_follow(found: Sequence[ErrorDetails]) -> list[ErrorDetails]:
    """Mistakes but for lists that are too short without their entries that are wrong."""
    places = [one["loc"] for one in found]
    return [
        one
        for one in found
        if one["type"] != "too_short"
        or not any(place[: len(one["loc"])] == one["loc"] != place for place in places)
    ]


#: mistakes that the names of the keys mend
_OF_KEYS = {"extra_forbidden", "missing", "model_type", "union_tag_not_found"}


def _place(keys: Sequence[str | int], content: object) -> str:
    """Where a mistake stands, as people count and call it: `twin 'east', source 2, path: `."""
    words, within = "", content
    for key in keys:
        if isinstance(key, int):
            within = within[key] if isinstance(within, list) and key < len(within) else None
            name = within.get("name") if isinstance(within, dict) else None
            words += f" {name!r}, " if isinstance(name, str) else f" {key + 1}, "
            continue
        if isinstance(within, dict) and key not in within and within.get("kind") == key:
            continue  # the kind of a table, which is no key of it
        words += key if not words or words.endswith(", ") else f".{key}"
        within = within.get(key) if isinstance(within, dict) else None
    words = words.removesuffix(", ")
    return f"{words}: " if words else ""


def _known_keys(kind: type[BaseModel], keys: Sequence[str | int], what: str) -> str:
    tables = [key for key in keys[:-1] if isinstance(key, str)]
    if tables:
        what = f"keys of [{'.'.join(tables)}]"
    elif what == "configuration":
        what = "keys"
    return f"the {what} are {', '.join(_table_of(kind, keys[:-1]).model_fields)}"


def in_words(mistake: Mapping[str, Any]) -> str:
    """What pydantic finds wrong, in words that those understand who do not know it.

    >>> in_words({"type": "value_error", "msg": "Value error, give one"})
    'give one'
    """
    context = mistake.get("ctx", {})
    if mistake["type"] == "union_tag_invalid":
        key, expected = (
            context[one].replace("'", "") for one in ("discriminator", "expected_tags")
        )
        return f"{key} is one of {expected}, and {context['tag']!r} is none"
    if mistake["type"] == "union_tag_not_found":
        return f"say its {context['discriminator'].replace(chr(39), '')}"
    plain = {
        "extra_forbidden": "there is no such key",
        "missing": "it is missing",
        "model_type": "give a table",
        "bool_type": "write true or false",
    }
    message: str = mistake["msg"]
    return plain.get(mistake["type"], message.removeprefix("Value error, "))


def _table_of(kind: type[BaseModel], keys: Sequence[str | int]) -> type[BaseModel]:
    """The class of the table that keys lead to, as far as they do."""
    choices = [kind]
    for key in keys:
        if isinstance(key, int):
            continue
        # A key is a field, or says which of several kinds of tables it is.
        tagged = [one for one in choices if _tag(one) == key]
        fields = [one.model_fields[key] for one in choices if key in one.model_fields]
        if not tagged and not fields:
            break
        choices = tagged or _tables(fields[0].annotation) or choices
    return choices[0]


def _tag(kind: type[BaseModel]) -> object:
    """The word by which a table is told from others, if there is one."""
    field = kind.model_fields.get("kind")
    return None if field is None else next(iter(get_args(field.annotation)), None)


def _tables(annotation: object) -> list[type[BaseModel]]:
    """The classes of tables within the type of a field."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [found for one in get_args(annotation) for found in _tables(one)]
