"""Loads at nodes."""

from collections.abc import Mapping
from typing import Annotated, Literal

import numpy as np
from pydantic import model_validator

from rga.arrays import FloatArray
from rga.model.effect import Effect, Values
from rga.model.effects.loads.load_mass import LoadMass
from rga.model.parameter import Number, Parameter, Value
from rga.model.structure import Load, Structure


class NodalLoad(Effect):
    """Forces and moments at nodes.

    Attributes:
        forces: [fx, fy, fz] or [fx, fy, fz, mx, my, mz] of each node [N, N m].
        factor: on all of them.
        inertia: the forces are weights that stand on the nodes while the structure swings, such as
            a parked vehicle, and bring their mass.
    """

    kind: Literal["nodal_load"] = "nodal_load"
    is_load = True
    loads_by_geometry = True
    forces: dict[str, list[Number]]
    factor: Annotated[Value, Parameter("-", 0.0)] = 1.0
    inertia: bool = False

    @model_validator(mode="after")
    def _components(self) -> "NodalLoad":
        for node, force in self.forces.items():
            if len(force) not in (3, 6):
                raise ValueError(f"forces.{node}: give [fx, fy, fz] or [fx, fy, fz, mx, my, mz]")
        return self

    @property
    def nodes(self) -> list[str]:
        """Nodes that must be in the model."""
        return list(self.forces)

    def swinging(self) -> Effect | None:
        return LoadMass(kind=self.kind, load=self) if self.inertia else None

    def weights(self, structure: Structure, value: Mapping[str, float]) -> FloatArray:
        """Force on each node, float[nodes] [N]."""
        found = np.zeros(len(structure.arrays["coordinates"]))
        for node, force in self.forces.items():
            found[structure.nodes[node]] = np.linalg.norm(force[:3]) * value["factor"]
        return found

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        forces = structure.once_for_geometry(
            lambda: {
                structure.nodes[node]: np.array([*force, 0.0, 0.0, 0.0][:6])
                for node, force in self.forces.items()
            },
            self,
        )
        return [Load(values["factor"], forces=forces, permanent=not self.drivers())]
