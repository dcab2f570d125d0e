"""How a structure is held: what each support and spring holds, and on which side it stands."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from rga.arrays import FloatArray
from rga.drawing.scene.scene import Scene
from rga.model.schema import DOFS, Support
from rga.model.structure.arrays import HELD_BY_PLANE


@dataclass(frozen=True)
class SupportMark:
    """A support.

    Attributes:
        name: in the model.
        node: its number.
        held: directions along which the node is held, float[k, 3].
        clamped: axes about which it is held, float[k, 3].
        plane: the model is a plane one, whose plane holds the rest.
        outward: away from the members that meet there, float[3]; zeros where they balance.
    """

    name: str
    node: int
    held: FloatArray
    clamped: FloatArray
    plane: bool
    outward: FloatArray

    @property
    def sort(self) -> Literal["fixed", "pinned", "links"]:
        """The symbol in space: a block, a triangle, or a link along each direction held."""
        moves, turns = (2, 1) if self.plane else (3, 3)
        if len(self.held) < moves:
            return "links"
        return "fixed" if len(self.clamped) >= turns else "pinned"


@dataclass(frozen=True)
class SpringMark:
    """A spring, drawn along its direction, or about its axis where it resists a turn.

    Attributes:
        node, to: numbers of its nodes; `to` is None for the ground.
        direction: float[3].
        turns: it resists a rotation.
        stiffness: [N/m or N m/rad].
    """

    node: int
    to: int | None
    direction: FloatArray
    turns: bool
    stiffness: float


def support_marks(scene: Scene) -> list[SupportMark]:
    """The supports of a model; two at one node are drawn as one."""
    plane = scene.model.plane
    in_plane = HELD_BY_PLANE[plane] if plane is not None else ()
    free = [number for number in range(6) if number not in in_plane]
    outward = _outward(scene)
    by_node: dict[str, list[tuple[str, Support]]] = {}
    for name, support in scene.model.supports.items():
        by_node.setdefault(support.node, []).append((name, support))
    found = []
    for node, here in by_node.items():
        fixed = {DOFS.index(dof) for _, support in here for dof in support.fixed} & set(free)
        held = [np.eye(3)[k] for k in sorted(fixed) if k < 3]
        held += [
            np.array(one.along) / np.linalg.norm(one.along)
            for _, one in here
            if one.along is not None and any(one.along)
        ]
        clamped = [np.eye(3)[k - 3] for k in sorted(fixed) if k >= 3]
        number = scene.nodes[node]
        found.append(
            SupportMark(
                name=", ".join(name for name, _ in here),
                node=number,
                held=np.array(held).reshape(-1, 3),
                clamped=np.array(clamped).reshape(-1, 3),
                plane=plane is not None,
                outward=outward[number],
            )
        )
    return found


def spring_marks(scene: Scene) -> list[SpringMark]:
    """The springs of a model."""
    return [
        SpringMark(
            node=scene.nodes[spring.node],
            to=None if spring.to is None else scene.nodes[spring.to],
            direction=np.eye(3)[DOFS.index(spring.dof) % 3],
            turns=spring.dof.startswith("r"),
            stiffness=spring.stiffness,
        )
        for spring in scene.model.springs
    ]


def _outward(scene: Scene) -> FloatArray:
    """Of every node the direction away from its members, float[nodes, 3]."""
    along = scene.axes[:, 0]
    total = np.zeros_like(scene.points)
    np.add.at(total, scene.ends[:, 0], -along)
    np.add.at(total, scene.ends[:, 1], along)
    size = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(np.where(size > 1e-6, total / np.maximum(size, 1e-6), 0.0))
