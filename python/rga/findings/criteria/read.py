"""Criteria from a file."""

from pathlib import Path

from rga.errors import InputError, kind_of
from rga.files import as_path
from rga.findings.criteria.criteria import Criteria
from rga.settings_files import read_table, validated


def as_criteria(given: Criteria | str | Path | None) -> Criteria:
    """Criteria, read where their file is given; the default ones where none are.

    Raises:
        InputError: as `load_criteria`; these are no criteria.
    """
    if given is None:
        return Criteria()
    if isinstance(given, Criteria):
        return given
    if isinstance(given, str | Path):
        return load_criteria(given)
    what = f"{kind_of(given)} is no set of criteria"
    raise InputError(what, "criteria", "give Criteria, or the path of their file")


def load_criteria(path: str | Path) -> Criteria:
    """Read criteria from a file (JSON or TOML) that states those which are not the default ones.

    Args:
        path: the file.

    Raises:
        InputError: the file cannot be read, or a criterion is unknown or impossible.
    """
    content = read_table(as_path(path, "criteria"), "criteria")
    return validated(Criteria, content, str(path), "criteria")
