"""A run of the twin between two steps: where the repository says that it stands."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from threadpoolctl import threadpool_limits

from rga.diagnosis import diagnose
from rga.errors import InputError
from rga.findings import Findings
from rga.model import Model
from rga.records import Record
from rga.twin.analysis import RealityGapAnalysis
from rga.twin.archive import Archive
from rga.twin.calibration.capture import ContextCapture
from rga.twin.calibration.estimator import ContextEstimator, Learn
from rga.twin.calibration.learning import read
from rga.twin.calibration.learning import written as stored
from rga.twin.calibration.states import State
from rga.twin.changes import diagnose_change, in_doubt
from rga.twin.digital_twin import DigitalTwin
from rga.twin.history import Event, History
from rga.twin.messages.hardware import HardwareInterface
from rga.twin.messages.middleware import InProcess
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.past.chosen_past import chosen_past, with_choice
from rga.twin.repository import Identity, Repository, Run, RunView
from rga.twin.restore import history_of, ledger_of, replay, standing_of
from rga.twin.settings import Settings
from rga.twin.versions import beyond, written

Progress = Callable[[str, float], None]
#: estimators that the calibration holds, by the names under which they are kept
ESTIMATORS = ("learned", "sound", "given")
#: name under which a state is kept, by its number
STATE = "state {}"
WRITTEN = ("findings.json", "model.json", "report.html")


@contextmanager
def taken_up(
    model: Model,
    record: Record,
    place: str | Path,
    settings: Settings,
    seed: int,
    progress: Progress | None = None,
    learn: Learn | None = None,
) -> Iterator["Running"]:
    """A run where its repository says that it stands, or a new one, to be played step by step.

    Args:
        model: as it was given.
        record: what was measured.
        place: of the repository: a file, a directory that holds `twin.sqlite`, or a URL.
        settings: level of integration and the rest.
        seed: of everything random.
        progress: called with a stage and the share of it that is done.
        learn: what learns to infer contexts, in place of what the settings name.

    Raises:
        InputError: the repository cannot be used.
    """
    digest = model.sha256 or written(model)[1]
    identity = Identity(digest, record.sha256, seed, settings.model_dump_json())
    with threadpool_limits(1), Repository.open(place) as kept:
        yield Running(model, record, kept.run(identity), settings, seed, progress, learn)


class Running:
    """A run between two steps.

    Args:
        model: as it was given.
        record: what was measured.
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
        record: Record,
        kept: Run,
        settings: Settings,
        seed: int,
        progress: Progress | None,
        learn: Learn | None = None,
    ) -> None:
        self._model, self._record, self._settings, self._seed = model, record, settings, seed
        self._progress = progress or (lambda stage, done: None)
        self._hardware = HardwareInterface(record, model)
        self._pace = settings.pace(self._hardware.rows)
        station = self._hardware.station
        self._twin = DigitalTwin(model, station)
        self._archive = Archive(kept, model, self._twin.simulation)
        exchange = QueryResponse(self._twin, self._archive)
        self.calibration = ContextCapture(
            exchange, self._archive, station, model, settings, seed, self._progress, learn
        )
        self.analysis = RealityGapAnalysis(
            exchange, self._archive, station, self.calibration, settings, self._pace, self._label
        )
        self._middleware = InProcess()
        self._middleware.subscribe(self._archive.receive)
        self._middleware.subscribe(self.calibration.receive)
        self._closing: Findings | None = None
        self.resumed_at: int | None = None
        self._kept: dict[str, ContextEstimator | None] = {}
        self._states: list[State] = []
        self._stale = False
        self._own = learn is not None
        self._recall()

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
        """Rows of the record."""
        return self._hardware.rows

    @property
    def version(self) -> int:
        """Number of the model version in force."""
        return self._twin.state.version

    @property
    def out_of_sync(self) -> bool:
        """Whether an alarm is being dealt with."""
        return self.analysis.standing.alarm is not None

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
        elif self._stale and self.stage not in ("gather", "calibrate", "report", "done"):
            with self._archive.step():
                self.analysis.take_up_version()
                self._stale = False
                self._checkpoint()
        elif self.stage in ("diagnose", "close"):
            self._diagnose(self.stage == "close")
        else:
            with self._archive.step():
                self._advance()
                self._checkpoint()
            self._progress("stream", self.row / self.rows)

    def postpone(self, why: str) -> None:
        """Go on without the diagnosis that is next; it is asked for again later."""
        with self._archive.step():
            self.analysis.postpone(why)
            self._checkpoint()

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
            self._checkpoint()

    def _initialise(self) -> None:
        with self._archive.step():
            answer = self.analysis.initialise()
            self._archive.keep("station", self._hardware.station.to_json().encode(), 0)
            self._checkpoint()
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
            return
        if stage == "recalibrate":
            analysis.recalibrate(self._all_arrived)
            return
        first, rows = len(self.calibration.ledger), self._pace.packet
        if stage == "gather":
            rows = min(rows, self._pace.calibration_rows - first)
        packet = self._hardware.packet(first, rows)
        if len(packet.time):
            self._middleware.publish(packet)
        if stage == "gather":
            analysis.gather()
        else:
            analysis.watch(self._all_arrived)

    def _diagnose(self, closing: bool) -> None:
        try:
            findings = self._ask_diagnosis()
        except InputError as error:
            if closing:
                raise
            self.postpone(str(error))
            return
        if closing:
            self._closing = findings
        effects = beyond(self._model, findings.account.extended)
        with self._archive.step():
            self.analysis.conclude(findings, effects, closing)
            self._checkpoint()

    def _ask_diagnosis(self) -> Findings:
        """What has changed since the calibration, if it has; else what was wrong all along."""
        past, given = self._record.rows(slice(0, self.row)), self.calibration.given
        model, criteria = self._model, self._settings.criteria
        changed, calibrated = self.analysis.changed, self.analysis.standing.calibrated
        events, most = self._archive.run.events(), criteria.record.most_rows
        record, choice = chosen_past(model, past, events, calibrated, most, self._seed)
        if changed and given is not None and given.found is not None:
            assert given.correction is not None
            found = diagnose_change(
                model,
                record,
                given.found,
                given.correction,
                since=past.origin + float(past.time[calibrated - 1]),
                criteria=criteria,
                seed=self._seed,
                progress=self._progress,
            )
            if found is not None:
                return with_choice(found, choice, len(past))
        findings = diagnose(
            model, record, criteria=criteria, seed=self._seed, progress=self._progress
        )
        findings = with_choice(findings, choice, len(past))
        return in_doubt(findings) if changed and not findings.causes else findings

    @property
    def _all_arrived(self) -> bool:
        return len(self.calibration.ledger) >= self._hardware.rows

    def _label(self, row: int) -> str | float:
        return self._record.time_label(float(self._record.time[row]))

    def _checkpoint(self) -> None:
        standing, row = self.analysis.standing, max(0, self.row - 1)
        calibration = self.calibration
        standing.draws, standing.inference = calibration.draws, calibration.inference
        standing.optimism, standing.state = calibration.optimism, calibration.state
        standing.learned_under, standing.own = self._twin.state.version, self._own
        self._archive.keep("standing", standing.model_dump_json().encode(), row)
        self._archive.checkpoint("synchrony", self.analysis.synchrony.to_bytes())
        for name in ESTIMATORS:
            estimator: ContextEstimator | None = getattr(calibration, name)
            if estimator is not None and estimator is not self._kept.get(name):
                self._archive.keep(name, stored(estimator), row)
                self._kept[name] = estimator
        for number, state in enumerate(calibration.states):
            if state not in self._states[number : number + 1]:
                self._archive.keep(STATE.format(number), state.to_bytes(), row)
        self._states = calibration.states.copy()

    def _recall(self) -> None:
        """Go on where the repository says that the run stands."""
        view, station = self._archive.run, self._hardware.station
        if view.steps == 0:
            return
        self.analysis.standing = standing_of(view)
        self._check_learner()
        self.resumed_at = self.row
        self._twin.state = replay(view, station.channels)
        synchrony = view.checkpoint("synchrony")
        assert synchrony is not None  # every step keeps it
        self.analysis.synchrony.restore(synchrony)
        ledger = ledger_of(
            view, len(station.channels), len(station.measured), len(self._model.context)
        )
        self._kept = dict.fromkeys(ESTIMATORS)
        # Another version may have been put in force by hand.
        self._stale = self.analysis.standing.learned_under != self._twin.state.version
        if not self._own:
            self._read_estimators(view)
        learned, sound, given = (self._kept[name] for name in ESTIMATORS)
        self.calibration.take_up(
            ledger, self.analysis.standing, learned, sound, given, self._states.copy()
        )

    def _read_estimators(self, view: RunView) -> None:
        """Those that infer, and those of the states that were kept."""
        for name in ("given",) if self._stale else ESTIMATORS:
            content, version = view.kept(name), 1 if name == "given" else self.version
            if content is not None:
                self._kept[name] = read(content, self._twin.simulation(version))
        while (content := view.kept(STATE.format(len(self._states)))) is not None:
            self._states.append(State.from_bytes(content, self._twin.simulation))
        number = self.analysis.standing.state
        if number is not None and not self._stale:
            self._kept["learned"] = self._states[number].estimator

    def _check_learner(self) -> None:
        """A run is resumed by what learned in it, which the repository keeps of rga's own alone."""
        own, place = self.analysis.standing.own, f"model {self._model.name!r}"
        if own != self._own:
            whose = "the caller's own estimator" if own else "an estimator of rga"
            raise InputError(f"{whose} learned in this run", place, "begin a new run")
        if own and self.stage != "done":
            problem = "a run by the caller's own estimator cannot be resumed"
            raise InputError(problem, place, "begin a new run")
