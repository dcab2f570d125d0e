"""The temperature of members."""

from collections.abc import Mapping
from typing import Annotated, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Effect, Values
from rga.model.parameter import Driven, Number, Parameter, Value
from rga.model.schema import Model
from rga.model.structure import Load, Structure


class Temperature(Effect):
    """Temperature change of groups of members.

    Attributes:
        groups: kelvin of each group per unit of delta.
        delta: what they are multiplied by.
    """

    kind: Literal["temperature"] = "temperature"
    loads_by_geometry = True
    groups: dict[str, Number]
    delta: Annotated[Value, Parameter("K", 0.0)] = 1.0

    def check(self, model: Model) -> None:
        """ValueError where groups are missing or overlap, or delta does not follow a line."""
        if isinstance(self.delta, Driven) and (self.delta.log10 or self.delta.kink is not None):
            raise ValueError(
                "delta: a temperature follows its context linearly, not by log10 or with a kink"
            )
        seen: dict[str, str] = {}
        for group in self.groups:
            if group not in model.groups:
                raise ValueError(f"groups: there is no group {group!r} in the model")
            for member in model.groups[group]:
                if member in seen:
                    raise ValueError(
                        f"groups: member {member!r} is in both {seen[member]!r} and {group!r}"
                    )
                seen[member] = group

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        """Beside delta the driving context itself, and its value at which nothing is warmed."""
        found = super().values(contexts, rows)
        if isinstance(self.delta, Driven):
            found["temperature"] = contexts[self.delta.context]
            found["reference"] = np.full(rows, self.delta.minus)
        return found

    def field(self, structure: Structure) -> FloatArray:
        """Kelvin of every member per unit of delta, float[members]."""
        kelvin = np.zeros(len(structure.host))
        for group, warming in self.groups.items():
            kelvin[structure.groups[group]] = warming
        return kelvin[structure.host]

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        strain = structure.once(lambda: structure.alpha * self.field(structure), self)
        return [Load(values["delta"], strain=strain)]
