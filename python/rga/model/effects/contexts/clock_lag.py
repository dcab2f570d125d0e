"""Clocks that are late."""

from typing import Annotated, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.parameter import Driven, Parameter, Place, Value, resolve
from rga.model.readings import Readings


class ClockLag(Effect):
    """A clock that is late [s]: a reading shows what was true that much earlier.

    Without a sensor it is the clock of all sensors against that of the contexts. A diagnosis does
    not propose it: on loads that move, what dynamics adds to a channel passes for a late clock.
    """

    kind: Literal["clock_lag"] = "clock_lag"
    action = Action(
        check="the clocks of the loggers: {place} is recorded late",
        test="one sharp event that all loggers see",
    )
    remembers = True
    keeps_past = True
    sensor: Annotated[str | list[str] | None, Place("sensor")] = None
    time: Annotated[Value, Parameter("s", 0.0)] = 0.0

    @property
    def hindrance(self) -> str:
        if isinstance(self.time, Driven):
            return "how far back a clock shows must not follow a context"
        if self._longest < 0:
            return "a clock that is early shows what has not come yet"
        return super().hindrance

    @property
    def _longest(self) -> float:
        """How far back a reading may show, in all rows to come [s]."""
        return float(resolve(self.time, {}, 1)[0])

    def change_contexts(self, contexts: Values, values: Values) -> None:
        if self.sensor is not None:
            return
        names = [name for name in contexts if name != "time"]
        columns = [contexts[name] for name in names]
        late = self._late(columns, contexts["time"], values["time"])
        contexts.update(zip(names, late, strict=True))

    def change_readings(self, readings: Readings, values: Values) -> None:
        if self.sensor is None:
            return
        places = readings.at(self.sensor)
        columns = [readings.values[:, place] for place in places]
        late = self._late(columns, readings.time, values["time"])
        readings.values[:, places] = np.transpose(late)

    def _late(
        self, columns: list[FloatArray], clock: FloatArray, lag: FloatArray
    ) -> list[FloatArray]:
        """What columns have shown a lag earlier, float[rows] each."""
        if not columns:
            return []
        table = np.stack([clock, *columns])
        table = np.hstack([self.past.get("rows", table[:, :0]), table])
        time = table[0]
        if self._past is not None:
            # What comes shows nothing before the last of these rows that is so far back.
            reached = np.searchsorted(time, time[-1] - self._longest, side="right") - 1
            self.past["rows"] = table[:, max(reached, 0) :].copy()
        return [np.interp(clock - lag, time, column) for column in table[1:]]
