"""The members and nodes of a model as arrays."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.errors import InputError
from rga.model.axes import local_axes
from rga.model.bending import normal_of
from rga.model.schema import Model

#: share of the extent of a structure that counts as none
FLAT = 1e-6
#: members of a structure beyond which no names are drawn
MOST_NAMED = 400


@dataclass(frozen=True)
class Scene:
    """A structure ready to be drawn.

    Attributes:
        model: itself.
        points: of the nodes, float[nodes, 3] [m].
        nodes, members: numbers by name.
        ends: nodes of the members, int[members, 2].
        axes: local x, y, z of the members, float[members, 3, 3].
        groups: names of the groups that are told apart by colour.
        group: number of each member's first group, int[members]; -1 for a member of none.
        normal: across the plane in which all nodes lie, float[3]; None where they do not.
    """

    model: Model
    points: FloatArray
    nodes: dict[str, int]
    members: dict[str, int]
    ends: IntArray
    axes: FloatArray
    groups: tuple[str, ...]
    group: IntArray
    normal: FloatArray | None

    @property
    def extent(self) -> float:
        """The longest side of the box around the structure [m]."""
        return float(np.ptp(self.points, axis=0).max())

    @property
    def frame(self) -> IntArray:
        """1 for a member that bends, 0 for a bar, int[members]."""
        kinds = [member.kind == "frame" for member in self.model.members.values()]
        return np.array(kinds, dtype=np.int64)

    def along(self, member: int, at: FloatArray | float) -> FloatArray:
        """Points of a member at shares 0..1 of its length, float[..., 3] [m]."""
        first, last = self.points[self.ends[member]]
        return np.asarray(first + np.multiply.outer(np.asarray(at, dtype=float), last - first))


def make_scene(model: Model) -> Scene:
    """The arrays of a model.

    Raises:
        InputError: the model has no member.

    >>> from rga.model import Model
    >>> bar = {"nodes": ("a", "b"), "section": "s", "material": "m", "groups": ["chord"]}
    >>> make_scene(Model(rga_model=1, name="bar", materials={"m": {"E": 2e11}},
    ...     sections={"s": {"A": 1e-3}}, nodes={"a": (0, 0, 0), "b": (2, 0, 0)},
    ...     members={"ab": bar}, supports={})).extent
    2.0
    """
    if not model.members:
        raise InputError("there is nothing to draw", f"model {model.name!r}", "give it members")
    points = np.array(list(model.nodes.values()), dtype=float).reshape(-1, 3)
    nodes = {name: number for number, name in enumerate(model.nodes)}
    members = list(model.members.values())
    ends = np.array([[nodes[node] for node in one.nodes] for one in members], dtype=np.int64)
    nowhere = (np.nan, np.nan, np.nan)
    local_y = np.array([one.local_y or nowhere for one in members], dtype=float)
    with np.errstate(invalid="ignore", divide="ignore"):
        _, axes = local_axes(
            {"coordinates": points, "ends": ends, "local_y": local_y}, np.arange(len(members))
        )
    first = [one.groups[0] if one.groups else None for one in members]
    groups = tuple(dict.fromkeys(name for name in first if name is not None))
    place = {name: number for number, name in enumerate(groups)}
    return Scene(
        model=model,
        points=points,
        nodes=nodes,
        members={name: number for number, name in enumerate(model.members)},
        ends=ends,
        axes=np.nan_to_num(axes),
        groups=groups,
        group=np.array([-1 if one is None else place[one] for one in first], dtype=np.int64),
        normal=_normal(model, points),
    )


def _normal(model: Model, points: FloatArray) -> FloatArray | None:
    """Across the plane of a plane model, or of nodes that lie in one plane of two axes."""
    spread = np.ptp(points, axis=0)
    stated = normal_of(model)
    across = int(np.argmax(stated)) if stated is not None else _flat_axis(spread)
    if across is None or spread[across] > FLAT * spread.max():
        return None
    return np.asarray(np.eye(3)[across])


def _flat_axis(spread: FloatArray) -> int | None:
    """Of a model in space: the axis along which it has no extent, y before x before z."""
    flat = [axis for axis in (1, 0, 2) if spread[axis] <= FLAT * spread.max()]
    return flat[0] if flat else None
