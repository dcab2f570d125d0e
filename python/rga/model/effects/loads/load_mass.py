"""The mass of loads that stand on the structure while it swings, such as a parked truck."""

from collections.abc import Mapping
from typing import Protocol, cast

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.effect import Effect, Values
from rga.model.structure import Structure

#: standard acceleration of free fall [m/s2] (ISO 80000-3)
GRAVITY = 9.80665


class Weighing(Protocol):
    """A load that can say what stands on the nodes."""

    def weights(self, structure: Structure, value: Mapping[str, float]) -> FloatArray:
        """Force on each node [N], float[nodes], whatever its direction."""


class LoadMass(Effect):
    """Stands in for a load with `"inertia": true` where natural frequencies are computed.

    Attributes:
        load: whose weight is the mass.
    """

    structural = True
    load: Effect

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        return self.load.values(contexts, rows)

    def drivers(self) -> set[str]:
        return self.load.drivers()

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        """Put the masses on the nodes, in place (InputError where a load lifts)."""
        weights = cast(Weighing, self.load).weights(structure, value)
        if weights.min() < 0.0:
            raise InputError(
                f"a {self.load.kind} with inertia is less than nothing, and no mass is",
                "effects of the model",
                "give forces and a factor that are not negative, or leave out inertia",
            )
        structure.masses["nodal"][: len(weights), :3] += (weights / GRAVITY)[:, np.newaxis]
