"""Reports of a stretch of a twin's rows, each made by a process of its own."""

import multiprocessing
from collections import OrderedDict
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from pathlib import Path
from shutil import rmtree
from threading import Lock, Thread

from rga.errors import InputError, in_short
from rga.files import made_directory
from rga.outputs import REPORT, write_findings
from rga.twin.restore import record_of
from rga.twin.twin import Twin

#: reports that wait, and that are kept
MOST_WAITING, MOST_KEPT = 4, 20
#: name of the file that says why there is no report
REFUSED = "refused.txt"


@dataclass(frozen=True)
class Wanted:
    """What a report is of.

    Attributes:
        place: of the repository of the twin.
        source: of its rows.
        first, end: row, and row behind the last.
    """

    place: str
    source: str
    first: int
    end: int


class Reports:
    """The reports of a service, made one after the other.

    Args:
        directory: for them; what a service before this one left there is removed.
    """

    def __init__(self, directory: Path) -> None:
        self._directory = directory
        self._waiting: OrderedDict[Wanted, Path] = OrderedDict()
        self._made: OrderedDict[Wanted, Path] = OrderedDict()
        self._number, self._lock, self._ends = 0, Lock(), False
        self._thread: Thread | None = None
        self._process: BaseProcess | None = None
        rmtree(directory, ignore_errors=True)

    def get(self, wanted: Wanted) -> Path | None:
        """The file of a report; None: it is being made, ask again.

        Raises:
            InputError: nothing can be said of these rows.
            BlockingIOError: too many others wait to be made.
        """
        with self._lock:
            if wanted in self._made:
                place = self._made[wanted]
                if (place / REPORT).exists():
                    return place / REPORT
                # Another try may do better.
                del self._made[wanted]
                why = (place / REFUSED).read_text("utf-8")
                raise InputError(why, "report", "choose another stretch of time")
            if wanted not in self._waiting:
                self._queue(wanted)
        return None

    def close(self) -> None:
        """Make no more."""
        with self._lock:
            self._ends = True
            if self._process is not None:
                self._process.terminate()
        if self._thread is not None:
            self._thread.join()

    def _queue(self, wanted: Wanted) -> None:
        if len(self._waiting) >= MOST_WAITING:
            raise BlockingIOError
        self._number += 1
        self._waiting[wanted] = made_directory(self._directory / str(self._number))
        if self._thread is None:
            self._thread = Thread(target=self._make_all, name="reports", daemon=True)
            self._thread.start()

    def _make_all(self) -> None:
        """Make what waits, until nothing does."""
        while True:
            with self._lock:
                if self._ends or not self._waiting:
                    self._thread = None
                    return
                wanted, place = next(iter(self._waiting.items()))
                spawn = multiprocessing.get_context("spawn")
                self._process = spawn.Process(target=_make, args=(wanted, place), daemon=True)
                self._process.start()
            self._process.join()
            with self._lock:
                if not (place / REPORT).exists() and not (place / REFUSED).exists():
                    (place / REFUSED).write_text("its process was ended", "utf-8")
                self._made[wanted] = self._waiting.pop(wanted)
                while len(self._made) > MOST_KEPT:
                    rmtree(self._made.popitem(last=False)[1], ignore_errors=True)


def _make(wanted: Wanted, place: Path) -> None:
    """Diagnose rows under the model in force, and write the report, or why there is none."""
    from rga.diagnosis import diagnose
    from rga.twin.repository import Repository

    try:
        with Repository.open(wanted.place, read_only=True) as repository:
            view = repository.latest(wanted.source)
            record = record_of(view, wanted.first, wanted.end)
            model = Twin(view, wanted.place).corrected
        write_findings(diagnose(model, record), place)
    except Exception as error:  # whatever it is, whoever asked is told
        (place / REFUSED).write_text(in_short(error), "utf-8")
