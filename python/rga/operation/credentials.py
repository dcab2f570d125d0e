"""User and password of a broker, from a file that nobody else reads."""

from pathlib import Path

from rga.bounded_files import bytes_of
from rga.errors import InputError


def read_credentials(path: Path) -> tuple[str, str]:
    """User and password, each on a line of its own.

    Raises:
        InputError: the file cannot be read, or has no two lines.
    """
    lines = bytes_of(path, "file of credentials", 10_000).decode("utf-8", "replace").splitlines()
    if len(lines) < 2:
        raise InputError("a file of credentials has two lines", str(path), "user, then password")
    return lines[0], lines[1]
