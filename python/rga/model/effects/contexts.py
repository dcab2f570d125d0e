"""Measurements of the context that are off."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.model.effect import Effect, Values
from rga.model.parameter import Factor, Normal, Parameter, Place, Prior, Value, listed
from rga.model.readings import Readings
from rga.model.schema import Model

Contexts = Annotated[str | list[str], Place("context")]


class ContextBias(Effect):
    """An offset of a context channel: measured = true + offset [its unit]."""

    kind: Literal["context_bias"] = "context_bias"
    context: Contexts
    offset: Annotated[Value, Parameter("unit", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"context": context} for context in model.context)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        low, high = model.context[place["context"]].range
        return {"offset": Normal(0.0, 0.05 * (high - low))}

    def change_contexts(self, contexts: Values, values: Values) -> None:
        for name in listed(self.context):
            contexts[name] = contexts[name] - values["offset"]


class ContextGain(Effect):
    """A factor on a context channel: measured = factor * true."""

    kind: Literal["context_gain"] = "context_gain"
    context: Contexts
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"context": context} for context in model.context)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Factor(0.15)}

    def change_contexts(self, contexts: Values, values: Values) -> None:
        for name in listed(self.context):
            contexts[name] = contexts[name] / values["factor"]


class ClockLag(Effect):
    """A clock that is late [s]: a reading shows what was true that much earlier.

    Without a sensor it is the clock of all sensors against that of the contexts.
    """

    kind: Literal["clock_lag"] = "clock_lag"
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
