"""A structure with all that could be measured on it, and what explanations say of it.

A measurement is a contrast, so that no zero of a sensor matters: in operation a reading less the
mean over time, in a load test a state less another one.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import FloatArray
from rga.experiments.candidates import Added, LoadTest, context_noise, rest, sensor_noise
from rga.experiments.explanation import CandidateModel
from rga.experiments.truck import FACTOR, POSITION, Lane, Truck
from rga.model.effect import Effect, Values
from rga.model.effects.members.member_stiffness import MemberStiffness
from rga.model.schema import ContextVariable, Model
from rga.simulation import Simulator
from rga.simulation.perturbation.trials import Vicinity
from rga.simulation.simulator import Response

#: how well a truck is weighed [-], and placed [m]
WEIGHED, PLACED = 0.01, 0.05
#: readings of a state that a test takes the mean of
READINGS = 4
#: time between the two states of a test [s], where contexts are set and with a truck: what changes
#: with time shows in the first alone
SETTLED, BRIEFLY = 7 * 86400.0, 600.0
#: steps of derivatives: of the logarithm of a stiffness, of an unknown [standard deviations]
SCATTER_STEP, STEP = 1e-3, 1e-2


@dataclass(frozen=True)
class Errors:
    """What makes a right explanation miss its measurements.

    Attributes:
        noise: of each measurement by itself, float[measurements, sensors].
        gain: of each sensor, times what that does, float[measurements, sensors].
        shared: of members, the truck and the settings, times what that does to all sensors,
            float[errors, measurements, sensors].
    """

    noise: FloatArray
    gain: FloatArray
    shared: FloatArray


def by_unknowns(
    measurements: Callable[[Mapping[str, Effect]], FloatArray],
    one: CandidateModel,
    about: FloatArray | Sequence[float],
    shape: tuple[int, int],
) -> FloatArray:
    """Derivatives of measurements by the unknowns of an explanation, float[unknowns, *shape]."""
    centre = np.asarray(about, dtype=float)
    ahead, behind = (
        [measurements(one.at(centre + sign * STEP * e)) for e in np.eye(len(centre))]
        for sign in (1.0, -1.0)
    )
    apart = np.array(ahead).reshape(-1, *shape) - np.array(behind).reshape(-1, *shape)
    return np.asarray(apart / (2 * STEP))


class MeasurementModel:
    """A structure with sensors that stand, sensors that could be added, and tests.

    Args:
        model: the structure.
        working: sensors of the model that work.
        added: sensors that could be added, and instruments behind them.
        tests: load tests.
        operation: contexts of operation and `time` [s], float[rows] each.
        lane, truck: of the tests with a truck.
        levels: as-built scatter of a member's EA, of a sensor's gain, and of a reading for reasons
            unknown [-], float[3].

    Attributes:
        sensors: names of the columns: those that work, those that could be added.
        standing: how many of them work already.
        operating: how many measurements are of operation; those of the tests follow.
    """

    def __init__(
        self,
        model: Model,
        working: Sequence[str],
        added: Sequence[Added],
        tests: Sequence[LoadTest],
        operation: Values,
        lane: Lane | None,
        truck: Truck | None,
        levels: FloatArray,
    ) -> None:
        self.model = model
        self.added: Sequence[Added] = added
        self.tests: Sequence[LoadTest] = tests
        self._members, self._gains, self._unknown = levels.tolist()
        self.sensors = [*working, *(one.name for one in added)]
        self.standing, self.operating = len(working), len(operation["time"])
        sensors = {
            **{
                name: sensor.model_copy(update={"zero": None})
                for name, sensor in model.sensors.items()
            },
            **{one.name: one.sensor for one in added if one.sensor is not None},
        }
        contexts = dict(model.context)
        loads: dict[str, Effect] = {}
        self._length = 0.0 if lane is None else lane.length
        if lane is not None and truck is not None:
            contexts[FACTOR] = ContextVariable(unit="-", range=(0.0, 1.0))
            contexts[POSITION] = ContextVariable(unit="m", range=(0.0, max(lane.length, 1.0)))
            loads = lane.effects(truck)
        changes = {"sensors": sensors, "context": contexts, "effects": {**model.effects, **loads}}
        self._simulator = Simulator(model.model_copy(update=changes))
        columns = {name: number for number, name in enumerate(sensors)}
        self._columns = [columns[name] for name in self.sensors if name in columns]
        standing = [sensor_noise(model, model.sensors[name]) for name in working]
        self._noise = np.array([*standing, *(one.noise for one in added)])
        self._instruments = [one.context for one in added if one.sensor is None]
        count = len(self.sensors) - len(self._instruments)
        self._calibrated = np.arange(len(self.sensors)) >= count
        self._table = self._states(operation, sorted(contexts))
        self._vicinity = Vicinity(self._simulator, self._table)

    def _states(self, operation: Values, contexts: Sequence[str]) -> Values:
        """Contexts and time of operation, then of both states of every test."""
        still = rest(self.model)
        pauses = [
            pause
            for test in self.tests
            for pause in (SETTLED, SETTLED if test.position is None else BRIEFLY)
        ]
        later = float(operation["time"][-1]) + np.cumsum(pauses)
        table = {"time": np.append(operation["time"], later)}
        for name in contexts:
            states = []
            for test in self.tests:
                first, second = still | test.against, still | test.at
                if test.position is not None:
                    first |= {FACTOR: 0.0, POSITION: test.position}
                    second |= {FACTOR: 1.0, POSITION: test.position}
                states += [first.get(name, 0.0), second.get(name, 0.0)]
            operating = operation.get(name, np.full(self.operating, still.get(name, 0.0)))
            table[name] = np.append(operating, states)
        return table

    def unit(self, column: int) -> str:
        """Unit of a column."""
        if column < self.standing:
            return self.model.sensors[self.sensors[column]].unit
        return self.added[column - self.standing].unit

    def without_test(self, column: int, apart: FloatArray) -> tuple[FloatArray, str]:
        """The change between the rows of operation in which two differ most, as `Site` has it."""
        first, last = int(np.argmin(apart)), int(np.argmax(apart))
        weights = np.zeros(self.operating + len(self.tests))
        weights[[first, last]] = -1.0, 1.0
        return weights, f"from {self._state(first)} to {self._state(last)}"

    def _state(self, row: int) -> str:
        """The contexts of a row of operation, in words."""
        shown = (name for name in self.model.context if name in self._simulator.needed)
        return ", ".join(f"{name} {self._table[name][row]:.3g}" for name in shown)

    def measurements(self, effects: Mapping[str, Effect]) -> FloatArray:
        """What would be measured with more effects, float[measurements, sensors].

        Raises:
            InputError: the effects cannot be simulated.
        """
        return self._read(*self._vicinity.trial(effects))

    def derivatives(self, one: CandidateModel, about: FloatArray | Sequence[float]) -> FloatArray:
        """By the unknowns in standard deviations, float[unknowns, measurements, sensors]."""
        shape = (self.operating + len(self.tests), len(self.sensors))
        return by_unknowns(self.measurements, one, about, shape)

    def errors(self, effects: Mapping[str, Effect]) -> Errors:
        """The errors about the structure with effects."""
        simulator = self._simulator.extended(effects)
        vicinity = Vicinity(simulator, self._table)
        centre = self._read(simulator, vicinity.response)
        noise = self._noise
        square = np.tile(noise**2, (len(centre), 1)) + (self._unknown * centre) ** 2
        square[self.operating :] += noise**2 * (2 / READINGS - 1)
        shared = [self._by_truck(centre), *self._by_members(vicinity, centre)]
        for name, step in self._steps().items():
            table = {**self._table, name: self._off(name, step)}
            moved = self._read(simulator, simulator.respond(table)) - centre
            square[: self.operating] += moved[: self.operating] ** 2
            # The two states of a setting are measured apart; every test has errors of its own.
            shared += [row for row in self._of_tests(np.sqrt(2) * moved) if row.any()]
        gain = self._gains * np.where(self._calibrated, 0.0, centre)
        gain[: self.operating] += np.where(self._calibrated, noise, 0.0)
        return Errors(np.sqrt(square), gain, np.array(shared))

    def _steps(self) -> dict[str, float]:
        """By how much each context that matters is off."""
        needed = self._simulator.needed
        off = {name: context_noise(self.model, name) for name in self.model.context}
        return {name: step for name, step in {**off, POSITION: PLACED}.items() if name in needed}

    def _off(self, name: str, step: float) -> FloatArray:
        """A context off by a step, float[rows]; a truck stays on its path, which bears it."""
        column = self._table[name]
        beyond = (name == POSITION) & (column + step > self._length)
        return np.where(beyond, column - step, column + step)

    def _of_tests(self, moved: FloatArray) -> FloatArray:
        """The part of a change in each test alone, float[tests, measurements, sensors]."""
        apart = np.zeros((len(self.tests), *moved.shape))
        every = np.arange(len(self.tests))
        apart[every, self.operating + every] = moved[self.operating :]
        return apart

    def _by_truck(self, centre: FloatArray) -> FloatArray:
        """What the truck's weight is off does, float[measurements, sensors]."""
        driven = np.zeros(len(centre))
        driven[self.operating :] = [test.position is not None for test in self.tests]
        return np.asarray(WEIGHED * centre * driven[:, None])

    def _by_members(self, vicinity: Vicinity, centre: FloatArray) -> list[FloatArray]:
        """What the scatter of every member does, float[measurements, sensors] each."""
        rates = vicinity.stiffness_rates()
        plain = vicinity.simulator.reads_plainly
        found = []
        for number, member in enumerate(self.model.members):
            if number in rates and plain:
                shown = np.zeros((len(vicinity.read), len(self.sensors)))
                shown[:, ~self._calibrated] = rates[number][:, self._columns]
                found.append(self._members * self._contrasts(shown))
                continue
            if number in rates:
                moved = vicinity.response.quantities + SCATTER_STEP * rates[number]
                response = replace(vicinity.response, quantities=moved)
                changed = self._read(vicinity.simulator, response)
            else:
                scatter = MemberStiffness(member=member, factor=float(np.exp(SCATTER_STEP)))
                changed = self._read(*vicinity.trial({"scatter": scatter}))
            found.append(self._members * (changed - centre) / SCATTER_STEP)
        return found

    def _read(self, simulator: Simulator, response: Response) -> FloatArray:
        shown = np.nan_to_num(simulator.read(response))[:, self._columns]
        if self._instruments:
            true = dict(self._table)
            rows = len(true["time"])
            for effect in simulator.model.effects.values():
                effect.change_contexts(true, effect.values(response.contexts, rows))
            shown = np.column_stack([shown, *(true[name] for name in self._instruments)])
        return self._contrasts(shown)

    def _contrasts(self, shown: FloatArray) -> FloatArray:
        """Measurements from what is shown in every state, float[measurements, sensors]."""
        operating, states = shown[: self.operating], shown[self.operating :]
        # An instrument is calibrated; a sensor's zero says nothing.
        zero = np.where(self._calibrated, 0.0, operating.mean(0))
        return np.concatenate([operating - zero, states[1::2] - states[::2]])
