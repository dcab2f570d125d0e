"""One process at a time writes at a place, and others are told which."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from datetime import UTC, datetime
from pathlib import Path
from socket import gethostname

from filelock import FileLock, Timeout

from rga.errors import InputError


class Held(InputError):
    """Another process writes there."""


@contextmanager
def only_writer(place: Path, patience: float = 0.0, stays: bool = False) -> Iterator[None]:
    """Hold a place for the time of the block; the system lets it go if the process is killed.

    Args:
        place: a file or directory that may be missing; its name with `.lock` and `.writer` behind
            it are taken.
        patience: how long to wait for another process [s].
        stays: whether the lock of a place that is there is left for others who wait for it.

    Raises:
        Held: another process holds it.
        InputError: it cannot be held.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder, only_writer(Path(folder) / "results"):
    ...     sorted(path.name for path in Path(folder).iterdir())
    ['results.lock', 'results.writer']
    """
    path, writer = (place.with_name(place.name + end) for end in (".lock", ".writer"))
    lock = FileLock(path, timeout=patience, thread_local=False)
    try:
        lock.acquire()
    except Timeout:
        who = "another process"
        with suppress(OSError, UnicodeDecodeError):
            who = writer.read_text(encoding="utf-8") or who
        raise Held(f"{who} writes there", str(place), "wait for it, or end it") from None
    except OSError as error:
        reason = (error.strerror or "refused").lower()
        raise InputError(
            f"it cannot be locked, {reason}", str(place), "allow writing to its directory"
        ) from error
    try:
        now = datetime.now(UTC).isoformat(timespec="seconds")
        with suppress(OSError):
            writer.write_text(f"process {os.getpid()} of {gethostname()}, since {now},", "utf-8")
        yield
    finally:
        with suppress(OSError):
            writer.unlink()
            if not (stays and place.exists()):
                path.unlink()
        lock.release()
