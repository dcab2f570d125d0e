"""A run of the twin between two steps: where the repository says that it stands."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from threadpoolctl import threadpool_limits

from rga.errors import InputError
from rga.findings import Findings
from rga.model import Model
from rga.numerics.seeds import as_seed
from rga.records import Record
from rga.twin.analysis import RealityGapAnalysis
from rga.twin.archive import Archive
from rga.twin.calibration.capture import ContextCapture
from rga.twin.calibration.estimator import Learn
from rga.twin.checkpoint import Checkpoint
from rga.twin.commands.command import AnyCommand, Rollback
from rga.twin.commands.desk import CommandDesk
from rga.twin.digital_twin import DigitalTwin
from rga.twin.hardware.interface import HardwareInterface
from rga.twin.hardware.recorded import Recorded
from rga.twin.hardware.stored import Stored, length_of
from rga.twin.history import Event, History
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.past.past_diagnosis import PastDiagnosis
from rga.twin.repository import Identity, Repository, Run
from rga.twin.repository.faults import RepositoryFault
from rga.twin.repository.sqlite import PATIENCE
from rga.twin.restore import given_model, history_of
from rga.twin.rows.retention import forget_what_is_old
from rga.twin.settings import Settings
from rga.twin.versions import beyond, with_ends, written

Progress = Callable[[str, float], None]
WRITTEN = ("findings.json", "model.json", "report.html")
#: stages that wait for rows, or for nothing
CALM = ("gather", "watch", "report", "done")
#: stages in which nothing is learned about a version that was put in force by hand
UNLEARNED = ("gather", "calibrate", "report", "done")


@contextmanager
def taken_up(
    model: Model,
    record: Record | HardwareInterface,
    place: str | Path,
    settings: Settings,
    seed: int,
    progress: Progress | None = None,
    learn: Learn | None = None,
    patience: float = PATIENCE,
) -> Iterator["Running"]:
    """A run where its repository says that it stands, or a new one, to be played step by step.

    Args:
        model: as it was given.
        record: what was measured, or where rows come from.
        place: of the repository: a file, a directory that holds `twin.sqlite`, or a URL.
        settings: level of integration and the rest.
        seed: of everything random.
        progress: called with a stage and the share of it that is done.
        learn: what learns to infer contexts, in place of what the settings name.
        patience: how long to wait for another process that plays the run [s].

    Raises:
        InputError: the repository cannot be used, it holds rows that never arrived, or the seed is
            none.
    """
    seed = as_seed(seed)
    digest = model.sha256 or written(model)[1]
    hardware = Recorded(record, model) if isinstance(record, Record) else record
    identity = Identity(digest, hardware.source, seed, settings.model_dump_json())
    with threadpool_limits(1), Repository.open(place, patience=patience) as kept:
        running = Running(model, hardware, kept.run(identity), settings, seed, progress, learn)
        if running.row > hardware.rows:
            raise InputError(
                f"{running.row} rows were taken in, and {hardware.rows} have ever arrived",
                hardware.source,
                "bring the inbox and the repository back from one copy",
            )
        yield running


@contextmanager
def reopened(place: str | Path, source: str | None = None) -> Iterator["Running"]:
    """The run last acted on in a repository, from what it holds alone, to be asked for something.

    Args:
        place: of the repository: a file, a directory that holds `twin.sqlite`, or a URL.
        source: where its rows come from; None: from anywhere.

    Raises:
        InputError: nothing has run there, or the repository cannot be used.
    """
    with Repository.open(place, read_only=True) as repository:
        identity = repository.latest(source).identity
    with threadpool_limits(1), Repository.open(place) as repository:
        kept = repository.run(identity)
        hardware, settings = Stored(kept), Settings.model_validate_json(identity.settings)
        yield Running(given_model(kept), hardware, kept, settings, identity.seed, None)


class Running:
    """A run between two steps.

    Args:
        model: as it was given.
        hardware: where rows come from.
        kept: the run in the repository.
        settings: level of integration and the rest.
        seed: of everything random.
        progress: called with a stage and the share of it that is done.
        learn: what learns to infer contexts, in place of what the settings name.

    Attributes:
        resumed_at: row at which an interrupted run was taken up; None for a new one.
    """

    def __init__(
        self,
        model: Model,
        hardware: HardwareInterface,
        kept: Run,
        settings: Settings,
        seed: int,
        progress: Progress | None,
        learn: Learn | None = None,
    ) -> None:
        self._model, self._settings, self._seed = model, settings, seed
        self._progress = progress or (lambda stage, done: None)
        self._hardware, station = hardware, hardware.station
        self._pace = settings.pace(length_of(hardware, settings))
        self._twin = DigitalTwin(model, station)
        self._archive = Archive(kept, model, station, self._twin.simulation)
        exchange = QueryResponse(self._twin, self._archive)
        self.calibration = ContextCapture(
            exchange, self._archive, station, model, settings, seed, self._progress, learn
        )
        self.analysis = RealityGapAnalysis(
            exchange, self._archive, station, self.calibration, settings, self._pace, self._label
        )
        self._closing: Findings | None = None
        self.resumed_at: int | None = None
        self._diagnosis = PastDiagnosis(
            model, hardware, self._archive, settings.criteria, seed, self._progress
        )
        self._checkpoint = Checkpoint(
            self._archive, self._twin, self.analysis, self.calibration, model, learn is not None
        )
        self._desk = CommandDesk(
            self.analysis, self._archive, self.calibration, station, settings, self._pace
        )
        if self._checkpoint.take_up():
            self.resumed_at = self.row

    @property
    def stage(self) -> str:
        """What is to be done next."""
        return self.analysis.standing.stage

    @property
    def row(self) -> int:
        """The next row of the record."""
        return self.analysis.standing.row

    @property
    def rows(self) -> int:
        """Rows that have arrived."""
        return self._hardware.rows

    @property
    def is_short(self) -> bool:
        """Whether the next step takes little time: it learns nothing, and asks no diagnosis."""
        return not self._checkpoint.stale and self.stage in ("gather", "watch", "report", "done")

    @property
    def due(self) -> bool:
        """Whether there is something to do: a packet that is full, or work on rows that are there.

        When rows arrive therefore never changes what comes of them.
        """
        if not self.calm:
            return True
        if self.stage in ("report", "done"):
            return False
        return self._hardware.ended or self._waiting >= self._wanted

    @property
    def calm(self) -> bool:
        """Whether nothing is begun: a command does not break anything off."""
        return self.stage in CALM and not self._to_learn

    @property
    def _to_learn(self) -> bool:
        """Whether a version was put in force by hand that is to be learned about."""
        return self._checkpoint.stale and self.stage not in UNLEARNED

    @property
    def version(self) -> int:
        """Number of the model version in force."""
        return self._twin.state.version

    @property
    def out_of_sync(self) -> bool:
        """Whether readings have left what the model lets expect, and nothing explains it yet."""
        return self.analysis.standing.out_of_sync

    @property
    def events(self) -> list[Event]:
        """What happened since this process took the run up."""
        return self._archive.events

    @property
    def gap(self) -> float:
        """Standardised gap of the last packet; NaN where none was followed yet [-]."""
        return self.calibration.rows.gap(max(0, self.row - self._pace.packet), self.row)

    def step(self) -> None:
        """Do what is next, and have it acknowledged by the repository."""
        if self.stage == "initialise":
            self._initialise()
        elif self._to_learn:
            with self._archive.step():
                self.analysis.take_up_version()
                self._checkpoint.stale = False
                self._checkpoint.keep()
        elif self.stage in ("diagnose", "close"):
            self._diagnose(self.stage == "close")
        else:
            with self._archive.step():
                self._advance()
                forget_what_is_old(self.analysis.standing, self._archive, self.calibration.ledger)
                self._checkpoint.keep()
            self._hardware.taken(len(self.calibration.ledger))
            self._progress("stream", self.row / max(1, self.rows))

    def postpone(self, why: str) -> None:
        """Go on without the diagnosis that is next; it is asked for again later."""
        with self._archive.step():
            self.analysis.postpone(why)
            self._checkpoint.keep()

    def carry_out(self, command: AnyCommand, number: int | None = None) -> str:
        """Do what somebody asks for, as a step of its own.

        Args:
            command: what is asked.
            number: of it in an inbox, if it comes from there.

        Returns:
            What came of it, in words.

        Raises:
            InputError: it cannot be done; the run is to be taken up anew.
        """
        with self._archive.step():
            outcome = self._desk.carry_out(command)
            if isinstance(command, Rollback):
                self._checkpoint.compare_version()
            self._note(number)
        return outcome

    def refuse(self, command: AnyCommand, number: int, why: str) -> None:
        """Write down that a command of an inbox could not be carried out."""
        with self._archive.step():
            self._desk.refuse(command, why)
            self._note(number)

    @property
    def commanded(self) -> int:
        """Number of the last command that was taken from an inbox."""
        return self.analysis.standing.commanded

    def _note(self, number: int | None) -> None:
        if number is not None:
            self.analysis.standing.commanded = number
        self._checkpoint.keep()

    def findings(self) -> Findings:
        """Findings of the closing diagnosis, with their account."""
        if self._closing is None:
            self._closing = self._ask_diagnosis()
        return self._closing

    def stored_findings(self) -> Findings:
        """The same as the repository keeps them, without the account."""
        return Findings.model_validate_json(self._archive.run.findings()[-1].findings)

    def is_written(self, directory: Path) -> bool:
        """Whether the files in a directory are those of this run, and not of another."""
        path = directory / "findings.json"
        if not all((directory / name).exists() for name in WRITTEN):
            return False
        return path.read_text(encoding="utf-8") == self.stored_findings().to_json() + "\n"

    def history(self) -> History:
        """What the run left behind so far."""
        return history_of(self._archive.run)

    def end(self) -> None:
        """Note that the files are written."""
        self.analysis.standing.stage = "done"
        with self._archive.step():
            self._checkpoint.keep()

    def _initialise(self) -> None:
        with self._archive.step():
            answer = self.analysis.initialise()
            self._archive.keep("station", self._hardware.station.to_json().encode(), 0)
            self._checkpoint.keep()
        if not answer.adequate:
            raise InputError(
                f"the model cannot represent what a calibration needs: it lacks "
                f"{'; '.join(answer.missing)}",
                f"model {self._model.name!r}",
                "add that, or leave the channel out",
            )

    def _advance(self) -> None:
        analysis, stage = self.analysis, self.stage
        if stage == "calibrate":
            analysis.calibrate()
            self._checkpoint.stale = False
            return
        if stage == "recalibrate":
            analysis.recalibrate()
            return
        rows = min(self._wanted, self._waiting)
        if rows:
            packet = self._hardware.packet(len(self.calibration.ledger), rows)
            self._archive.receive(packet)
            self.calibration.receive(self._archive.used(packet))
        if stage == "gather":
            analysis.gather()
            self._check_calibration(rows)
        elif rows:
            analysis.watch()
        else:
            analysis.end()

    @property
    def _wanted(self) -> int:
        """Rows of the next packet, where it is full."""
        if self.stage != "gather":
            return self._pace.packet
        return min(self._pace.packet, self._pace.calibration_rows - len(self.calibration.ledger))

    @property
    def _waiting(self) -> int:
        """Rows that have arrived and were not taken in."""
        return self._hardware.rows - len(self.calibration.ledger)

    def _check_calibration(self, added: int) -> None:
        if self.stage == "gather" and not added:
            raise InputError(
                f"the calibration wants {self._pace.calibration_rows} rows, and no more than "
                f"{len(self.calibration.ledger)} have come",
                "setting calibration_rows",
                "give fewer, or more rows",
            )

    def _diagnose(self, closing: bool) -> None:
        try:
            findings = self._ask_diagnosis()
        except InputError as error:
            if closing or isinstance(error, RepositoryFault):
                raise
            self.postpone(str(error))
            return
        if closing:
            self._closing = findings
        effects = with_ends(
            beyond(self._model, findings.account.extended), self._label(self.row - 1)
        )
        with self._archive.step():
            self.analysis.conclude(findings, effects, closing)
            self._checkpoint.keep()

    def _ask_diagnosis(self) -> Findings:
        """What has changed since the calibration, if it has; else what was wrong all along."""
        analysis = self.analysis
        return self._diagnosis.ask(analysis.standing, analysis.changed, self.calibration.given)

    def _label(self, row: int) -> str | float:
        if not len(self.calibration.ledger):
            return self._hardware.station.time_label(0.0)
        time = self.calibration.ledger.rows(row, row + 1).time
        return self._hardware.station.time_label(float(time[0]))
