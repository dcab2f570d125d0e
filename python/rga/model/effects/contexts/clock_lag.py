"""Clocks that are late."""

from typing import Annotated, Literal

import numpy as np

from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.parameter import Parameter, Place, Value, listed
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
    sensor: Annotated[str | list[str] | None, Place("sensor")] = None
    time: Annotated[Value, Parameter("s", 0.0)] = 0.0

    def change_contexts(self, contexts: Values, values: Values) -> None:
        if self.sensor is not None:
            return
        clock = contexts["time"]
        for name, column in contexts.items():
            if name != "time":
                contexts[name] = np.interp(clock - values["time"], clock, column)

    def change_readings(self, readings: Readings, values: Values) -> None:
        for name in listed(self.sensor):
            column = readings.values[:, readings.columns[name]]
            column[:] = np.interp(readings.time - values["time"], readings.time, column.copy())
