"""What a run goes on from: written within every step, read when it is taken up again."""

from rga.errors import InputError
from rga.model import Model
from rga.twin.analysis import RealityGapAnalysis
from rga.twin.archive import Archive
from rga.twin.calibration.capture import ContextCapture
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.learning import read
from rga.twin.calibration.learning import written as stored
from rga.twin.calibration.states import State
from rga.twin.digital_twin import DigitalTwin
from rga.twin.repository import Run
from rga.twin.restore import replay, standing_of

#: estimators that the calibration holds, by the names under which they are kept
ESTIMATORS = ("learned", "sound", "given")
#: name under which a state is kept, by its number
STATE = "state {}"


class Checkpoint:
    """Keeps where a run stands, and brings its parts back there.

    Args:
        archive: keeps it.
        twin: that follows the log.
        analysis: that knows what is next.
        calibration: that knows the rows, and infers their contexts.
        model: as it was given.
        own: whether an estimator of the caller's own infers.

    Attributes:
        stale: whether another version of the model is in force than was learned about.
    """

    def __init__(
        self,
        archive: Archive,
        twin: DigitalTwin,
        analysis: RealityGapAnalysis,
        calibration: ContextCapture,
        model: Model,
        own: bool,
    ) -> None:
        self._archive, self._twin = archive, twin
        self._analysis, self._calibration = analysis, calibration
        self._model, self._own = model, own
        self._kept: dict[str, ContextEstimator | None] = dict.fromkeys(ESTIMATORS)
        self._states: list[State] = []
        self.stale = False

    def keep(self) -> None:
        """Keep where the run stands, within the step that is open."""
        standing, calibration = self._analysis.standing, self._calibration
        row = max(0, standing.row - 1)
        standing.draws, standing.inference = calibration.draws, calibration.inference
        standing.optimism, standing.state = calibration.optimism, calibration.state
        standing.own = self._own
        if not self.stale:
            standing.learned_under = self._twin.state.version
        self._archive.keep("standing", standing.model_dump_json().encode(), row)
        self._archive.keep_state("synchrony", self._analysis.synchrony.to_bytes())
        if standing.calibrated:
            self._archive.keep_state("rows", calibration.rows.to_bytes())
            self._archive.keep_state("memories", calibration.rows.memories.to_bytes())
        for name in ESTIMATORS:
            estimator: ContextEstimator | None = getattr(calibration, name)
            if estimator is not None and estimator is not self._kept[name]:
                self._archive.keep_state(name, stored(estimator))
                self._kept[name] = estimator
        for number, state in enumerate(calibration.states):
            if state not in self._states[number : number + 1]:
                self._archive.keep_state(STATE.format(number), state.to_bytes())
        self._states = calibration.states.copy()

    def take_up(self) -> bool:
        """Go on where the repository says that the run stands.

        Returns:
            Whether it has begun.

        Raises:
            InputError: it cannot be taken up by what is at hand.
        """
        view, channels = self._archive.run, self._twin.station.channels
        if view.steps == 0:
            return False
        standing = self._analysis.standing = standing_of(view)
        self._check_learner()
        if view.kept("station") != self._twin.station.to_json().encode():
            raise InputError(
                "its first row or its channels are not those that the run began with",
                f"rows of {view.identity.source!r}",
                "bring back what they came from, or begin another run",
            )
        self._archive.excluded = standing.excluded
        self._twin.state = replay(view, channels)
        synchrony = view.state("synchrony")
        assert synchrony is not None  # every step keeps it
        self._analysis.synchrony.restore(synchrony)
        self.compare_version()
        if not self._own:
            self._read_estimators(view)
        if (memories := view.state("memories")) is not None:
            self._calibration.rows.memories.restore(memories)
        learned, sound, given = (self._kept[name] for name in ESTIMATORS)
        self._calibration.take_up(
            view.rows, view.state("rows"), standing, learned, sound, given, self._states.copy()
        )
        return True

    def compare_version(self) -> None:
        """Note whether another version is in force than was learned about."""
        learned_under = self._analysis.standing.learned_under
        self.stale = learned_under != self._twin.state.version

    def _read_estimators(self, view: Run) -> None:
        """Those that infer, and those of the states that were kept."""
        in_force = self._twin.state.version
        for name in ("given",) if self.stale else ESTIMATORS:
            content, version = view.state(name), 1 if name == "given" else in_force
            if content is not None:
                self._kept[name] = read(content, self._twin.simulation(version))
        while (content := view.state(STATE.format(len(self._states)))) is not None:
            self._states.append(State.from_bytes(content, self._twin.simulation))
        number = self._analysis.standing.state
        if number is not None and not self.stale:
            self._kept["learned"] = self._states[number].estimator

    def _check_learner(self) -> None:
        """A run is resumed by what learned in it, which the repository keeps of rga's own alone."""
        standing, place = self._analysis.standing, f"model {self._model.name!r}"
        if standing.own != self._own:
            whose = "the caller's own estimator" if standing.own else "an estimator of rga"
            raise InputError(f"{whose} learned in this run", place, "begin a new run")
        if standing.own and standing.stage != "done":
            problem = "a run by the caller's own estimator cannot be resumed"
            raise InputError(problem, place, "begin a new run")
