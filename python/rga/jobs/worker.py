"""Plays many live twins in turn: a lease on each, what is due, and on to the next."""

import time
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import Literal

from rga.errors import InputError
from rga.files import as_path
from rga.jobs.live import LiveTwin
from rga.twin.hardware.inbox import INBOX
from rga.twin.history import Event
from rga.twin.repository import InUse
from rga.twin.repository.database import FILE_NAME
from rga.twin.repository.faults import Damaged, RepositoryFault
from rga.twin.runner import Running

Kind = Literal["watch", "heavy"]
#: failures of a twin one after the other, after which a worker leaves it alone
MOST_FAILURES = 3
#: how long a twin is not looked at while nothing is written where it is [s]
UNCHANGED = 5.0


class Worker:
    """Takes leases on twins, plays what is due, and lets go.

    A lease is the lock of a run: the system takes it from a worker that is killed, and another
    goes on where the last step ended. Short steps (`watch`) and long ones (`heavy`: calibration,
    recalibration, diagnosis) can be left to workers of their own, so that no row of a twin waits
    for the diagnosis of another.

    Args:
        directories: of the twins (`rga.live`).
        kinds: of steps that are taken here.
        repository: URL of a PostgreSQL database, if they are kept there.
        has_room: whether the disk has room for a long step; while it has none, they wait.

    Attributes:
        failed: why a twin cannot be played, by directory; after three times it is left alone,
            unless all that it needs is room on a disk, or a server that is there again.

    Example: `Worker(["a", "b"]).round()` plays all that is due in two directories.
    """

    def __init__(
        self,
        directories: Sequence[str | Path],
        kinds: Collection[Kind] = ("watch", "heavy"),
        repository: str | None = None,
        has_room: Callable[[], bool] = lambda: True,
    ) -> None:
        self._directories = [as_path(one, "directories") for one in directories]
        self._kinds, self._repository = frozenset(kinds), repository
        self._has_room = has_room
        self._failures: Counter[Path] = Counter()
        self._idle: dict[Path, tuple[float, list[int]]] = {}
        self.failed: dict[Path, str] = {}

    def round(
        self, told: Callable[[Path | None], None] = lambda directory: None
    ) -> dict[Path, list[Event]]:
        """Play what is due in every twin that no other plays.

        A twin in which nothing was due is not looked at again before something is written in its
        directory, or for some seconds.

        Args:
            told: called with the twin that is looked at next, and with None at the end.

        Returns:
            What happened, for every twin to which something did.
        """
        happened = {}
        for directory in self._directories:
            if self._failures[directory] >= MOST_FAILURES:
                continue
            written = _written(directory)
            since, before = self._idle.get(directory, (0.0, None))
            if written == before and time.monotonic() - since < UNCHANGED:
                continue
            told(directory)
            try:
                with LiveTwin(directory, self._repository, patience=0.0) as twin:
                    events = twin.play(self._takes)
            except InUse:
                continue
            except InputError as error:
                self.failed[directory] = str(error)
                if isinstance(error, RepositoryFault) and not isinstance(error, Damaged):
                    self._idle[directory] = time.monotonic(), written
                else:
                    self._failures[directory] += 1
                continue
            self._failures[directory] = 0
            self.failed.pop(directory, None)
            self._idle[directory] = time.monotonic(), written
            if events:
                happened[directory] = events
        told(None)
        return happened

    def _takes(self, running: Running) -> bool:
        if running.is_short:
            return "watch" in self._kinds
        return "heavy" in self._kinds and self._has_room()


def _written(directory: Path) -> list[int]:
    """When the files of a twin were last written [ns]; 0 for those that are not there."""
    files = [f"{name}{log}" for name in (INBOX, FILE_NAME) for log in ("", "-wal")]
    return [_changed(directory / name) for name in files]


def _changed(file: Path) -> int:
    try:
        return file.stat().st_mtime_ns
    except OSError:
        return 0
