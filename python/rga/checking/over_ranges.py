"""What a model does over the ranges of its contexts: simulated once for all checks."""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from rga.arrays import FloatArray, IntArray
from rga.errors import InputError
from rga.model.effect import seconds
from rga.model.schema import Model
from rga.model.structure import Structure
from rga.simulation import Results, Simulator, results

#: values of each context along its range, the others at their middle; draws of all together
ALONG, DRAWN = 25, 32
#: places along a member that are solved for: its ends, and the thirds that bowed members need
STATIONS = 4


@dataclass(frozen=True)
class Simulated:
    """Simulated values of some sensors.

    Attributes:
        values: float[rows, sensors].
        trouble: why the rows are not those of the whole ranges, or are none; None: they are.
        anywhere: whether the middle of all ranges, at least, can be simulated.
    """

    values: FloatArray
    trouble: InputError | None = None
    anywhere: bool = True


@dataclass(frozen=True)
class OverRanges:
    """A model and what it does over the ranges of its contexts.

    Effects with an onset act in all rows.

    Attributes:
        model: that is looked at.
    """

    model: Model

    @cached_property
    def contexts(self) -> dict[str, FloatArray]:
        """Rows: the middle, each context along its range, draws of all; and `time` [s]."""
        ranges = {name: one.range for name, one in self.model.context.items()}
        middle = {name: (low + high) / 2 for name, (low, high) in ranges.items()}
        drawn = np.zeros((0, len(ranges)))
        if ranges:
            drawn = scipy.stats.qmc.Sobol(len(ranges), scramble=True, rng=0).random(DRAWN)
        table = {}
        for number, (name, (low, high)) in enumerate(ranges.items()):
            along = [
                np.linspace(low, high, ALONG) if one == name else np.full(ALONG, middle[name])
                for one in ranges
            ]
            columns = [[middle[name]], *along, low + (high - low) * drawn[:, number]]
            table[name] = np.concatenate(columns)
        rows = len(next(iter(table.values()))) if table else 1
        return {**table, "time": np.full(rows, self._moment)}

    def rows_along(self, context: str) -> IntArray:
        """Rows in which a context runs along its range."""
        first = 1 + ALONG * list(self.model.context).index(context)
        return np.arange(first, first + ALONG)

    @property
    def _moment(self) -> float:
        """A time at which every effect acts in full [s]."""
        moments = [
            seconds(moment)
            for effect in self.model.effects.values()
            for moment in (effect.onset, effect.end)
            if moment is not None
        ]
        return max(moments, default=-1.0) + 1.0

    @cached_property
    def middle(self) -> dict[str, FloatArray]:
        """The middle of all ranges, one row."""
        return {name: column[:1] for name, column in self.contexts.items()}

    @cached_property
    def simulator(self) -> Simulator:
        """Of the model, without the zeros of loggers."""
        return Simulator(self.model.without_zeros())

    @cached_property
    def structure(self) -> Structure:
        """As the effects make it at the middle of the ranges.

        Raises:
            InputError: an effect cannot be put on it.
        """
        assembly = self.simulator.assembly
        request = assembly.request(self.simulator.resolve(self.middle), 1)
        return request.change(request.states[0])

    @cached_property
    def readings(self) -> Simulated:
        """Of the sensors of the model, in their units."""
        return self._simulated(self.simulator)

    @cached_property
    def results(self) -> Results | None:
        """Of the structure at all rows, else at the middle; None where it cannot be simulated."""
        if not self.readings.anywhere:
            return None
        whole = self.readings.trouble is None
        with np.errstate(all="ignore"):
            for contexts in (self.contexts, self.middle) if whole else (self.middle,):
                with suppress(InputError):
                    return results(self.model, contexts, stations=STATIONS)
        return None

    def _simulated(self, simulator: Simulator) -> Simulated:
        try:
            with np.errstate(all="ignore"):
                return Simulated(simulator.predict(self.contexts))
        except InputError as error:
            trouble = error
        try:
            with np.errstate(all="ignore"):
                return Simulated(simulator.predict(self.middle), trouble)
        except InputError as error:
            none = np.zeros((0, len(simulator.model.sensors)))
            return Simulated(none, error, anywhere=False)
