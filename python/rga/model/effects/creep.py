"""Permanent loads under which the structure goes on yielding."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Effect, Values, seconds
from rga.model.effects.loading import LOAD_KINDS
from rga.model.parameter import Parameter, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Load, Structure


class Creep(Effect):
    """Response to permanent load that grows by amplitude * log10(1 + days) times itself.

    Permanent are the loads that no context drives, `dead_load` among them. Days count from the
    first row, or from the onset.
    """

    kind: Literal["creep"] = "creep"
    remembers = True
    amplitude: Annotated[Value, Parameter("-", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        lasting = (*LOAD_KINDS, "dead_load")
        if any(one.kind in lasting and not one.drivers() for one in model.effects.values()):
            yield {}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"amplitude": Positive(0.1, 1.0)}

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        time = contexts["time"]
        first = time[:1] if self.onset is None else seconds(self.onset)
        days = np.maximum(time - first, 0.0) / 86400
        return {"growth": super().values(contexts, rows)["amplitude"] * np.log10(1 + days)}

    def change_loads(
        self, loads: dict[str, list[Load]], structure: Structure, values: Values
    ) -> None:
        for name, of_effect in loads.items():
            loads[name] = [
                load.times(load.coefficient * (1 + values["growth"])) if load.permanent else load
                for load in of_effect
            ]
