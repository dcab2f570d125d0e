"""Settings of a run from a file and the command line."""

import json
import tomllib
from pathlib import Path
from typing import TYPE_CHECKING

from pydantic import ValidationError

from rga.errors import InputError

if TYPE_CHECKING:
    from rga.twin.settings import Settings


def read_settings(path: Path | None, level: str | None) -> "Settings":
    """Settings from a file (JSON or TOML), with the level of integration from the command line.

    Raises:
        InputError: the file cannot be read, or a setting is unknown or impossible.
    """
    from rga.twin.settings import Settings

    where = "--level" if path is None else str(path)
    try:
        content = {} if path is None else _parse(path)
    except OSError as error:
        reason = (error.strerror or "unreadable").lower()
        raise InputError(
            f"the settings cannot be read, {reason}", where, "check the path"
        ) from None
    except ValueError as error:
        problem = " ".join(str(error).split())
        raise InputError(f"these are no settings: {problem}", where, "mend the syntax") from None
    if level is not None:
        content["level"] = level.upper()
    try:
        return Settings.model_validate(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part) for part in first["loc"])
        place = f"{key}: " if key else ""
        message = first["msg"].removeprefix("Value error, ")
        known = ", ".join(Settings.model_fields)
        raise InputError(f"{place}{message}", where, f"the settings are {known}") from None


def _parse(path: Path) -> dict[str, object]:
    text = path.read_text(encoding="utf-8")
    content = tomllib.loads(text) if path.suffix == ".toml" else json.loads(text)
    if not isinstance(content, dict):
        raise ValueError("give a table of settings")
    return content
