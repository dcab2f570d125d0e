"""Settings of a run from a file and the command line."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rga.twin.settings import Settings


def read_settings(path: Path | None, level: str | None) -> "Settings":
    """Settings from a file (JSON or TOML), with the level of integration from the command line.

    Raises:
        InputError: the file cannot be read, or a setting is unknown or impossible.
    """
    from rga.settings_files import read_table, validated
    from rga.twin.settings import Settings

    content = {} if path is None else read_table(path, "settings")
    if level is not None:
        content["level"] = level.upper()
    where = "--level" if path is None else str(path)
    return validated(Settings, content, where, "settings")
