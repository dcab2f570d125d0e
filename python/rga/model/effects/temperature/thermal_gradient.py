"""Members that the sun warms on one side."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.temperature.temperature import Temperature
from rga.model.parameter import Normal, Parameter, Place, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Load, Structure

AXES = {"vertical": 2, "lateral": 1}
RATIO, DIFFERENCE = Normal(0.0, 0.3), Normal(0.0, 5.0)


class ThermalGradient(Effect):
    """A linear difference of temperature over the height or the width, zero in the middle.

    Members take the field at the middle of their length.

    Attributes:
        ratio: difference top - bottom (or +y - -y) per kelvin of the temperature effects' delta.
        difference: the same as a constant [K].
    """

    kind: Literal["thermal_gradient"] = "thermal_gradient"
    action = Action(
        inspect="which parts stand in the sun",
        check="where the temperature sensor sits, and add one on the opposite side",
        test="a clear day and an overcast one, without load",
    )
    usual = (
        f"ratio {RATIO} K/K, difference {DIFFERENCE} K: a judgement, about half of what a steel "
        "deck is designed for, 18 K (EN 1991-1-5, table 6.1)"
    )
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
        ratio: dict[str, Prior] = {"ratio": RATIO}
        return [*([ratio] if warm else []), {"difference": DIFFERENCE}]

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
