"""Mechanisms by which the temperature acts otherwise than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Effect, Values
from rga.model.effects.temperature import Temperature
from rga.model.parameter import Factor, Normal, Parameter, Place, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Load, Structure

AXES = {"vertical": 2, "lateral": 1}


class ThermalExpansion(Effect):
    """A factor on the coefficient of thermal expansion of a material."""

    kind: Literal["thermal_expansion"] = "thermal_expansion"
    structural = True
    material: Annotated[str | list[str], Place("material")]
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if any(isinstance(effect, Temperature) for effect in model.effects.values()):
            yield from ({"material": material} for material in model.materials)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Factor(0.15)}

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        structure.alpha[structure.of_material(self.material)] *= value["factor"]


class ThermalGradient(Effect):
    """A linear difference of temperature over the height or the width, zero in the middle.

    Members take the field at the middle of their length.

    Attributes:
        ratio: difference top - bottom (or +y - -y) per kelvin of the temperature effects' delta.
        difference: the same as a constant [K].
    """

    kind: Literal["thermal_gradient"] = "thermal_gradient"
    loads_by_geometry = True
    axis: Annotated[Literal["vertical", "lateral"], Place("")]
    ratio: Annotated[Value | None, Parameter("K/K", 0.0)] = None
    difference: Annotated[Value | None, Parameter("K", 0.0)] = None

    def check(self, model: Model) -> None:
        warm = any(isinstance(effect, Temperature) for effect in model.effects.values())
        if self.ratio is not None and not warm:
            raise ValueError("ratio is per kelvin of a temperature effect, and the model has none")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        points = np.array(list(model.nodes.values()))
        for axis, column in AXES.items():
            if np.ptp(points[:, column]) > 0:
                yield {"axis": axis}

    @classmethod
    def forms(cls, model: Model, place: Mapping[str, Any]) -> list[dict[str, Prior]]:
        warm = any(isinstance(effect, Temperature) for effect in model.effects.values())
        ratio: dict[str, Prior] = {"ratio": Normal(0.0, 0.3)}
        return [*([ratio] if warm else []), {"difference": Normal(0.0, 5.0)}]

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        strain = structure.once(lambda: self._strain(structure), self)
        loads = []
        if "difference" in values:
            loads.append(Load(values["difference"], strain=strain))
        if "ratio" in values:
            deltas = [other["delta"] for other in others.values() if "delta" in other]
            loads.append(Load(values["ratio"] * sum(deltas), strain=strain))
        return loads

    def _strain(self, structure: Structure) -> FloatArray:
        """Of every member per kelvin of difference, float[members]."""
        points = structure.arrays["coordinates"][:, AXES[self.axis]]
        middle = points[structure.arrays["ends"]].mean(axis=1)
        low, high = points.min(), points.max()
        share = (middle - (low + high) / 2) / max(high - low, 1e-12)
        return np.asarray(structure.alpha * share[structure.host])


class ThermalLag(Effect):
    """Members that follow the air temperature late, with a time constant [h]."""

    kind: Literal["thermal_lag"] = "thermal_lag"
    remembers = True
    time_constant: Annotated[Value, Parameter("h", 0.0, least=0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if any(
            effect.drivers() for effect in model.effects.values() if isinstance(effect, Temperature)
        ):
            yield {}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"time_constant": Positive(2.0, 1.0)}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        for other in all_values.values():
            for key in ("delta", "temperature"):
                if key in other:
                    other[key] = lagged(other[key], time, values["time_constant"] * 3600)


def lagged(driver: FloatArray, time: FloatArray, time_constant: FloatArray) -> FloatArray:
    """First-order lag of a driver that is linear between rows; it starts in equilibrium."""
    state = driver.copy()
    for row in range(1, len(driver)):
        step = time[row] - time[row - 1]
        if time_constant[row] <= 0:
            continue
        if step <= 0:
            # The same moment twice: nothing follows at once.
            state[row] = state[row - 1]
            continue
        ratio = step / time_constant[row]
        decay = np.exp(-ratio)
        slope = (driver[row] - driver[row - 1]) / ratio
        late = driver[row] - slope
        state[row] = late + decay * (state[row - 1] - driver[row - 1] + slope)
    return state
