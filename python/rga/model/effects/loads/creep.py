"""Permanent loads under which the structure goes on yielding."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.action import Action
from rga.model.effect import Effect, Values, seconds
from rga.model.effects.loads.dead_load import DeadLoad
from rga.model.parameter import Parameter, Positive, Prior, Value
from rga.model.schema import Model
from rga.model.structure import Load, Structure

USUAL = Positive(0.1, 1.0)


class Creep(Effect):
    """Response to permanent load that grows by amplitude * log10(1 + days) times itself.

    Permanent are the loads that no context drives, `dead_load` among them; a temperature and a
    settlement are no loads. Days count from the first row, or from the onset.
    """

    kind: Literal["creep"] = "creep"
    action = Action(
        inspect="cracks and sag of concrete parts",
        check="drift of the gauges without load",
        test="level the span without load after some weeks",
    )
    usual = f"amplitude {USUAL}: a judgement"
    remembers = True
    keeps_past = True
    loads_by_geometry = True
    amplitude: Annotated[Value, Parameter("-", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        loads = (one for one in model.effects.values() if one.is_load or isinstance(one, DeadLoad))
        if not all(load.drivers() for load in loads):
            yield {}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"amplitude": USUAL}

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        time = contexts["time"]
        if self.onset is None:
            first = self.past.setdefault("first", time[:1].copy())
        else:
            first = np.array([seconds(self.onset)])
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
