"""The directions from which a structure is looked at."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.drawing.projection import Projection, views
from rga.drawing.scene.scene import Scene

#: an axonometry turned and tilted by so much [rad]
TURN, TILT = np.radians(35.0), np.radians(24.0)
#: height over length of an elevation that shows nothing
LOW = 0.02
Direction = tuple[float, float, float]


@dataclass(frozen=True)
class View:
    """A view of a structure.

    Attributes:
        title: in words.
        right, up: directions in space that run to the right and upwards on the paper.
        nodes, members: numbers of what is drawn.
    """

    title: str
    right: Direction
    up: Direction
    nodes: IntArray
    members: IntArray

    @property
    def towards(self) -> FloatArray:
        """The direction from the paper to the reader, float[3]."""
        return np.cross(self.right, self.up)

    @property
    def straight(self) -> bool:
        """Whether two of the global axes lie in the paper."""
        return bool(max(np.abs(self.right)) > 1 - 1e-9 and max(np.abs(self.up)) > 1 - 1e-9)

    def flat(self, points: FloatArray) -> FloatArray:
        """Points or directions float[..., 3] on the paper, float[..., 2]."""
        return np.asarray(points @ np.array([self.right, self.up]).T)


def views_of(scene: Scene) -> list[View]:
    """The views of a drawing: one of a plane structure, else an axonometry and elevations."""
    if scene.normal is not None:
        return [_in_plane(scene, scene.normal)]
    trusses = [view for view in views(scene.model, set()) if view.title != "plan"]
    found = [_of(scene, view) for view in trusses]
    # A row of nodes is no elevation.
    high = [one for one in found if _rises(scene, one)]
    if len(high) < 2:
        return [axonometry(scene), *_sides(scene)]
    return [axonometry(scene), *high, _sides(scene)[-1]]


def _rises(scene: Scene, view: View) -> bool:
    wide, high = np.ptp(view.flat(scene.points[view.nodes]), axis=0)
    return bool(high > LOW * wide)


def axonometry(scene: Scene) -> View:
    """A view from the side and above, along which no lines of a usual structure fall together."""
    spread = np.ptp(scene.points, axis=0)
    # The longer side runs to the right.
    turn = -TURN if spread[1] <= spread[0] else np.pi / 2 - TURN
    cos, sin = float(np.cos(turn)), float(np.sin(turn))
    low, high = float(np.sin(TILT)), float(np.cos(TILT))
    return _whole(scene, "axonometry", (cos, sin, 0.0), (-sin * low, cos * low, high))


def _in_plane(scene: Scene, normal: FloatArray) -> View:
    across = int(np.argmax(normal))
    right, up = ((1, 2), (0, 2), (0, 1))[across]
    title = "plan" if across == 2 else "elevation"
    return _whole(scene, title, _axis(right), _axis(up))


def _sides(scene: Scene) -> list[View]:
    spread = np.ptp(scene.points, axis=0)
    long = 0 if spread[0] >= spread[1] else 1
    return [
        _whole(scene, f"elevation along {'xy'[long]}", _axis(long), _axis(2)),
        _whole(scene, f"elevation along {'yx'[long]}", _axis(1 - long), _axis(2)),
        _whole(scene, "plan", _axis(long), _axis(1 - long)),
    ]


def _axis(number: int) -> Direction:
    return (float(number == 0), float(number == 1), float(number == 2))


def _whole(scene: Scene, title: str, right: Direction, up: Direction) -> View:
    return View(title, right, up, np.arange(len(scene.points)), np.arange(len(scene.ends)))


def _of(scene: Scene, view: Projection) -> View:
    nodes = np.array(sorted(scene.nodes[name] for name in view.nodes), dtype=np.int64)
    members = np.array([scene.members[name] for name in view.members], dtype=np.int64)
    right, up = view.axes
    return View(view.title, _axis(right), _axis(up), nodes, members)
