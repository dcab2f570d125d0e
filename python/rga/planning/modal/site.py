"""What explanations say of modes that could be measured, and how well these would be known.

A measurement of a frequency is a contrast with the windows so far, so that the error which the
model makes of a mode in all of them says nothing. More windows like those so far are no contrast:
they lower what the scatter leaves of a frequency, and not what the model does.
"""

from collections.abc import Mapping, Sequence
from copy import copy

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.likelihood import CHANGE_ERROR, MODEL_ERROR, WEATHER, standing_errors
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.modal.readings import ModalWindows
from rga.diagnosis.modal.standing import weather
from rga.diagnosis.modal.trials import ModalTrials
from rga.errors import InputError
from rga.experiments.candidates import Added, LoadTest, rest
from rga.experiments.measurement_model import Errors
from rga.experiments.truck import FACTOR, POSITION, Lane, Truck
from rga.findings.schema import Windows
from rga.model import Model
from rga.model.effect import Effect, Values, when_all_act
from rga.model.schema import ContextVariable
from rga.planning.modal.candidates import MORE_WINDOWS, PARKED_MASS, PARKED_WINDOWS, SEASON
from rga.simulation.modal.expected import SHAPE_ERROR, Expected
from rga.simulation.modal.mixed_shapes import couplings

#: error of what a test says nothing of, where all predict the same
SILENT = 1.0
#: share by which a mass may raise a frequency by what solving leaves open
RAISED = 1e-4
#: frequencies are told in per cent
PERCENT = 100.0


