"""Criteria from a file."""

from pathlib import Path

from rga.findings.criteria.criteria import Criteria
from rga.settings_files import read_table, validated


def load_criteria(path: str | Path) -> Criteria:
    """Read criteria from a file (JSON or TOML) that states those which are not the default ones.

    Args:
        path: the file.

    Raises:
        InputError: the file cannot be read, or a criterion is unknown or impossible.
    """
    content = read_table(Path(path), "criteria")
    return validated(Criteria, content, str(path), "criteria")
