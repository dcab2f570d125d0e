"""A twin of a structure whose readings go on arriving."""

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from threading import RLock
from typing import Self

from rga.errors import InputError
from rga.files import as_path
from rga.given import as_record
from rga.jobs.begin import begun
from rga.jobs.run import concluded
from rga.model import Model, model_of_text
from rga.records import Record, RecordMapping, RecordSource
from rga.records.frames import is_frame, table_of_frame
from rga.records.mapping import read_mapping
from rga.records.sources import find_sources, named_files
from rga.twin.commands.command import AnyCommand, Command, read_command
from rga.twin.hardware.inbox import INBOX, Inbox
from rga.twin.hardware.interface import LIVE, Station
from rga.twin.hardware.live import Live, as_rows, station_for
from rga.twin.history import Event
from rga.twin.outcome import Outcome
from rga.twin.repository import Repository
from rga.twin.repository.database import FILE_NAME
from rga.twin.repository.faults import RepositoryFault
from rga.twin.repository.sqlite import PATIENCE
from rga.twin.restore import standing_of
from rga.twin.runner import Progress, Running, taken_up
from rga.twin.settings import Settings
from rga.twin.twin import Twin


@dataclass(frozen=True)
class Fed:
    """What became of rows that were fed.

    Attributes:
        new: rows that are kept.
        left_out: rows that are no later than what was there: they were fed before, or come too
            late.
    """

    new: int
    left_out: int


