"""The part of a record that a diagnosis works on, beside the contexts it has to believe."""

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.diagnosis.data.tare import Tare
from rga.findings.criteria import Criteria
from rga.model.effect import Effect, Values
from rga.model.schema import Model
from rga.simulation import Simulator
from rga.simulation.perturbation.trials import Vicinity
from rga.simulation.simulator import Response

#: share of its range that a measured context may be off before anything is known of its noise
FIRST_GUESS = 0.01
#: simulations about which trials are kept ready, and simulations of trials that are kept
KEPT, TRIALS = 4, 64


@dataclass(frozen=True)
class Belief:
    """What is believed of the contexts, row by row and for the whole record.

    Attributes:
        table: best values so far, `time` [s] included, float[rows] each.
        centre: prior mean of the contexts that are uncertain row by row, float[rows] each.
        spread: prior standard deviation of each of them.
        known: those of them whose spread is given, by the model or by the range of a latent one.
        latent: those of them that nothing measured.
        lines: contexts that are a line in time (law `constant` or `linear`), with the prior
            standard deviations of the level and of the slope [unit, unit/s].
    """

    table: Values
    centre: Values
    spread: dict[str, float]
    known: frozenset[str]
    latent: frozenset[str]
    lines: dict[str, tuple[float, float]]

    def with_values(self, changes: Values) -> "Belief":
        """The same belief with other best values."""
        return replace(self, table={**self.table, **changes})

    def rows(self, chosen: BoolArray | IntArray) -> "Belief":
        """The belief for some of the rows."""
        return replace(
            self,
            table={name: column[chosen] for name, column in self.table.items()},
            centre={name: column[chosen] for name, column in self.centre.items()},
        )

    def distance(self, other: "Belief") -> float:
        """How far best values of inferred contexts lie apart: root mean square over prior spread.

        The largest of all contexts [-].
        """
        spread = {**self.spread, **{name: level for name, (level, _) in self.lines.items()}}
        apart = [
            float(np.sqrt(np.mean((self.table[name] - other.table[name]) ** 2))) / spread[name]
            for name in {*self.lines, *self.latent}
        ]
        return max(apart, default=0.0)

    @property
    def inferred(self) -> bool:
        """True where a context was not measured: then a model's change moves it far."""
        return bool(self.lines or self.latent)

    @property
    def measured(self) -> list[str]:
        """Contexts that were measured, with errors."""
        return [name for name in self.spread if name not in self.latent]

    @property
    def passing(self) -> tuple[str, ...]:
        """Contexts that go through their range once: what hangs on them looks like an onset."""
        return tuple(name for name, (_, slope) in self.lines.items() if slope > 0)

    @property
    def middle(self) -> float:
        """Time about which lines are written [s]."""
        return float(self.table["time"].mean())


