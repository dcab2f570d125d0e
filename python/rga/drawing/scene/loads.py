"""The forces that load effects put on a structure, one effect at a time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.drawing.scene.scene import Scene
from rga.drawing.states.contexts import context_words, settled, upper_ends
from rga.errors import InputError
from rga.model.effect import Values
from rga.model.effects.loads.axle_load import AxleLoad
from rga.model.parameter import Driven
from rga.model.structure import Load, Structure, build_structure
from rga.simulation import Simulator

#: share of the largest force of an effect below which one is not drawn
FAINT_FORCE = 1e-6


@dataclass(frozen=True)
class AlongMember:
    """A load along part of a member, growing evenly.

    Attributes:
        member: its number.
        places: from and to, as shares of its length.
        forces: at both, float[2, 3] [N/m].
    """

    member: int
    places: tuple[float, float]
    forces: FloatArray


@dataclass(frozen=True)
class LoadMark:
    """A load effect at given contexts.

    Attributes:
        name: of the effect.
        at: the contexts that it follows, in words; empty where it follows none.
        points, forces: where forces act, and these, float[k, 3] [m] and [N].
        nodes: the node at each, or an end of the member that carries it, int[k].
        turned, moments: nodes on which moments act, int[k], and these, float[k, 3] [N m].
        along: loads along members.
        path: nodes of the path of axles, in order; empty for other loads.
    """

    name: str
    at: str
    points: FloatArray
    forces: FloatArray
    nodes: IntArray
    turned: IntArray
    moments: FloatArray
    along: tuple[AlongMember, ...] = ()
    path: tuple[int, ...] = ()

    @property
    def largest(self) -> tuple[float, str]:
        """The largest force, load along a member or moment, and its unit."""
        sizes = [
            (self.forces, "N"),
            (np.array([one.forces for one in self.along]).reshape(-1, 3), "N/m"),
            (self.moments, "N m"),
        ]
        for vectors, unit in sizes:
            if len(vectors):
                return float(np.linalg.norm(vectors, axis=1).max()), unit
        return 0.0, "N"


def load_marks(
    scene: Scene,
    chosen: Sequence[str] | None = None,
    contexts: Mapping[str, float] | None = None,
) -> list[LoadMark]:
    """Loads at contexts; those not given stand at mid-range.

    A load that is nothing at mid-range is taken at the upper ends of its contexts, where none of
    these was given. Axles whose position was not given stand in the middle of their path.

    Args:
        scene: the structure.
        chosen: names of effects; None: all.
        contexts: given values.

    Raises:
        InputError: a name that is no load of the model, or none at these contexts; an unknown
            context.
    """
    model = scene.model
    names = [name for name, effect in model.effects.items() if effect.overrides("loads")]
    for name in chosen or ():
        if name not in names:
            raise InputError(
                f"there is no load {name!r}",
                f"model {model.name!r}",
                "it has " + (", ".join(names) or "none"),
            )
    wanted = [name for name in names if chosen is None or name in chosen]
    first = settled(model, contexts)
    structure = build_structure(model)
    found: dict[str, LoadMark] = {}
    for table in (first, upper_ends(model, contexts)):
        open_names = [name for name in wanted if name not in found]
        if open_names:
            found |= _at(scene, structure, open_names, table, set(contexts or {}))
    for name in chosen or ():
        if name not in found:
            raise InputError(
                f"{name!r} puts no force on nodes or members",
                "the contexts that are drawn",
                "choose another load, or contexts at which it acts",
            )
    return [found[name] for name in wanted if name in found]


def _at(
    scene: Scene,
    structure: Structure,
    names: Sequence[str],
    contexts: Mapping[str, float],
    given: set[str],
) -> dict[str, LoadMark]:
    """Those of the effects that are loads at these contexts."""
    model = scene.model
    table = {name: np.array([float(value)]) for name, value in contexts.items()}
    table.setdefault("time", np.zeros(1))
    values = Simulator(model).resolve(table)
    loads = {
        name: effect.loads(structure, values[name], values)
        for name, effect in model.effects.items()
    }
    for name, effect in model.effects.items():
        effect.change_loads(loads, structure, values[name])
    found = {}
    for name in names:
        effect = model.effects[name]
        at = context_words(model, contexts, effect.drivers())
        if isinstance(effect, AxleLoad):
            moves = isinstance(effect.position, Driven)
            mark = _axles(
                scene, name, effect, values[name], at, moves and not effect.drivers() & given
            )
        else:
            mark = _summed(scene, name, loads[name], at)
        if mark.largest[0] > 0:
            found[name] = mark
    return found


def _summed(scene: Scene, name: str, loads: list[Load], at: str) -> LoadMark:
    """The sum of the patterns of a load."""
    total = np.zeros((len(scene.points), 6))
    spread: dict[tuple[int, float, float], FloatArray] = {}
    for load in loads:
        coefficient = float(load.coefficient[0])
        for node, force in load.forces.items():
            if node < len(total):
                total[node] += coefficient * force
        for member, axis, start, end, *values in load.spread:
            forces = np.outer(values, coefficient * scene.axes[member, axis])
            place = member, start, end
            spread[place] = spread.get(place, np.zeros((2, 3))) + forces
    along = []
    for (member, start, end), forces in spread.items():
        length = float(np.linalg.norm(np.diff(scene.points[scene.ends[member]], axis=0)))
        if np.any(forces):
            along.append(AlongMember(member, (start / length, end / length), forces))
    # A force at a point of a member stands among those along members, without a length.
    at_points = [one for one in along if one.places[0] == one.places[1]]
    places = [scene.along(one.member, one.places[0]) for one in at_points]
    pushes = [one.forces[0] for one in at_points]
    carriers = [int(scene.ends[one.member, 0]) for one in at_points]
    pushed, turned = _worth_drawing(total[:, :3]), _worth_drawing(total[:, 3:])
    return LoadMark(
        name=name,
        at=at,
        points=np.vstack([scene.points[pushed], *places]),
        forces=np.vstack([total[pushed, :3], *pushes]),
        nodes=np.array([*pushed, *carriers], dtype=np.int64),
        turned=turned,
        moments=total[turned, 3:],
        along=tuple(one for one in along if one.places[0] != one.places[1]),
    )


def _worth_drawing(vectors: FloatArray) -> IntArray:
    sizes = np.linalg.norm(vectors, axis=1)
    return np.flatnonzero(sizes > FAINT_FORCE * sizes.max(initial=0.0))


def _axles(
    scene: Scene, name: str, effect: AxleLoad, values: Values, at: str, centred: bool
) -> LoadMark:
    """Axles where they stand, or in the middle of their path, whatever carries them."""
    numbers = [scene.nodes[node] for node in effect.path]
    path = scene.points[numbers]
    stations = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(path, axis=0), axis=1)))
    stands = values["position"][0] - np.array(effect.offsets) * values["heading"][0]
    if centred:
        stands += stations[-1] / 2 - (stands.min() + stands.max()) / 2
        at = "the middle of its path"
    there = (stands >= 0) & (stands <= stations[-1])
    points = np.array([np.interp(stands[there], stations, axis) for axis in path.T]).T
    segment = np.clip(np.searchsorted(stations, stands[there]) - 1, 0, len(stations) - 2)
    direction = np.array(effect.direction) / np.linalg.norm(effect.direction)
    sizes = values["factor"][0] * np.array(effect.forces, dtype=float)[there]
    return LoadMark(
        name=name,
        at=at,
        points=points,
        forces=np.outer(sizes, direction),
        nodes=np.array(numbers, dtype=np.int64)[segment],
        turned=np.zeros(0, dtype=np.int64),
        moments=np.zeros((0, 3)),
        path=tuple(numbers),
    )
