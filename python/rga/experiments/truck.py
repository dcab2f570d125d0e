"""A truck for load tests: its axles, the lanes on which it may drive, and where it may stand.

Where no axles cross the model, test weights stand in a row instead of a truck's axles.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.effect import Effect
from rga.model.effects.loads.axle_load import AxleLoad
from rga.model.effects.loads.nodal_load import NodalLoad
from rga.model.parameter import Driven, listed
from rga.model.schema import Model
from rga.model.structure.arrays import HELD_BY_PLANE
from rga.quantities import plain

#: places along a lane at which a truck may stand, at most
STANDS = 24
#: share of the longest chain of loaded nodes that makes a chain a lane
LONG = 0.8
#: names of the contexts that drive the truck, and of its effects
FACTOR, POSITION, TRUCK = "truck [-]", "truck position [m]", "truck"
#: axle load beyond which it is a slip of the pen [kN]
HEAVIEST = 1e5
#: how a truck is written, for errors
WRITTEN = "write axle loads [kN] @ spacings [m], such as 60,100@3.5"


@dataclass(frozen=True)
class Truck:
    """Axle loads [kN] and the spacings from one axle to the next [m].

    >>> Truck((60.0, 100.0), (3.5,)).length
    3.5
    """

    loads: tuple[float, ...]
    spacings: tuple[float, ...]

    @property
    def length(self) -> float:
        """From the first axle to the last [m]."""
        return sum(self.spacings)

    @property
    def words(self) -> str:
        """Loads and spacings, as people say them.

        >>> Truck((60.0, 100.0), (3.5,)).words, Truck((60.0, 80.0, 80.0), (3.5, 1.3)).words
        ('60 and 100 kN, 3.5 m apart', '60, 80 and 80 kN, 3.5 and 1.3 m apart')
        """
        loads = f"{_listed(self.loads)} kN"
        return f"{loads}, {_listed(self.spacings)} m apart" if self.spacings else loads

    def __str__(self) -> str:
        loads, spacings = (",".join(f"{x:g}" for x in part) for part in (self.loads, self.spacings))
        return f"{loads}@{spacings}" if spacings else loads


def _listed(numbers: tuple[float, ...]) -> str:
    *others, last = [f"{one:g}" for one in numbers]
    return f"{', '.join(others)} and {last}" if others else last


def read_truck(text: str) -> Truck:
    """A truck from its text.

    >>> read_truck("60,100@3.5")
    Truck(loads=(60.0, 100.0), spacings=(3.5,))

    Raises:
        InputError: no numbers, not one spacing fewer than axles, a load that lifts, or one
            that nothing weighs.
    """
    loads, _, spacings = text.partition("@")
    try:
        truck = Truck(
            tuple(float(plain(x)) for x in loads.split(",")),
            tuple(float(plain(x)) for x in spacings.split(",") if spacings.strip()),
        )
    except ValueError:
        raise InputError(f"{text!r} is no truck", "--truck", WRITTEN) from None
    if len(truck.spacings) != len(truck.loads) - 1:
        raise InputError(
            f"{len(truck.loads)} axles have {len(truck.spacings)} spacings", "--truck", WRITTEN
        )
    if not all(isfinite(x) and x > 0 for x in (*truck.loads, *truck.spacings)):
        raise InputError(
            f"{text!r} has an axle load or a spacing that is not above zero", "--truck", WRITTEN
        )
    if max(truck.loads) > HEAVIEST:
        raise InputError(
            f"an axle of {max(truck.loads):g} kN stands on no structure", "--truck", WRITTEN
        )
    return truck


@dataclass(frozen=True)
class Lane:
    """Paths of nodes that share a truck.

    Attributes:
        paths: nodes in order; the truck's position counts along each from its first [m].
        shares: of the truck that each path carries [-].
        length: of the shortest path [m].
        stations: where the nodes of the first path stand along it [m].
        driven: whether loads drive on it; else a truck on it is a row of test weights.
    """

    paths: tuple[tuple[str, ...], ...]
    shares: tuple[float, ...]
    length: float
    stations: tuple[float, ...]
    driven: bool = True

    @property
    def load(self) -> str:
        """What stands on it, in words."""
        return "truck with its first axle" if self.driven else "known weights with the first"

    def described(self, truck: Truck) -> str:
        """What a truck on it weighs, as an advice has it."""
        return f"{'axles of ' if self.driven else ''}{truck.words}"

    def nearest(self, position: float) -> str:
        """The node of the first path nearest to a position [m]."""
        return self.paths[0][int(np.argmin(np.abs(np.array(self.stations) - position)))]

    def stands(self, truck: Truck, most: int = STANDS) -> list[float]:
        """Positions of the first axle, so many at most, with the truck about a node of a path.

        Raises:
            InputError: the truck is longer than the lane.
        """
        if truck.length > self.length:
            raise InputError(
                f"the truck is {truck.length:g} m long and its path {self.length:g} m",
                "--truck",
                "give a truck that stands on the path",
            )
        middles = np.array(self.stations) + truck.length / 2
        places = np.unique(np.round(np.clip(middles, truck.length, self.length), 3))
        chosen = np.linspace(0, len(places) - 1, min(most, len(places))).astype(int)
        return [float(place) for place in places[np.unique(chosen)]]

    def effects(self, truck: Truck, inertia: bool = False) -> dict[str, Effect]:
        """The truck as loads that the contexts FACTOR and POSITION drive, with its mass or not."""
        offsets = [0.0, *np.cumsum(truck.spacings).tolist()]
        return {
            f"{TRUCK} {number + 1}": AxleLoad(
                path=list(path),
                forces=[1e3 * share * load for load in truck.loads],
                offsets=offsets,
                factor=Driven(context=FACTOR),
                position=Driven(context=POSITION),
                inertia=inertia,
            )
            for number, (path, share) in enumerate(zip(self.paths, self.shares, strict=True))
        }


def given_lane(model: Model, paths: Sequence[Sequence[str]]) -> Lane:
    """A lane on paths of nodes that the user names; they share the truck alike.

    Raises:
        InputError: a node that the model lacks, a path of less than two nodes or with one twice.
    """
    for path in paths:
        for node in path:
            if node not in model.nodes:
                raise InputError(
                    f"there is no node {node!r}", f"model {model.name!r}", "name nodes of the model"
                )
        if len(set(path)) < max(len(path), 2):
            raise InputError(
                f"{', '.join(path)!r} is no path", "--path", "name two nodes or more, each once"
            )
    return _lane(model, [tuple(path) for path in paths], np.ones(len(paths)))


def lane_of(model: Model) -> Lane | None:
    """The lane that the loads of a model show, or None.

    Axles that one context moves share their paths as they share their loads. Without axles, long
    chains of nodes that carry vertical loads are taken, alike.
    """
    axles = [effect for effect in model.effects.values() if isinstance(effect, AxleLoad)]
    if axles:
        together = [one for one in axles if one.drivers() == axles[0].drivers()]
        of_path: dict[tuple[str, ...], float] = {}
        for one in together:
            path = tuple(one.path)
            of_path[path] = of_path.get(path, 0.0) + abs(sum(one.forces))
        if sum(of_path.values()) > 0:
            return _lane(model, list(of_path), np.array(list(of_path.values())))
    loaded = {
        node
        for effect in model.effects.values()
        if isinstance(effect, NodalLoad)
        for node, force in effect.forces.items()
        if force[2] < 0
    }
    return _along_chains(model, loaded)


def lane_of_masses(model: Model) -> Lane | None:
    """The lane that the masses of a model show where its loads show none, or None.

    Long chains of nodes that carry a mass by themselves, or along the members of a group.
    """
    carrying = {one.node for one in model.masses.values() if one.node is not None}
    for one in model.masses.values():
        for group in listed(one.group) if one.group is not None else ():
            carrying |= {node for name in model.groups[group] for node in model.members[name].nodes}
    return _along_chains(model, carrying)


def _along_chains(model: Model, nodes: set[str]) -> Lane | None:
    chains = _long_chains(model, nodes)
    return replace(_lane(model, chains, np.ones(len(chains))), driven=False) if chains else None


def _lane(model: Model, paths: Sequence[tuple[str, ...]], weights: FloatArray) -> Lane:
    stations = []
    for path in paths:
        points = np.array([model.nodes[node] for node in path])
        steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
        stations.append(np.append(0.0, np.cumsum(steps)))
    shares = tuple((weights / weights.sum()).tolist())
    length = min(float(one[-1]) for one in stations)
    return Lane(tuple(paths), shares, length, tuple(stations[0].tolist()))


def _long_chains(model: Model, nodes: set[str]) -> list[tuple[str, ...]]:
    """Long rows of nodes, along the longer horizontal axis."""
    held = HELD_BY_PLANE.get(model.plane or "", ())
    if 2 in held or len(nodes) < 2:
        return []
    points = {node: model.nodes[node] for node in model.nodes if node in nodes}
    along = int(np.argmax(np.ptp(np.array(list(points.values()))[:, :2], axis=0)))
    rows: dict[float, list[str]] = {}
    for node in sorted(points, key=lambda node: points[node][along]):
        rows.setdefault(round(points[node][1 - along], 3), []).append(node)
    extent = {at: points[row[-1]][along] - points[row[0]][along] for at, row in rows.items()}
    longest = max(extent.values())
    chains = [
        tuple(rows[at]) for at in sorted(rows) if longest > 0 and extent[at] >= LONG * longest
    ]
    return [chain for chain in chains if len({points[node][along] for node in chain}) == len(chain)]
