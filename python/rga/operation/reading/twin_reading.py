"""A twin that is served, kept open for those who look at it."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from threading import RLock

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.operation.reading.overview import Overview, Trace, as_trace
from rga.operation.reading.twin_now import TwinNow, twin_now
from rga.twin.calibration.channel_noise import noise_of
from rga.twin.hardware.interface import LIVE
from rga.twin.history import Event
from rga.twin.repository import (
    Identity,
    Proposal,
    Repository,
    RunView,
    StoredCommand,
    StoredReadings,
)
from rga.twin.repository.database import FILE_NAME
from rga.twin.repository.faults import NothingThere
from rga.twin.restore import standing_of
from rga.twin.twin import Twin

#: rows that are read as they are; more are shown as blocks
MOST_ROWS = 4096
#: rows that are read at a time, and how long others may look at the twin before the next [s]
BATCH, REST = 20_000, 0.001


@dataclass(frozen=True)
class Series:
    """What was measured, simulated and inferred over a time.

    Attributes:
        sensors: names of the columns of `measured`, `simulated` and `gap`.
        contexts: names of the columns of `inferred`.
        measured, simulated, gap: over time [s since the first row]; the gap is a squared
            difference over the variance of the noise [-].
        inferred: contexts.

    What is simulated and inferred, and the gap, are by the version that was in force then.
    """

    sensors: tuple[str, ...]
    contexts: tuple[str, ...]
    measured: Trace
    simulated: Trace
    gap: Trace
    inferred: Trace


class TwinReading:
    """What others see of a twin: nothing here changes it.

    Args:
        name: of the twin.
        directory: of it.
        repository: URL of a PostgreSQL database; None: it is in the directory.

    Example: `TwinReading("east", Path("data/east"), None).now()` tells where it stands, or is None
    before it has begun.
    """

    def __init__(self, name: str, directory: Path, repository: str | None) -> None:
        self.name = name
        self.place: str | Path = repository or directory
        self._file = None if repository else directory / FILE_NAME
        self._lock = RLock()
        self._repository: Repository | None = None
        self._run: tuple[Identity, datetime] | None = None
        self._begin_anew()

    def _begin_anew(self) -> None:
        """Leave what was read so far."""
        self._twin: Twin | None = None
        self._steps = -1
        self._now: TwinNow | None = None
        self._noise: FloatArray | None = None
        self._measured: Overview | None = None
        self._followed: Overview | None = None

    def close(self) -> None:
        """Close the connections; they open again where more is asked."""
        with self._lock:
            if self._repository is not None:
                self._repository.close()
            self._repository = None

    @property
    def twin(self) -> Twin | None:
        """The twin as it stands; None before it has begun.

        Raises:
            InputError: its repository cannot be read.
        """
        with self._lock:
            view = self._view()
            if view is None:
                return None
            run = view.identity, view.begun_at
            if run != self._run or view.steps < self._steps:
                # Another run, or a copy of before, has taken the place of what was read.
                self._begin_anew()
                self._run = run
            if self._twin is None or view.steps != self._steps:
                # All that is read of it is of one step, whatever is added at this moment; where it
                # cannot be read, what was read before is not taken for it.
                steps = view.steps
                self._twin, self._now = Twin(view.at_step(steps), self.place), None
                self._steps = steps
            return self._twin

    def now(self) -> TwinNow | None:
        """Where the twin stands; None before it has begun.

        Raises:
            InputError: its repository cannot be read.
        """
        with self._lock:
            twin = self.twin
            if twin is None:
                return None
            if self._now is None:
                view = self._begun().at_step(self._steps)
                self._now = twin_now(twin, view, dict(zip(*self._noise_by_name(twin), strict=True)))
            return self._now

    def as_of(self, elapsed: float) -> TwinNow | None:
        """Where the twin stood when its rows had reached a time [s since the first].

        Returns:
            None where it had not begun then.

        Raises:
            InputError: its repository cannot be read.
        """
        with self._lock:
            twin = self.twin
            if twin is None:
                return None
            past = self._begun().as_of(time=max(0.0, elapsed))
            if past.row < 0 or not past.versions():
                return None
            noise = dict(zip(*self._noise_by_name(twin), strict=True))
            return twin_now(Twin(past, self.place), past, noise)

    def events(self) -> tuple[Event, ...]:
        """What happened to the twin, in order."""
        view = self._view()
        return () if view is None else view.events()

    def proposals(self) -> tuple[Proposal, ...]:
        """Changes of the model that diagnoses proposed."""
        view = self._view()
        return () if view is None else view.proposals()

    def commands(self) -> tuple[StoredCommand, ...]:
        """What people asked for, and what came of it."""
        view = self._view()
        return () if view is None else view.commands()

    def view(self) -> RunView | None:
        """The run of the twin, for reading; None before it has begun."""
        return self._view()

    def series(self, begin: float, end: float, points: int) -> Series | None:
        """What was measured and simulated within a time.

        Args:
            begin, end: [s since the first row].
            points: entries at most.

        Returns:
            None before the twin has begun.
        """
        asked: int | None = None
        while True:
            with self._lock:
                twin = self.twin
                if twin is None:
                    return None
                view = self._begun().at_step(self._steps)
                # Rows that come while it is read are not waited for: they may come on and on.
                asked = view.rows if asked is None else asked
                traces = self._traces(view, twin, asked, begin, end)
                if traces is not None:
                    channels, contexts = twin.station.channels, tuple(twin.given.context)
                    return Series(channels, contexts, *(one.at_most(points) for one in traces))
            time.sleep(REST)

    def elapsed(self, moment: datetime) -> float:
        """Seconds from the first row to a moment; 0 before the twin has begun."""
        twin = self.twin
        if twin is None:
            return 0.0
        return (moment - datetime.fromisoformat(str(twin.station.start))).total_seconds()

    def _traces(
        self, view: RunView, twin: Twin, asked: int, begin: float, end: float
    ) -> tuple[Trace, ...] | None:
        """The traces of a series; None where more of a long past has to be read first.

        Args:
            asked: rows that have to be there, if the twin still has so many.
        """
        first, last = view.row_at(begin), view.row_at(end) + 1
        if last - first <= MOST_ROWS:
            return self._as_they_are(view, twin, max(0, first), last, begin, end)
        is_all, measured, followed = self._grown(view, twin, asked)
        if not is_all:
            return None
        every, n = followed.between(begin, end), len(twin.station.channels)
        return (
            measured.between(begin, end),
            _columns(every, slice(0, n)),
            _columns(every, slice(n, 2 * n)),
            _columns(every, slice(2 * n, None)),
        )

    def _as_they_are(
        self, view: RunView, twin: Twin, first: int, last: int, begin: float, end: float
    ) -> tuple[Trace, ...]:
        seen = view.measured(first, last)
        inside = (seen.time >= begin) & (seen.time < end)
        moments = seen.time
        followed = self._followed_rows(view, twin, first, last)
        n = len(twin.station.channels)
        parts = (
            seen.readings.reshape(len(moments), n),
            followed[:, :n],
            followed[:, n : 2 * n],
            followed[:, 2 * n :],
        )
        return tuple(as_trace(moments[inside], one[inside]) for one in parts)

    def _grown(self, view: RunView, twin: Twin, asked: int) -> tuple[bool, Overview, Overview]:
        """The past in blocks, with some rows more, and whether all that are asked for are there.

        A long past is read once, and by nobody who does not look at it. Rows that are forgotten
        later stay in it.

        Raises:
            InputError: the repository lacks rows.
        """
        n, contexts = len(twin.station.channels), len(twin.given.context)
        if self._measured is None or self._followed is None:
            self._measured, self._followed = Overview(n), Overview(2 * n + contexts)
        rows, first = view.rows, self._measured.rows
        if first < rows:
            seen = self._whole(view, first, min(rows, first + BATCH))
            self._measured.append(seen.time, seen.readings.reshape(len(seen.time), n))
        standing = standing_of(view)
        known, first = standing.row if standing.calibrated else 0, self._followed.rows
        if first < known:
            last = min(known, first + BATCH)
            moments = self._whole(view, first, last).time
            self._followed.append(moments, self._followed_rows(view, twin, first, last))
        reached = self._measured.rows >= min(asked, rows)
        is_all = reached and self._followed.rows >= min(asked, known)
        return is_all, self._measured, self._followed

    def _whole(self, view: RunView, first: int, last: int) -> StoredReadings:
        """Rows that have to be there; without them a past would be read for ever."""
        seen = view.measured(first, last)
        if len(seen.rows) != last - first:
            raise InputError(
                f"rows {first} to {last - 1} are not all there",
                f"repository of twin {self.name!r}",
                "restore it from a copy",
            )
        return seen

    def _followed_rows(self, view: RunView, twin: Twin, first: int, last: int) -> FloatArray:
        """Simulated, gap and inferred contexts of rows, at the time, float[n, 2 channels + k]."""
        n, contexts = len(twin.station.channels), len(twin.given.context)
        found = np.full((max(0, last - first), 2 * n + contexts), np.nan)
        gaps = view.gaps(first, last, at_the_time=True)
        if len(gaps.rows):
            _, noise = self._noise_by_name(twin)
            found[gaps.rows - first, :n] = gaps.simulated
            found[gaps.rows - first, n : 2 * n] = gaps.gaps / np.array(noise) ** 2
        inferred = view.inferred(first, last, at_the_time=True)
        if len(inferred.rows):
            found[inferred.rows - first, 2 * n :] = inferred.contexts
        return found

    def _noise_by_name(self, twin: Twin) -> tuple[Sequence[str], Sequence[float]]:
        """Standard deviation of a row of each sensor, from the rows of the calibration."""
        channels = twin.station.channels
        if self._noise is None:
            view = self._begun()
            standing = standing_of(view)
            told = view.measured(0, standing.calibrated or 1).readings
            stated = [twin.given.sensors[name].noise for name in channels]
            stuck = np.array([name in standing.stuck for name in channels], dtype=np.bool_)
            found = noise_of(stated, told.reshape(-1, len(channels)), stuck)
            if not standing.calibrated:
                return channels, found.tolist()
            self._noise = found
        return channels, self._noise.tolist()

    def _begun(self) -> RunView:
        view = self._view()
        if view is None:
            raise InputError("it has not begun", f"twin {self.name!r}", "wait for its first rows")
        return view

    def _view(self) -> RunView | None:
        with self._lock:
            if self._repository is None:
                if self._file is not None and not self._file.exists():
                    return None
                try:
                    self._repository = Repository.open(self.place, read_only=True)
                except NothingThere:
                    return None
            source = f"{LIVE}{self.name}"
            runs = [one for one in self._repository.runs() if one.identity.source == source]
            begun = [one for one in runs if one.kept("station") is not None]
            return begun[-1] if begun else None


def _columns(trace: Trace, which: slice) -> Trace:
    parts = (trace.mean, trace.least, trace.most)
    return Trace(trace.time, *(one[:, which] for one in parts))
