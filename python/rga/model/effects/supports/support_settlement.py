"""Supports that have moved."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

import numpy as np

from rga.errors import InputError
from rga.model.action import Action
from rga.model.effect import Effect, Values
from rga.model.effects.supports.directions import Direction, Supports, directions, supported
from rga.model.parameter import Normal, Parameter, Prior, Value
from rga.model.schema import DOFS, Model
from rga.model.structure import Load, Structure

USUAL, SHARE = Normal(0.0, 1.0), 5000


class SupportSettlement(Effect):
    """A displacement [m or rad] of a direction that the support holds."""

    kind: Literal["support_settlement"] = "support_settlement"
    action = Action(
        inspect="pier or abutment at {place}: scour, cracks, tilt, and the ground about it",
        check="levels of the bearings against a bench mark away from the structure",
        test="level the bearings again after some weeks: has it stopped?",
    )
    usual = (
        f"displacement {USUAL} times 1/{SHARE} of the largest dimension of the structure: a "
        "judgement, below the 1/500 between supports that many structures bear (EN 1997-1, annex H)"
    )
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
        return {"displacement": USUAL.times(float(np.ptp(points, axis=0).max()) / SHARE)}

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
