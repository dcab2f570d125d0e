"""Frame members that bend when a node turns, and what they bend with."""

import numpy as np

from rga.arrays import FloatArray
from rga.model.axes import member_axes
from rga.model.schema import DOFS, Model
from rga.model.structure.arrays import HELD_BY_PLANE

#: share of a unit axis that counts as none
ACROSS = 1e-6


def bending_at(model: Model, node: str, dof: str) -> float:
    """Sum of EI/L of the frame members that bend when a node turns about an axis [N m/rad].

    0 where the turn bends no member: at a pin, or where it only twists one.
    """
    axis = np.eye(3)[DOFS.index(dof) - 3]
    found = 0.0
    for name, member in model.members.items():
        if member.kind != "frame" or node not in member.nodes:
            continue
        first = node == member.nodes[0]
        released = member.releases.i if first else member.releases.j
        shares, stiffness = _about(model, name, axis)
        for local, share, own in zip(("ry", "rz"), shares, stiffness, strict=True):
            if local not in released and share > ACROSS:
                found += share**2 * own
    return found


def bending_stiffness(model: Model, member: str) -> float:
    """EI/L of a member [N m/rad]: in the plane of a plane model, else about its stiffer axis."""
    normal = normal_of(model)
    shares, stiffness = _about(model, member, np.zeros(3) if normal is None else normal)
    return float(stiffness.max() if normal is None else shares**2 @ stiffness)


def bending_axes(model: Model, member: str) -> list[str]:
    """Local axes, of y and z, along which a member's strain varies: one in a plane model."""
    normal = normal_of(model)
    if normal is None:
        return ["y", "z"]
    _, axes = member_axes(model, member)
    return [
        axis for axis, own in zip("yz", axes[1:], strict=True) if abs(own @ normal) < 1 - ACROSS
    ]


def normal_of(model: Model) -> FloatArray | None:
    """The axis about which a plane model turns, float[3]; None for a model in space."""
    if model.plane is None:
        return None
    (free,) = set(range(3, 6)) - set(HELD_BY_PLANE[model.plane])
    return np.asarray(np.eye(3)[free - 3])


def _about(model: Model, member: str, axis: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Shares of an axis in local y and z, float[2], and EI/L about these, float[2] [N m/rad]."""
    own = model.members[member]
    section = model.sections[own.section]
    length, axes = member_axes(model, member)
    stiffness = model.materials[own.material].E / length * np.array([section.Iy, section.Iz])
    return np.abs(axes[1:] @ axis), stiffness
