"""Files of settings (JSON or TOML), read into frozen classes with one clear error."""

import json
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from rga.bounded_files import bytes_of, fault_of, toml_of
from rga.errors import InputError

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
        InputError: a setting is unknown or impossible.
    """
    try:
        return kind.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        keys = [str(part) for part in first["loc"]]
        place = f"{'.'.join(keys)}: " if keys else ""
        message = first["msg"].removeprefix("Value error, ")
        known = ", ".join(_table_of(kind, keys[:-1]).model_fields)
        of = f" of {keys[0]}" if len(keys) > 1 else ""
        raise InputError(f"{place}{message}", where, f"the {what}{of} are {known}") from None


def _table_of(kind: type[BaseModel], keys: list[str]) -> type[BaseModel]:
    """The class of the table that keys lead to, as far as they do."""
    for key in keys:
        field = kind.model_fields.get(key)
        if field is None or not isinstance(field.annotation, type):
            break
        if not issubclass(field.annotation, BaseModel):
            break
        kind = field.annotation
    return kind
