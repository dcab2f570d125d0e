"""Axles that move along a path of nodes."""

from collections.abc import Mapping
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
    of_all_rows = frozenset({"heading"})
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

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        """Parameters of every row, and the `heading` of the train in all of them, 1 or -1."""
        resolved = super().values(contexts, rows)
        backwards = rows > 1 and bool(np.all(np.diff(resolved["position"]) < 0))
        return {**resolved, "heading": np.full(rows, -1.0 if backwards else 1.0)}

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        stations, forces = structure.once(lambda: self._path(structure), self)
        shares = self._shares(values, stations) * values["factor"]
        permanent = not self.drivers()
        return [
            Load(share, forces=force, permanent=permanent)
            for share, force in zip(shares, forces, strict=True)
        ]

    def _path(self, structure: Structure) -> tuple[FloatArray, list[dict[int, FloatArray]]]:
        """Where the nodes stand along the path [m], and a unit load on each of them."""
        numbers = [structure.nodes[node] for node in self.path]
        points = structure.arrays["coordinates"][numbers]
        stations = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
        force = np.append(unit_vector(self.direction), np.zeros(3))
        return stations, [{number: force} for number in numbers]

    def _shares(self, values: Values, stations: FloatArray) -> FloatArray:
        """Force that each node of the path takes, float[nodes, rows] [N]."""
        stands = values["position"] - np.array(self.offsets)[:, None] * values["heading"]
        on_path = (stands >= 0) & (stands <= stations[-1])
        segment = np.clip(np.searchsorted(stations, stands, side="right") - 1, 0, len(stations) - 2)
        ratio = (stands - stations[segment]) / np.diff(stations)[segment]
        force = np.where(on_path, np.array(self.forces)[:, None], 0.0)
        rows = stands.shape[1]
        cells = segment * rows + np.arange(rows)
        weights = force * ratio
        shares = np.bincount(cells.ravel(), (force - weights).ravel(), len(stations) * rows)
        shares += np.bincount((cells + rows).ravel(), weights.ravel(), len(stations) * rows)
        return np.asarray(shares, dtype=float).reshape(len(stations), rows)
