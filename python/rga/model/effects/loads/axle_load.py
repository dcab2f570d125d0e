"""Axles that move along a path of nodes."""

from collections.abc import Mapping
from itertools import pairwise
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, PrivateAttr, model_validator

from rga.arrays import FloatArray
from rga.model.axes import local_axes
from rga.model.effect import Effect, Values
from rga.model.effects.loads.load_mass import LoadMass
from rga.model.parameter import Number, Parameter, Value
from rga.model.schema import Model
from rga.model.structure import Load, Spread, Structure, check_direction, unit_vector

#: places along a path whose members carry axles, between which the lever rule shares an axle, and
#: along one member at least. Deflections of a simply supported beam are then up to 0.01 % too
#: small, drawn as one member or as several.
STATIONS, STATIONS_OF_MEMBER = 128, 16

#: places of axles that are exact beside these, at most
MOST_EXACT = 1000

#: forces on nodes, and loads along members, of a load pattern
Pattern = tuple[dict[int, FloatArray], list[Spread]]


class AxleLoad(Effect):
    """A train of axles on a path of nodes.

    An axle between two nodes of the path bends the frame member that joins them. Where none does,
    or cross girders bring it to the nodes, they share it by the lever rule. One beyond the path
    loads nothing.

    Attributes:
        path: nodes in order; the position counts along it from the first [m].
        forces: axle loads [N].
        offsets: distance of each axle behind the first [m].
        direction: in which they act, in global axes.
        carried_by: what carries an axle between two nodes: these `nodes`, or frame `members`; left
            out, the frame member that joins them, or the nodes where none does.
        factor: on all of the forces.
        position: where the first axle stands [m]; when it falls with time the train is reversed.
        inertia: the forces are weights that stand still while the structure swings, and bring their
            mass; the nodes of the path share it by the lever rule.
    """

    kind: Literal["axle_load"] = "axle_load"
    is_load = True
    keeps_past = True
    of_all_rows = frozenset({"heading"})
    loads_by_geometry = True
    path: Annotated[list[str], Field(min_length=2)]
    forces: Annotated[list[Number], Field(min_length=1)]
    offsets: list[Number]
    direction: tuple[Number, Number, Number] = (0.0, 0.0, -1.0)
    carried_by: Literal["nodes", "members"] | None = None
    factor: Annotated[Value, Parameter("-", 0.0)] = 1.0
    position: Annotated[Value, Parameter("m", None)]
    inertia: bool = False

    #: places along the path at which an axle is not shared between two others [m]
    _exact: tuple[float, ...] = PrivateAttr(default=())

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

    def check(self, model: Model) -> None:
        joined = {
            frozenset(member.nodes) for member in model.members.values() if member.kind == "frame"
        }
        for pair in pairwise(self.path):
            if self.carried_by == "members" and frozenset(pair) not in joined:
                raise ValueError(f"no frame member joins {pair[0]!r} and {pair[1]!r} of the path")

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        """Parameters of every row, and the `heading` of the train in all of them, 1 or -1.

        Where rows are followed, it shows from the row before them on.
        """
        resolved = super().values(contexts, rows)
        position = resolved["position"]
        before, heading = self.past.get("train", np.array([position[0], 1.0]))
        moves = np.diff(np.append(before, position))
        # A train that stands still heads as before.
        if moves.any():
            heading = -1.0 if (moves <= 0).all() else 1.0
        self.past["train"] = np.array([position[-1], heading])
        return {**resolved, "heading": np.full(rows, heading)}

    def swinging(self) -> Effect | None:
        return LoadMass(kind=self.kind, load=self) if self.inertia else None

    def weights(self, structure: Structure, value: Mapping[str, float]) -> FloatArray:
        """Force on each node, float[nodes] [N]."""
        numbers, stations = self._stations(structure)
        of_row = {name: np.array([one]) for name, one in value.items()}
        found = np.zeros(len(structure.arrays["coordinates"]))
        found[numbers] = self._shares(of_row, stations)[:, 0] * value["factor"]
        return found

    def exact_for(self, values: Values) -> Self:
        places = np.unique(self._stands(values))
        if len(places) > MOST_EXACT:
            return self
        found = self.model_copy()
        found._exact = tuple(places.tolist())
        return found

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        stations, patterns = structure.once_for_geometry(lambda: self._path(structure), self)
        shares = self._shares(values, stations) * values["factor"]
        permanent = not self.drivers()
        return [
            Load(share, forces=force, spread=spread, permanent=permanent)
            for share, (force, spread) in zip(shares, patterns, strict=True)
        ]

    def _path(self, structure: Structure) -> tuple[FloatArray, list[Pattern]]:
        """Places along the path that take load [m], and a unit load on each of them."""
        numbers, stations = self._stations(structure)
        force = np.append(unit_vector(self.direction), np.zeros(3))
        on_nodes: list[Pattern] = [({number: force}, []) for number in numbers]
        members = [self._between(structure, pair) for pair in pairwise(numbers)]
        carrying = sum(member is not None for member in members)
        each = max(STATIONS_OF_MEMBER, STATIONS // max(carrying, 1))
        places, patterns = [stations[:1]], on_nodes[:1]
        for ends, first, member, last in zip(
            pairwise(stations), numbers, members, on_nodes[1:], strict=False
        ):
            if member is None:
                places.append(np.array(ends[1:]))
            else:
                within = [place for place in self._exact if ends[0] < place < ends[1]]
                along = np.unique([*np.linspace(*ends, each + 1)[1:-1], *within])
                places += [along, np.array(ends[1:])]
                patterns += self._within(structure, member, first, along - ends[0])
            patterns.append(last)
        return np.concatenate(places), patterns

    def _stations(self, structure: Structure) -> tuple[list[int], FloatArray]:
        """Numbers of the nodes of the path, and where they lie along it, float[nodes] [m]."""
        numbers = [structure.nodes[node] for node in self.path]
        points = structure.arrays["coordinates"][numbers]
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        return numbers, np.append(0.0, np.cumsum(steps))

    def _between(self, structure: Structure, pair: tuple[int, int]) -> int | None:
        """Number of the frame member that carries an axle between two nodes, if one does."""
        if self.carried_by == "nodes":
            return None
        # As drawn: what an effect makes of a joint moves no load.
        frames = structure.drawn_frames
        joined = np.sort(structure.arrays["ends"][frames]) == np.sort(pair)
        found = frames[joined.all(axis=1)]
        return int(found[0]) if len(found) else None

    def _within(
        self, structure: Structure, member: int, first: int, away: FloatArray
    ) -> list[Pattern]:
        """A unit load on each place within a frame member, so far from one of its nodes [m]."""
        arrays = structure.arrays
        (length,), (axes,) = local_axes(arrays, np.array([member]))
        share = axes @ unit_vector(self.direction)
        at = away if arrays["ends"][member, 0] == first else length - away
        return [
            ({}, [(member, axis, x, x, part, 0.0) for axis, part in enumerate(share) if part])
            for x in at
        ]

    def _stands(self, values: Values) -> FloatArray:
        """Where the axles stand along the path, float[axles, rows] [m]."""
        behind = np.array(self.offsets)[:, None] * values["heading"]
        return np.asarray(values["position"] - behind)

    def _shares(self, values: Values, stations: FloatArray) -> FloatArray:
        """Force that each node of the path takes, float[nodes, rows] [N]."""
        stands = self._stands(values)
        # Of a long train few axles are on the path at a time.
        axle, row = np.nonzero(~((stands < 0) | (stands > stations[-1])))
        at, force = stands[axle, row], np.array(self.forces)[axle]
        segment = np.clip(np.searchsorted(stations, at, side="right") - 1, 0, len(stations) - 2)
        weights = force * ((at - stations[segment]) / np.diff(stations)[segment])
        rows = stands.shape[1]
        cells = segment * rows + row
        shares = np.bincount(cells, force - weights, len(stations) * rows)
        shares += np.bincount(cells + rows, weights, len(stations) * rows)
        return np.asarray(shares, dtype=float).reshape(len(stations), rows)
