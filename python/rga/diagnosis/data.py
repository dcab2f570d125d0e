"""The part of a record that a diagnosis works on, beside the contexts it has to believe."""

from dataclasses import dataclass, field, replace

import numpy as np

from rga.diagnosis.row_covariance import BoolArray
from rga.model.effect import Effect, Values
from rga.model.parameter import FloatArray
from rga.model.schema import Model
from rga.model.structure import IntArray
from rga.simulation import Simulator
from rga.simulation.simulator import Response
from rga.simulation.vicinity import Vicinity

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

    def rows(self, chosen: BoolArray) -> "Belief":
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
    """Readings with the belief of their contexts.

    Attributes:
        sensors: names of the channels.
        columns: column of each in the simulator's output, int[sensors].
        readings: float[rows, sensors], zero where missing.
        observed: bool[rows, sensors].
        belief: what is believed of the contexts.
        zero: contexts of rows whose mean was taken off every channel, `time` [s] included,
            float[rows] each; of no length where nothing was taken off.
    """

    sensors: tuple[str, ...]
    columns: list[int]
    readings: FloatArray
    observed: BoolArray
    belief: Belief
    zero: Values
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
        """The response at the believed contexts, the zero rows in front."""
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

    def change(self, about: Vicinity, effect: Effect) -> tuple[IntArray, FloatArray]:
        """What an effect changes about a simulation, nearly, on the channels that it touches.

        Returns:
            Numbers of the channels, int[c], and their change, float[rows, c].

        Raises:
            InputError: the effect cannot be simulated.
        """
        if effect.on_sensors:
            changed = about.read_with(effect)
            touched = (changed != about.read).any(0)[self.columns]
            channels = np.flatnonzero(touched)
            columns = [self.columns[channel] for channel in channels]
            return channels, self._told(changed[:, columns]) - self._told(about.read[:, columns])
        nearly, _ = about.nearly({"trial": effect})
        change = self._told(nearly[:, self.columns]) - self._told(about.read[:, self.columns])
        channels = np.flatnonzero(change.any(0))
        return channels, change[:, channels]

    def _told(self, simulated: FloatArray) -> FloatArray:
        """Channels less their mean over the zero rows; zero where unknown."""
        if not np.isfinite(simulated).all():
            simulated = np.nan_to_num(simulated)
        leading = len(self.zero["time"])
        return simulated[leading:] - simulated[:leading].mean(0) if leading else simulated

    def _contexts(self, changes: Values) -> Values:
        table = {**self.belief.table, **changes}
        if len(self.zero["time"]):
            table = {name: self._with_zero(name, column) for name, column in table.items()}
        return table

    def _with_zero(self, name: str, column: FloatArray) -> FloatArray:
        """A context with its values at the zero rows in front; a line is prolonged to them."""
        leading = self.zero[name]
        if name in self.belief.lines and len(column) > 1:
            rate = (column[-1] - column[0]) / (self.time[-1] - self.time[0])
            leading = column[0] + rate * (self.zero["time"] - self.time[0])
        return np.concatenate([leading, column])

    def rows(self, chosen: BoolArray) -> "Data":
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


def _filled(time: FloatArray, column: FloatArray, otherwise: float) -> FloatArray:
    seen = np.isfinite(column)
    if not seen.any():
        return np.full(len(column), otherwise)
    return np.asarray(np.interp(time, time[seen], column[seen]))
