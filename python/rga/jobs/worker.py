"""Plays many live twins in turn: a lease on each, what is due, and on to the next."""

from collections import Counter
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import Literal

from rga.errors import InputError
from rga.files import as_path
from rga.jobs.live import LiveTwin
from rga.twin.history import Event
from rga.twin.repository import InUse
from rga.twin.runner import Running

Kind = Literal["watch", "heavy"]
#: failures of a twin one after the other, after which a worker leaves it alone
MOST_FAILURES = 3


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

    Attributes:
        failed: why a twin cannot be played, by directory; after three times it is left alone.

    Example: `Worker(["a", "b"]).round()` plays all that is due in two directories.
    """

    def __init__(
        self,
        directories: Sequence[str | Path],
        kinds: Collection[Kind] = ("watch", "heavy"),
        repository: str | None = None,
    ) -> None:
        self._directories = [as_path(one, "directories") for one in directories]
        self._kinds, self._repository = frozenset(kinds), repository
        self._failures: Counter[Path] = Counter()
        self.failed: dict[Path, str] = {}

    def round(self) -> dict[Path, list[Event]]:
        """Play what is due in every twin that no other plays.

        Returns:
            What happened, for every twin to which something did.
        """
        happened = {}
        for directory in self._directories:
            if self._failures[directory] >= MOST_FAILURES:
                continue
            try:
                with LiveTwin(directory, self._repository, patience=0.0) as twin:
                    events = twin.play(self._takes)
            except InUse:
                continue
            except InputError as error:
                self._failures[directory] += 1
                self.failed[directory] = str(error)
                continue
            self._failures[directory] = 0
            self.failed.pop(directory, None)
            if events:
                happened[directory] = events
        return happened

    def _takes(self, running: Running) -> bool:
        return ("watch" if running.is_short else "heavy") in self._kinds