class LiveTwin:
    """A twin in a directory, which takes rows as they come; `rga.live` makes one.

    Rows are fed by any thread or process and are on the disk when `feed` returns; `play` lets the
    twin take them in, in packets that are full, so that what comes of them does not hang on when
    or how they arrived: `rga.run` on the same rows says the same. One process plays at a time.

    Args:
        directory: of the twin.
        repository: URL of a PostgreSQL database, in place of the file in the directory.
        progress: called with a stage and the share of it that is done.
        patience: how long to wait for another process that plays [s].

    Attributes:
        name: of the twin.
        model: as it was given.

    Raises:
        InputError: there is no live twin in the directory.
    """

    def __init__(
        self,
        directory: str | Path,
        repository: str | None = None,
        progress: Progress | None = None,
        patience: float = PATIENCE,
    ) -> None:
        self._directory = as_path(directory, "directory")
        if not self._directory.is_dir():
            raise InputError("there is no such directory", str(directory), "begin with rga.live")
        if not (self._directory / INBOX).is_file():
            raise InputError("no live twin is here", str(directory), "begin with rga.live")
        self._inbox = Inbox(self._directory)
        known = self._inbox.addressee
        if known is None:
            self._inbox.close()
            raise InputError("no live twin is here", str(directory), "begin with rga.live")
        self.name, self._seed = known.name, known.seed
        self.model = model_of_text(known.model, str(directory), known.model_sha256)
        self._settings = Settings.model_validate_json(known.settings)
        self._place = repository or self._directory / FILE_NAME
        self._progress, self._patience = progress, patience
        self._playing, self._held = RLock(), ExitStack()
        self._running: Running | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Let another process play; whatever was fed stays."""
        with self._playing:
            self._let_go()
            self._inbox.close()

    def feed(
        self,
        rows: Record | RecordSource,
        mapping: str | Path | RecordMapping | None = None,
    ) -> Fed:
        """Keep rows for the twin; they are on the disk when this returns.

        Rows that are no later than those before are left out, so that rows of which nobody knows
        whether they were kept may be fed again. The first rows say which channels and contexts
        there are; a channel that later rows lack is missing.

        Args:
            rows: a record, a data frame, or files, as `rga.load_record` takes them.
            mapping: how to read them.

        Raises:
            InputError: the rows cannot be read or are not of this twin, or the disk is full.
        """
        record = self._as_record(rows, mapping)
        if not len(record):
            return Fed(0, 0)
        new = None
        while new is None:
            if self._inbox.ended:
                raise InputError("it has ended", f"twin {self.name!r}", "begin another")
            station = self._inbox.station
            if station is None:
                station = station_for(self.model, record)
                self._check_begun_with(station)
            new = self._inbox.put(station, *as_rows(station, record))
        return Fed(new, len(record) - new)

    def _check_begun_with(self, station: Station) -> None:
        """Whether the first rows of an inbox are those that the twin began with, if it has.

        Raises:
            InputError: they are not: an inbox was lost.
        """
        if isinstance(self._place, Path) and not self._place.exists():
            return
        with Repository.open(self._place) as repository:
            runs = [one for one in repository.runs() if one.identity.source == self._source]
            begun = runs[-1].kept("station") if runs else None
        if begun not in (None, station.to_json().encode()):
            raise InputError(
                "these rows are not those that the twin began with",
                f"twin {self.name!r}",
                "its inbox was lost: feed all rows from the first, or begin another twin",
            )

    def _as_record(
        self, rows: Record | RecordSource, mapping: str | Path | RecordMapping | None
    ) -> Record:
        """Rows as a record; a channel without a reading in them is missing."""
        station = self._inbox.station
        if isinstance(rows, Record) or station is None:
            return as_record(rows, self.model, mapping)
        if not is_frame(rows):
            paths, chosen = find_sources(named_files(rows), None, mapping)
            return as_record(paths, self.model, chosen.model_copy(update={"empty": "missing"}))
        frame, chosen = table_of_frame(rows).frame, RecordMapping()
        if isinstance(mapping, RecordMapping):
            chosen = mapping
        elif mapping is not None:
            chosen = read_mapping(mapping)
        known = {channel.column for channel in chosen.channels.values()} | {*frame.columns}
        lacking = [
            name
            for name in station.channels
            if name not in known and name not in chosen.channels and name not in chosen.unused
        ]
        unused = chosen.unused | dict.fromkeys(lacking, "no reading in these rows")
        missing = chosen.model_copy(update={"empty": "missing", "unused": unused})
        return as_record(frame, self.model, missing)

    def ask(self, command: AnyCommand) -> int:
        """Keep a command (`rga.twin.Accept` and others); `play` carries it out.

        Returns:
            Its number.

        Raises:
            InputError: it is none.
        """
        if not isinstance(command, Command):
            what = f"a {type(command).__name__} is no command"
            raise InputError(
                what, "command", "give one of rga.twin, such as Note(who=..., why=...)"
            )
        return self._inbox.ask(command.model_dump_json())

    def play(self, allowed: Callable[[Running], bool] = lambda running: True) -> list[Event]:
        """Do all that is due: full packets, and what commands ask for.

        Args:
            allowed: whether the next step may be taken here; another may take it elsewhere.

        Returns:
            What happened.

        Raises:
            InputError: another process plays, or the repository cannot be used.
        """
        happened: list[Event] = []
        with self._playing:
            if self._inbox.station is None:
                return happened
            try:
                while allowed(self._taken_up()):
                    self._carry_out_commands(happened)
                    if not self._taken_up().due:
                        break
                    self._act(self._taken_up().step, happened)
            except BaseException:
                self._let_go()
                raise
        return happened

    def end(self) -> Outcome:
        """No more rows will come: play what is left, diagnose, and write the report.

        Raises:
            InputError: too few rows have come.
        """
        wanted, rows = self._settings.pace(None).calibration_rows, self._inbox.rows
        if rows < wanted:
            raise InputError(
                f"the calibration wants {wanted} rows, and {rows} have come",
                f"twin {self.name!r}",
                "feed more rows to it",
            )
        self._inbox.end()
        with self._playing:
            self.play()
            return concluded(self._taken_up(), self._directory)

    @property
    def waiting(self) -> tuple[int, int]:
        """Rows, and commands, that `play` has not taken yet."""
        if isinstance(self._place, Path) and not self._place.exists():
            return self._inbox.rows, len(self._inbox.commands(0))
        with Repository.open(self._place, read_only=True) as repository:
            runs = [one for one in repository.runs() if one.identity.source == self._source]
            rows, commanded = (runs[-1].rows, standing_of(runs[-1]).commanded) if runs else (0, 0)
        return self._inbox.rows - rows, len(self._inbox.commands(commanded))

    @property
    def _source(self) -> str:
        return f"{LIVE}{self.name}"

    @property
    def twin(self) -> Twin:
        """The twin as its repository holds it.

        Raises:
            InputError: it has not begun.
        """
        if isinstance(self._place, Path) and not self._place.exists():
            raise InputError("it has not begun", f"twin {self.name!r}", "feed rows, and play")
        return Twin.open(self._place, self._source)

    def _taken_up(self) -> Running:
        if self._running is None:
            hardware = Live(self._inbox, self.name)
            if isinstance(self._place, Path) and not self._place.exists():
                hardware.packet(0, 1)  # else a repository that is lost would be begun anew
            self._running = self._held.enter_context(
                taken_up(
                    self.model,
                    hardware,
                    self._place,
                    self._settings,
                    self._seed,
                    self._progress,
                    patience=self._patience,
                )
            )
        return self._running

    def _let_go(self) -> None:
        self._running = None
        self._held.close()

    def _act(self, step: Callable[[], object], happened: list[Event]) -> None:
        running = self._taken_up()
        before = len(running.events)
        step()
        happened += running.events[before:]

    def _carry_out_commands(self, happened: list[Event]) -> None:
        """Do what people asked for, where that breaks nothing off."""
        for number, text in self._inbox.commands(self._taken_up().commanded):
            # What one begins comes before the next, as it would were they asked for one by one.
            if not self._taken_up().calm:
                return
            command = read_command(text)
            try:
                self._act(partial(self._taken_up().carry_out, command, number), happened)
            except RepositoryFault:
                raise
            except InputError as error:
                # What was begun is not to be gone on with.
                self._let_go()
                self._act(partial(self._taken_up().refuse, command, number, str(error)), happened)


def live(
    model: Model | str | Path,
    directory: str | Path,
    *,
    settings: Settings | str | Path | None = None,
    name: str | None = None,
    seed: int = 0,
    repository: str | None = None,
    progress: Progress | None = None,
) -> LiveTwin:
    """A twin that takes rows as they come, begun in a directory or gone on with.

    Args:
        model: the structure with its effects and sensors, or its file.
        directory: for the inbox, the repository and the report.
        settings: with calibration_rows, packet and settle, which take no share of rows that go on
            arriving.
        name: of the twin; None: that of the structure.
        seed: of everything random.
        repository: URL of a PostgreSQL database, instead of the file in the directory.
        progress: called with a stage and the share of it that is done.

    Raises:
        InputError: such a model cannot go on for ever, a setting is missing, the seed is none, or
            another twin is there.
    """
    place = begun(model, directory, settings=settings, name=name, seed=seed)
    return LiveTwin(place, repository, progress)