@dataclass(frozen=True)
class Data:
    """Readings with the belief of their contexts, and the criteria that they are judged by.

    Attributes:
        sensors: names of the channels.
        columns: column of each in the simulator's output, int[sensors].
        readings: float[rows, sensors], zero where missing.
        observed: bool[rows, sensors].
        belief: what is believed of the contexts.
        tare: the rows whose mean was taken off every channel.
        criteria: what decides a verdict.
        scatter: levels of the families of the scatter, where they were seen on other rows;
            None: they are estimated.
    """

    sensors: tuple[str, ...]
    columns: IntArray
    readings: FloatArray
    observed: BoolArray
    belief: Belief
    tare: Tare
    criteria: Criteria
    scatter: FloatArray | None = None
    _about: list[tuple[Belief, Vicinity]] = field(default_factory=list, init=False, compare=False)
    _tried: dict[tuple[Vicinity, str, bool], tuple[FloatArray, bool]] = field(
        default_factory=dict, init=False, compare=False
    )

    @property
    def time(self) -> FloatArray:
        """Clock of the rows [s], float[rows]."""
        return self.belief.table["time"]

    def predict(self, simulator: Simulator, changes: Values | None = None) -> FloatArray:
        """Simulated channels at the believed contexts, float[rows, sensors]; zero where unknown.

        Args:
            simulator: of a model with these sensors.
            changes: other values for some of the contexts.
        """
        return self.read(simulator, self.respond(simulator, changes))

    def respond(self, simulator: Simulator, changes: Values | None = None) -> Response:
        """The response at the believed contexts and in the zero rows, in the order of time."""
        return simulator.respond(self._contexts(changes or {}))

    def about(self, simulator: Simulator) -> Vicinity:
        """A simulation at the believed contexts, to try effects on; the last few are kept."""
        for belief, known in self._about:
            if belief is self.belief and known.simulator is simulator:
                return known
        found = Vicinity(simulator, self._contexts({}))
        self._about.append((self.belief, found))
        del self._about[:-KEPT]
        return found

    def read(self, simulator: Simulator, response: Response) -> FloatArray:
        """The channels of a response, less their mean over the zero rows."""
        return self._told(simulator.read(response)[:, self.columns])

    def tried(self, about: Vicinity, effects: dict[str, Effect]) -> FloatArray:
        """Simulated channels with effects, float[rows, sensors]; the last few are kept.

        Raises:
            InputError: the effects cannot be simulated.
        """
        return self._kept(about, effects, True)[0]

    def nearly(self, about: Vicinity, effects: dict[str, Effect]) -> tuple[FloatArray, bool]:
        """The same as `Vicinity.nearly` has them, and whether they are exact."""
        return self._kept(about, effects, False)

    def _kept(
        self, about: Vicinity, effects: dict[str, Effect], exactly: bool
    ) -> tuple[FloatArray, bool]:
        key = about, repr(effects), exactly
        known = self._tried
        if key not in known:
            if exactly:
                known[key] = self.read(*about.trial(effects)), True
            else:
                read, exact = about.nearly(effects)
                known[key] = self._told(read[:, self.columns]), exact
            if len(known) > TRIALS:
                del known[next(iter(known))]
        return known[key]

    def change(self, about: Vicinity, effect: Effect) -> tuple[IntArray, FloatArray, FloatArray]:
        """What an effect changes about a simulation, nearly, on the channels that it touches.

        Nothing is taken off for the zero.

        Returns:
            Numbers of the channels, int[c], their change, float[rows, c], and that in the zero
            rows, float[zero rows, c].

        Raises:
            InputError: the effect cannot be simulated.
        """
        if effect.on_sensors:
            columns, changed = about.shown_with(effect)
            before = about.read[:, columns]
            channels = np.flatnonzero(np.isin(self.columns, columns))
            places = np.searchsorted(columns, self.columns[channels])
        else:
            changed, _ = about.nearly({"trial": effect})
            before = about.read
            channels, places = np.arange(len(self.columns)), self.columns
        with np.errstate(invalid="ignore"):
            difference = changed - before
        # What is not a number counts as touched: it is true.
        touched = difference[:, places].any(0)
        channels, places = channels[touched], places[touched]
        difference = difference[:, places]
        if not np.isfinite(difference).all():
            difference = np.nan_to_num(changed[:, places]) - np.nan_to_num(before[:, places])
        zero, rows = self._parted(difference)
        return channels, rows, zero

    def weights(self, effect: Effect) -> tuple[FloatArray, FloatArray]:
        """Share of an effect in the rows, float[rows], and in the zero rows, float[zero rows]."""
        both = np.concatenate([self.tare.time, self.time])[self._order]
        zero, rows = self._parted(effect.weight(both))
        return rows, zero

    def untared(self, simulator: Simulator) -> tuple[FloatArray, FloatArray]:
        """Simulated channels with nothing taken off for the zero.

        Returns:
            float[rows, sensors], and that in the zero rows, float[zero rows, sensors].
        """
        shown = simulator.read(self.respond(simulator))[:, self.columns]
        zero, rows = self._parted(_finite(shown))
        return rows, zero

    def at_zero(self, simulator: Simulator, moved: Values | None = None) -> FloatArray:
        """Simulated channels in the zero rows by themselves, float[zero rows, sensors].

        Args:
            simulator: of a model with these sensors.
            moved: what is added to some of the contexts there.
        """
        table = {name: self._at_zero(name, column) for name, column in self.belief.table.items()}
        table |= {name: table[name] + step for name, step in (moved or {}).items()}
        return _finite(simulator.read(simulator.respond(table))[:, self.columns])

    def taken_off(self, zero: FloatArray) -> FloatArray:
        """What values in the zero rows, float[zero rows, sensors], take off, float[sensors]."""
        return self.tare.mean(zero, self.columns)

    def _told(self, simulated: FloatArray) -> FloatArray:
        """Channels less their mean over the zero rows; zero where unknown."""
        zero, rows = self._parted(_finite(simulated))
        return rows - self.taken_off(zero)

    @cached_property
    def _order(self) -> IntArray:
        """Zero rows, then the others, in the order of time: effects may remember."""
        return np.argsort(np.concatenate([self.tare.time, self.time]), kind="stable")

    def _parted(self, simulated: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The zero rows and the others of a simulation of both."""
        leading = len(self.tare)
        if not leading:
            return simulated[:0], simulated
        parted = np.empty_like(simulated)
        parted[self._order] = simulated
        return parted[:leading], parted[leading:]

    def _contexts(self, changes: Values) -> Values:
        table = {**self.belief.table, **changes}
        if not len(self.tare):
            return table
        return {
            name: np.concatenate([self._at_zero(name, column), column])[self._order]
            for name, column in table.items()
        }

    def _at_zero(self, name: str, column: FloatArray) -> FloatArray:
        """A context in the zero rows, float[zero rows]; a line is prolonged to them."""
        if name in self.belief.lines and len(column) > 1:
            rate = (column[-1] - column[0]) / (self.time[-1] - self.time[0])
            return np.asarray(column[0] + rate * (self.tare.time - self.time[0]))
        return self.tare.contexts[name]

    def rows(self, chosen: BoolArray | IntArray) -> "Data":
        """Some of the rows."""
        return replace(
            self,
            readings=self.readings[chosen],
            observed=self.observed[chosen],
            belief=self.belief.rows(chosen),
        )

    def without(self, sensors: set[str]) -> "Data":
        """The same rows with some channels taken as missing."""
        hidden = np.array([name in sensors for name in self.sensors])
        other = replace(self, observed=self.observed & ~hidden)
        # What is simulated does not depend on what is seen.
        other._about.extend(self._about)
        object.__setattr__(other, "_tried", self._tried)
        return other


def first_belief(model: Model, time: FloatArray, measured: Values) -> Belief:
    """What is believed before any reading is looked at.

    Args:
        model: with its context variables.
        time: clock of the rows [s], float[rows].
        measured: measured contexts, NaN where missing.
    """
    table: Values = {"time": time}
    centre: Values = {}
    spread: dict[str, float] = {}
    known = set()
    latent = set()
    lines = {}
    needed = Simulator(model).needed
    for name, variable in model.context.items():
        low, high = variable.range
        if name in measured:
            table[name] = _filled(time, measured[name], (low + high) / 2)
        else:
            table[name] = np.full(len(time), (low + high) / 2)
        if name not in needed:
            continue
        if name not in measured and variable.law in ("constant", "linear"):
            moving = variable.law == "linear" and variable.rate is not None
            slope = max(map(abs, variable.rate)) if moving and variable.rate else 0.0
            lines[name] = ((high - low) / 2, slope)
            continue
        centre[name] = table[name].copy()
        if name not in measured:
            latent.add(name)
            spread[name] = (high - low) / np.sqrt(12)
        elif variable.noise is not None:
            known.add(name)
            spread[name] = variable.noise
        else:
            spread[name] = FIRST_GUESS * (high - low)
    return Belief(table, centre, spread, frozenset(known | latent), frozenset(latent), lines)


def _finite(simulated: FloatArray) -> FloatArray:
    """A simulation, zero where it is unknown."""
    return simulated if np.isfinite(simulated).all() else np.nan_to_num(simulated)


def _filled(time: FloatArray, column: FloatArray, otherwise: float) -> FloatArray:
    seen = np.isfinite(column)
    if not seen.any():
        return np.full(len(column), otherwise)
    return np.asarray(np.interp(time, time[seen], column[seen]))
