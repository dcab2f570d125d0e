"""Members that warm later than the air."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.temperature.temperature import Temperature
from rga.model.parameter import Parameter, Positive, Prior, Value
from rga.model.schema import Model

USUAL = Positive(2.0, 1.0)


class ThermalLag(Effect):
    """Members that follow the air temperature late, with a time constant [h]."""

    kind: Literal["thermal_lag"] = "thermal_lag"
    action = Action(
        check="where the temperature sensor sits: air and steel warm at different rates",
        test="a temperature sensor on the steel beside the one there is",
    )
    usual = f"time constant {USUAL} h: a judgement"
    remembers = True
    keeps_past = True
    time_constant: Annotated[Value, Parameter("h", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if any(
            effect.drivers() for effect in model.effects.values() if isinstance(effect, Temperature)
        ):
            yield {}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"time_constant": USUAL}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        for name, other in all_values.items():
            for key in ("delta", "temperature"):
                if key in other:
                    air, before = other[key], self.past.get(f"{key} of {name}")
                    other[key] = lagged(air, time, values["time_constant"] * 3600, before)
                    last = np.array([time[-1], air[-1], other[key][-1]])
                    self.past[f"{key} of {name}"] = last


def lagged(
    driver: FloatArray,
    time: FloatArray,
    constant: FloatArray,
    before: FloatArray | None = None,
) -> FloatArray:
    """First-order lag of a driver that is linear between rows, float[rows].

    Args:
        driver: float[rows].
        time: of the rows, not falling, float[rows] [s].
        constant: time constant of the lag, float[rows] [s].
        before: time [s], driver and what lags behind it in the row before, float[3]; None: there
            was none, and it starts in equilibrium.

    >>> time, constant = np.array([0.0, 3600.0]), np.full(2, 3600.0)
    >>> lagged(np.array([0.0, 1.0]), time, constant)
    array([0.        , 0.36787944])
    >>> lagged(np.array([1.0]), time[1:], constant[1:], before=np.zeros(3))
    array([0.36787944])
    """
    moment, from_driver, start = before if before is not None else (time[0], driver[0], driver[0])
    time, driver = np.append(moment, time), np.append(from_driver, driver)
    step = np.diff(time)
    lags, later = constant > 0, step > 0
    ratio = np.where(lags & later, step, 1.0) / np.where(lags, constant, 1.0)
    decay = np.exp(-ratio)
    slope = np.diff(driver) / ratio
    added = driver[1:] - slope - decay * (driver[:-1] - slope)
    # The same moment twice: nothing follows at once.
    decay = np.where(lags, np.where(later, decay, 1.0), 0.0)
    added = np.where(lags, np.where(later, added, 0.0), driver[1:])
    state = [float(start)]
    for kept, more in zip(decay.tolist(), added.tolist(), strict=True):
        state.append(kept * state[-1] + more)
    return np.array(state[1:])