class ModalSite:
    """Modes of a structure, with accelerometers that could be added, and tests.

    Args:
        model: the structure with its modes.
        windows: in which they were measured so far.
        added: accelerometers.
        tests: of modes.
        lane, truck: of the tests with a known mass.
        late: what is looked for began within the windows, which know the structure without it.

    Attributes:
        sensors: names of the columns: the frequencies, then the accelerometers.
        standing: how many are frequencies.
        operating: how many measurements are shapes, one of each mode; those of the tests follow.

    Raises:
        InputError: the findings name a mode or a point that the model lacks, or the structure
            cannot swing.
    """

    def __init__(
        self,
        model: Model,
        windows: Windows,
        added: Sequence[Added],
        tests: Sequence[LoadTest],
        lane: Lane | None,
        truck: Truck | None,
        late: bool,
    ) -> None:
        self.added, self.tests, self._late = added, tests, late
        self._windows, self._found = windows, list(windows.modes.values())
        self._looks = _looks(model, windows)
        self._known: dict[str, bool] = {}
        self.sensors = [
            *(f"frequency of mode {name}" for name in windows.modes),
            *(one.name for one in added),
        ]
        self.standing = self.operating = len(windows.modes)
        contexts = dict(model.context)
        loads: dict[str, Effect] = {}
        if lane is not None and truck is not None:
            contexts[FACTOR] = ContextVariable(unit="-", range=(0.0, 1.0))
            contexts[POSITION] = ContextVariable(unit="m", range=(0.0, max(lane.length, 1.0)))
            loads = lane.effects(truck, inertia=True)
        changes = {"context": contexts, "effects": {**model.effects, **loads}}
        self._model = model.model_copy(update=changes)
        still = rest(self._model) | {
            name: (low + high) / 2 for name, (low, high) in weather(model, windows.contexts).items()
        }
        self._now = self._trials(still)
        self._states = [[self._trials(still | one) for one in self._ends(test)] for test in tests]
        nodes = {name: number for number, name in enumerate(model.nodes)}
        points = [one.point for one in added if one.point is not None]
        self._at = [nodes[one.node] for one in points]
        self._along = np.array([one.direction for one in points], dtype=float).reshape(-1, 3)

    @staticmethod
    def _ends(test: LoadTest) -> list[dict[str, float]]:
        """The states of a test that are not as the windows so far."""
        if test.kind == PARKED_MASS and test.position is not None:
            return [{FACTOR: 1.0, POSITION: test.position}]
        return [test.against, test.at] if test.kind == SEASON else []

    def _trials(self, state: Mapping[str, float]) -> ModalTrials[ModalWindows]:
        begun = when_all_act(self._model.effects.values())
        contexts: Values = {name: np.array([value]) for name, value in state.items()}
        log_f = np.log([[one.near for one in self._looks]])
        windows = ModalWindows(
            tuple(self._windows.modes), np.array([begun or 0.0]), contexts, log_f, self._looks
        )
        return ModalTrials(self._model, windows)

    def only(self, added: Sequence[int], tests: Sequence[int]) -> "ModalSite":
        """The same with some of the accelerometers and of the tests, by number."""
        other = copy(self)
        other.added = [self.added[number] for number in added]
        other.tests = [self.tests[number] for number in tests]
        other.sensors = [*self.sensors[: self.standing], *(one.name for one in other.added)]
        other._states = [self._states[number] for number in tests]
        other._at = [self._at[number] for number in added]
        other._along = self._along[list(added)]
        return other

    def unit(self, column: int) -> str:
        """Unit of a column."""
        return "%" if column < self.standing else "-"

    def without_test(self, column: int, apart: FloatArray) -> tuple[FloatArray, str]:
        """The mode in whose shape two differ most, with its weight in all measurements."""
        mode = int(np.argmax(np.abs(apart)))
        weights = np.zeros(self.operating + len(self.tests))
        weights[mode] = 1.0
        name = list(self._windows.modes)[mode]
        return weights, f"in mode {name}, whose shape so far has length one"

    def doubtful(self, effects: Mapping[str, Effect]) -> list[int]:
        """Tests in which another pairing of the modes is nearly as probable, and now it is not."""
        effects = self._on_modes(effects)
        now = self._now.predict(effects)
        found = []
        for number, (test, states) in enumerate(zip(self.tests, self._states, strict=True)):
            then = [one.predict(effects) for one in states]
            # No mass raises a frequency: where it seems to, two modes have traded their names.
            traded = test.kind == PARKED_MASS and any(
                (one.log_f - now.log_f > RAISED).any() for one in then
            )
            if traded or any(len(one.doubtful) > len(now.doubtful) for one in then):
                found.append(number)
        return found

    def measurements(self, effects: Mapping[str, Effect]) -> FloatArray:
        """What would be measured with more effects, float[measurements, sensors].

        Raises:
            InputError: the effects cannot be simulated.
        """
        effects = self._on_modes(effects)
        now = self._now.predict(effects)
        shown = np.zeros((self.operating + len(self.tests), len(self.sensors)))
        shown[: self.operating, self.standing :] = self._shape_entries(now)
        for number in range(len(self.tests)):
            shown[self.operating + number, : self.standing] = self._contrast(number, now, effects)
        return shown

    def _on_modes(self, effects: Mapping[str, Effect]) -> dict[str, Effect]:
        """Those that modes can show, as a diagnosis takes them."""
        return {name: one for name, one in effects.items() if self._shows(one)}

    def _shows(self, effect: Effect) -> bool:
        structural = effect.structural and not effect.on_sensors
        if not (structural or effect.on_modes or effect.points_named()):
            return False
        where = repr((effect.kind, effect.place))
        if where not in self._known:
            try:
                self._now.predict({where: effect})
            except InputError:  # friction and play leave no mode of their own
                self._known[where] = False
            else:
                self._known[where] = True
        return self._known[where]

    def _contrast(self, number: int, now: Prediction, effects: Mapping[str, Effect]) -> FloatArray:
        """What a test shows of every frequency [%], float[modes]."""
        ends = [one.predict(effects).log_f[0] for one in self._states[number]]
        if not ends:
            so_far = np.log([one.near for one in self._looks])
            return np.asarray(PERCENT * (now.log_f[0] - so_far))
        first = ends[0] if len(ends) > 1 else now.log_f[0]
        return np.asarray(PERCENT * (ends[-1] - first))

    def _shape_entries(self, now: Prediction) -> FloatArray:
        """Motion at the accelerometers, the measured shape of length one, float[modes, added]."""
        motion = self._motion(now.shapes)
        return np.asarray(motion * self._scales(now)[:, None])

    def _motion(self, shapes: FloatArray) -> FloatArray:
        """Of shapes float[modes, nodes, 3] at the accelerometers, float[modes, added]."""
        return np.asarray(np.einsum("map,ap->ma", shapes[:, self._at], self._along))

    def _scales(self, now: Prediction) -> FloatArray:
        """By which shapes come to the length and sign of the measured ones; zero without any."""
        own = now.at_points
        scales = np.zeros(len(self._looks))
        for mode, look in enumerate(self._looks):
            there = own[mode, look.at]
            length = float(np.linalg.norm(there))
            if length > 0.0:
                scales[mode] = np.sign(float(there @ look.shape) or 1.0) / length
        return scales

    def errors(self, effects: Mapping[str, Effect]) -> Errors:
        """The errors about the structure with effects.

        What the model makes of a known mass is off alike in a mode wherever that stands.
        """
        effects = self._on_modes(effects)
        now = self._now.predict(effects)
        shared = np.zeros((self.standing, self.operating + len(self.tests), len(self.sensors)))
        noise = np.full((self.operating + len(self.tests), len(self.sensors)), SILENT)
        noise[: self.operating, self.standing :] = self._shape_errors(now)
        for number, test in enumerate(self.tests):
            if test.kind == MORE_WINDOWS:
                own = self._level_errors(now)
            elif test.kind == SEASON:
                own = np.hypot(self._scatter(self._windows.count) * np.sqrt(2.0), WEATHER)
            else:
                moved = self._contrast(number, now, effects)[None] / PERCENT
                own = np.hypot(self._scatter(self._windows.count), self._scatter(PARKED_WINDOWS))
                at = np.arange(self.standing)
                shared[at, self.operating + number, at] = PERCENT * standing_errors(moved)[0]
            noise[self.operating + number, : self.standing] = PERCENT * own
        return Errors(noise, np.zeros_like(noise), shared)

    def _scatter(self, windows: int) -> FloatArray:
        """Of the mean of each frequency over so many windows, as a share of it, float[modes]."""
        return np.array([
            one.scatter
            / np.sqrt(max(1.0, windows * one.found * (1 - one.memory) / (1 + one.memory)))
            for one in self._found
        ])  # fmt: skip

    def _level_errors(self, now: Prediction) -> FloatArray:
        """Noise of a measurement that adds what as many windows again add to those so far.

        What the model errs is the same in both, so that it bounds what they say together.
        """
        level = 0.0 if self._late else MODEL_ERROR
        bare = self._now.predict({})
        stays = np.hypot(level, CHANGE_ERROR * (now.log_f - bare.log_f)[0])
        so_far, then = self._scatter(self._windows.count), self._scatter(2 * self._windows.count)
        gained = 1.0 / (stays**2 + then**2) - 1.0 / (stays**2 + so_far**2)
        return np.asarray(1.0 / np.sqrt(np.maximum(gained, 1e-12)))

    def _shape_errors(self, now: Prediction) -> FloatArray:
        """Of the motion at the accelerometers, float[modes, added].

        What is not modelled brings in parts of other modes beside what any shape is off.
        """
        entries = self._shape_entries(now)
        spread = np.sqrt(0.5 * SHAPE_ERROR + np.array([one.shape_noise for one in self._found]))
        others = couplings(now.log_f[0]) ** 2 @ self._motion(now.shapes) ** 2
        scales = self._scales(now)[:, None]
        square = spread[:, None] ** 2 * (1.0 + entries**2) + others * scales**2
        return np.where(scales == 0.0, SILENT, np.sqrt(square))


def _looks(model: Model, windows: Windows) -> tuple[Expected, ...]:
    """What the modes look like that were found."""
    points = {name: number for number, name in enumerate(model.points)}
    looks = []
    for name, mode in windows.modes.items():
        lacking = [point for point in mode.shape if point not in points]
        if lacking or name not in model.modes:
            what = f"point {lacking[0]!r}" if lacking else f"mode {name!r}"
            raise InputError(
                f"the findings have windows of {what}, which the model lacks",
                "findings, windows",
                "give findings as the diagnosis wrote them",
            )
        at = np.array([points[point] for point in mode.shape], dtype=np.int64)
        shape = np.array(list(mode.shape.values()), dtype=float)
        looks.append(Expected(mode.frequency, model.modes[name].within, at, shape))
    return tuple(looks)
