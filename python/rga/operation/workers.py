"""The processes that play the twins of a service: each is begun anew when it ends."""

import multiprocessing
import signal
import time
from collections.abc import Callable, Sequence
from ctypes import c_int
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from pathlib import Path
from threading import Event, Thread
from typing import TYPE_CHECKING

from rga.lazy import importing_much

if TYPE_CHECKING:
    from rga.jobs.worker import Kind

#: how long a worker rests where nothing is due [s]: a row is waited for by people, and each look of
#: those who do what takes long keeps it from being played for a moment
RESTS: dict["Kind", float] = {"watch": 0.05, "heavy": 0.5}
#: how often what a worker tells is read [s]
HEARD = 0.2
#: so many workers that end at the same twin within a time [s] are taken for its fault
MOST_ENDS, REMEMBERED = 3, 3600.0
KINDS: tuple["Kind", ...] = ("watch", "heavy")
NONE = -1


class Workers:
    """Plays the twins of a service, short steps and long ones in processes of their own.

    What a worker was at when it was killed is done again by the next. A twin at which workers
    ended three times within an hour is left alone, so that the others are played.

    Args:
        places: directories of the twins.
        repository: URL of a PostgreSQL database, or None.
        has_room: whether the disk has room for long steps, asked by processes to which it is sent.
    """

    def __init__(
        self, places: Sequence[Path], repository: str | None, has_room: Callable[[], bool]
    ) -> None:
        self._places, self._repository, self._has_room = list(places), repository, has_room
        self._spawn = multiprocessing.get_context("spawn")
        #: when workers ended at each twin [s, monotonic]
        self._ended: dict[Path, list[float]] = {}
        self._at: dict[Kind, tuple[list[Path], c_int]] = {}
        self._told: dict[Kind, dict[Path, str]] = {}
        self._left_alone: dict[Path, str] = {}
        self._ending = Event()
        self._threads: list[Thread] = []

    @property
    def failed(self) -> dict[Path, str]:
        """Why a twin cannot be played, by its directory."""
        found = dict(self._left_alone)
        for told in list(self._told.values()):
            found |= told
        return found

    @property
    def at(self) -> dict["Kind", Path]:
        """The twins that are played right now, by the kind of worker."""
        found = [(kind, places, at.value) for kind, (places, at) in list(self._at.items())]
        return {kind: places[number] for kind, places, number in found if number != NONE}

    def start(self) -> None:
        """Begin to play."""
        self._threads = [
            Thread(target=self._keep_one, args=[kind], name=f"worker {kind}", daemon=True)
            for kind in KINDS
        ]
        for thread in self._threads:
            thread.start()

    def stop(self) -> None:
        """End: what a worker is at is done again by the next."""
        self._ending.set()
        for thread in self._threads:
            thread.join()

    def _keep_one(self, kind: "Kind") -> None:
        """A worker of a kind, and another when it ends."""
        # A terminal interrupts all of its processes, and the service ends its workers itself: they
        # have from this thread, from their first moment on, that nothing interrupts them. What
        # multiprocessing begins beside the first process would undo it, and so is begun before.
        resource_tracker.ensure_running()
        signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])
        while not self._ending.is_set():
            places = [one for one in self._places if one not in self._left_alone]
            # Without a lock, which a worker that is killed might hold for ever.
            at = self._spawn.RawValue("i", NONE)
            self._at[kind] = places, at
            here, there = self._spawn.Pipe(duplex=False)
            work = (places, kind, self._repository, self._has_room, at, there)
            process = self._spawn.Process(target=_play, args=work, name=kind, daemon=True)
            process.start()
            there.close()
            self._listen(kind, process, here)
            if not self._ending.is_set():
                self._count(places, at.value, process.exitcode)

    def _listen(
        self, kind: "Kind", process: BaseProcess, told: "Connection[object, object]"
    ) -> None:
        """Hear which twins fail until the worker ends, or everything does."""
        while process.is_alive() and not self._ending.is_set():
            try:
                if told.poll(HEARD):
                    self._told[kind] = dict(told.recv())  # type: ignore[call-overload]
            except (EOFError, OSError):
                self._ending.wait(HEARD)
        process.terminate()
        process.join()
        told.close()

    def _count(self, places: Sequence[Path], at: int, code: int | None) -> None:
        if at == NONE:
            # It ended at nothing: another may fare better a little later.
            self._ending.wait(1.0)
            return
        place, now = places[at], time.monotonic()
        ended = [one for one in self._ended.get(place, []) if now - one < REMEMBERED]
        self._ended[place] = [*ended, now]
        if len(self._ended[place]) >= MOST_ENDS:
            words = f"its worker ended {MOST_ENDS} times (exit code {code}): is there memory?"
            self._left_alone[place] = words


def _play(
    places: Sequence[Path],
    kind: "Kind",
    repository: str | None,
    has_room: Callable[[], bool],
    at: c_int,
    told: "Connection[object, object]",
) -> None:
    """What a worker does until it is ended, or the service is gone."""
    # The service itself plays no twin, and starts without what that takes.
    with importing_much():
        from rga.jobs.worker import Worker

    worker, before = Worker(places, [kind], repository, has_room), dict[Path, str]()
    service = multiprocessing.parent_process()

    def looks(directory: Path | None) -> None:
        at.value = NONE if directory is None else places.index(directory)

    while service is None or service.is_alive():
        if not worker.round(looks):
            time.sleep(RESTS[kind])
        if worker.failed != before:
            before = dict(worker.failed)
            told.send(before)
