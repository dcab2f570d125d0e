"""Axles that move along a path of nodes."""

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from rga.model.effect import Effect, Values
from rga.model.parameter import FloatArray, Number, Parameter, Value
from rga.model.structure import Load, Structure, check_direction, unit_vector


class AxleLoad(Effect):
    """A train of axles on a path of nodes.

    An axle between two nodes of the path is shared between them by the lever rule; one beyond the
    path loads nothing.

    Attributes:
        path: nodes in order; the position counts along it from the first [m].
        forces: axle loads [N], acting along `direction`.
        offsets: distance of each axle behind the first [m].
        position: where the first axle stands [m]; when it falls with time the train is reversed.
    """

    kind: Literal["axle_load"] = "axle_load"
    loads_by_geometry = True
    path: Annotated[list[str], Field(min_length=2)]
    forces: Annotated[list[Number], Field(min_length=1)]
    offsets: list[Number]
    direction: tuple[Number, Number, Number] = (0.0, 0.0, -1.0)
    factor: Annotated[Value, Parameter("-", 0.0)] = 1.0
    position: Annotated[Value, Parameter("m", None)]

    @model_validator(mode="after")
    def _pairs(self) -> "AxleLoad":
        if len(self.forces) != len(self.offsets):
            raise ValueError(f"{len(self.forces)} forces but {len(self.offsets)} offsets")
        if len(set(self.path)) < len(self.path):
            raise ValueError("the path meets a node twice")
        check_direction(self.direction)
        return self

    @property
    def nodes(self) -> list[str]:
        """Nodes that must be in the model."""
        return self.path

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        numbers = [structure.nodes[node] for node in self.path]
        points = structure.arrays["coordinates"][numbers]
        stations = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
        shares = self._shares(values["position"], stations) * values["factor"][:, None]
        force = np.append(unit_vector(self.direction), np.zeros(3))
        fast = not self.drivers()
        return [
            Load(shares[:, k], forces={number: force}, permanent=fast)
            for k, number in enumerate(numbers)
        ]

    def _shares(self, position: FloatArray, stations: FloatArray) -> FloatArray:
        """Force that each node of the path takes, float[rows, nodes] [N]."""
        reversed_train = len(position) > 1 and bool(np.all(np.diff(position) < 0))
        offsets = np.array(self.offsets) * (1 if reversed_train else -1)
        stands = position[:, None] + offsets
        on_path = (stands >= 0) & (stands <= stations[-1])
        segment = np.clip(np.searchsorted(stations, stands, side="right") - 1, 0, len(stations) - 2)
        ratio = (stands - stations[segment]) / np.diff(stations)[segment]
        force = np.where(on_path, np.array(self.forces), 0.0)
        nodes = len(stations)
        first = segment + nodes * np.arange(len(position))[:, None]
        cells = np.concatenate([first.ravel(), first.ravel() + 1])
        weights = np.concatenate([(force * (1 - ratio)).ravel(), (force * ratio).ravel()])
        shares = np.bincount(cells, weights, minlength=nodes * len(position))
        return np.asarray(shares, dtype=float).reshape(len(position), nodes)
