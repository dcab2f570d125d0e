"""Secrets, which stand in files of their own."""

from pathlib import Path

from rga.errors import InputError


def password_of(path: Path) -> str:
    """The password in a file of one line.

    Raises:
        InputError: the file cannot be read, or has none.
    """
    lines = _lines(path)
    if len(lines) != 1:
        raise InputError("a file of a password has one line", str(path), "the password")
    return lines[0]


def credentials_of(path: Path) -> tuple[str, str]:
    """User and password in a file of two lines.

    Raises:
        InputError: the file cannot be read, or has not both.
    """
    lines = _lines(path)
    if len(lines) < 2:
        raise InputError("a file of credentials has two lines", str(path), "user, then password")
    return lines[0], lines[1]


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text("utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(
            f"the secret cannot be read: {error}", str(path), "name a file of text that is there"
        ) from None
