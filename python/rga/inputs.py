"""The files that a command reads, which it never writes over."""

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

#: files that were read, by device and number, for each block that protects them
_READ: list[set[tuple[int, int]]] = []


@contextmanager
def protected_inputs() -> Iterator[None]:
    """Files that are read within the block are not written over within it."""
    _READ.append(set())
    try:
        yield
    finally:
        _READ.pop()


def remember(path: Path) -> None:
    """Note that a file is read.

    >>> from tempfile import NamedTemporaryFile
    >>> with NamedTemporaryFile() as file, protected_inputs():
    ...     remember(Path(file.name))
    ...     is_input(Path(file.name))
    True
    """
    if _READ:
        with suppress(OSError, ValueError):
            _READ[-1].add(_identity(path))


def is_input(path: Path) -> bool:
    """Whether a file, by whatever name, was read within a block that protects it."""
    try:
        identity = _identity(path) if _READ else None
    except (OSError, ValueError):
        return False
    return any(identity in read for read in _READ)


def _identity(path: Path) -> tuple[int, int]:
    status = path.stat()
    return status.st_dev, status.st_ino
