"""Supports that have moved."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.errors import InputError
from rga.model.effect import Effect, Values
from rga.model.effects.bearings import Direction, Supports, directions, supported
from rga.model.parameter import Normal, Parameter, Prior, Value
from rga.model.schema import DOFS, Model
from rga.model.structure import Load, Structure


class SupportSettlement(Effect):
    """A displacement [m or rad] of a direction that the support holds."""

    kind: Literal["support_settlement"] = "support_settlement"
    support: Supports
    dof: Direction
    displacement: Annotated[Value, Parameter("m", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        for place in directions(model, held=True):
            if isinstance(place["support"], str):
                yield place

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        points = np.array(list(model.nodes.values()))
        return {"displacement": Normal(0.0, float(np.ptp(points, axis=0).max()) / 5000)}

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        dof = DOFS.index(self.dof)
        load = Load(values["displacement"])
        for node in supported(structure, self.support):
            if structure.arrays["fixed"][node, dof]:
                load.prescribed[node, dof] = 1.0
                continue
            # A support that a spring replaces settles by pushing on that spring.
            arrays = structure.arrays
            ground = (arrays["spring_node"][:, 0] == node) & (arrays["spring_node"][:, 1] < 0)
            stiffness = arrays["spring_stiffness"][ground & (arrays["spring_dof"] == dof)].sum()
            if stiffness == 0:
                raise InputError(
                    f"support {self.support!r} does not hold {self.dof}",
                    "support_settlement",
                    "name a direction that the support fixes",
                )
            load.forces[node] = stiffness * np.eye(6)[dof]
        return [load]
