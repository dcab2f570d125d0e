"""A model in the arrays that the core takes."""

import numpy as np

from rga._core import OutputKind
from rga.arrays import MemberArrays, RestraintArrays
from rga.model.schema import DOFS, Model, Sensor

#: what a sensor of each kind reads
OUTPUT_KIND = {
    "displacement": OutputKind.DISPLACEMENT,
    "rotation": OutputKind.ROTATION,
    "strain": OutputKind.STRAIN,
    "force": OutputKind.SECTION_FORCE,
    "reaction": OutputKind.REACTION_FORCE,
}
HELD_BY_PLANE = {"xz": (1, 3, 5), "xy": (2, 3, 4), "yz": (0, 4, 5)}


def member_arrays(model: Model, nodes: dict[str, int]) -> MemberArrays:
    """Nodes and members of a model, whose nodes have numbers."""
    chosen = list(model.members.values())
    materials = [model.materials[member.material] for member in chosen]
    sections = [model.sections[member.section] for member in chosen]
    connection = np.full((len(chosen), 12), np.inf)
    for row, member in zip(connection, chosen, strict=True):
        for first, released, springs in (
            (0, member.releases.i, member.end_springs.i),
            (6, member.releases.j, member.end_springs.j),
        ):
            for dof in released:
                row[first + DOFS.index(dof)] = 0.0
            for dof, stiffness in springs.items():
                row[first + DOFS.index(dof)] = stiffness
    nowhere = (np.nan, np.nan, np.nan)
    return {
        "coordinates": np.array(list(model.nodes.values()), dtype=float).reshape(-1, 3),
        "ends": np.array(
            [[nodes[n] for n in member.nodes] for member in chosen], dtype=np.int64
        ).reshape(-1, 2),
        "frame": np.array([member.kind == "frame" for member in chosen], dtype=bool),
        "E": np.array([material.E for material in materials]),
        "G": np.array([material.E / (2 * (1 + material.nu)) for material in materials]),
        "A": np.array([section.A for section in sections]),
        "Iy": np.array([section.Iy for section in sections]),
        "Iz": np.array([section.Iz for section in sections]),
        "J": np.array([section.J for section in sections]),
        "Asy": np.array([section.Asy or np.inf for section in sections]),
        "Asz": np.array([section.Asz or np.inf for section in sections]),
        "local_y": np.array([member.local_y or nowhere for member in chosen], dtype=float).reshape(
            -1, 3
        ),
        "connection": connection,
        "rigid_end": np.zeros((len(chosen), 2)),
    }


def restraint_arrays(model: Model, nodes: dict[str, int]) -> RestraintArrays:
    """What holds the nodes of a model: supports, its plane, springs and ties."""
    fixed = np.zeros((len(nodes), 6), dtype=bool)
    if model.plane is not None:
        fixed[:, HELD_BY_PLANE[model.plane]] = True
    for support in model.supports.values():
        fixed[nodes[support.node], [DOFS.index(dof) for dof in support.fixed]] = True
    inclined = [support for support in model.supports.values() if support.along is not None]
    ties = [(tie.nodes, dof) for tie in model.ties for dof in tie.dofs]
    return {
        "fixed": fixed,
        "inclined_node": np.array([nodes[support.node] for support in inclined], dtype=np.int64),
        "inclined_direction": np.array(
            [support.along for support in inclined], dtype=float
        ).reshape(-1, 3),
        "spring_node": np.array(
            [[nodes[s.node], -1 if s.to is None else nodes[s.to]] for s in model.springs],
            dtype=np.int64,
        ).reshape(-1, 2),
        "spring_dof": np.array([DOFS.index(s.dof) for s in model.springs], dtype=np.int64),
        "spring_stiffness": np.array([s.stiffness for s in model.springs], dtype=float),
        "tie_node": np.array(
            [[nodes[n] for n in pair] for pair, _ in ties], dtype=np.int64
        ).reshape(-1, 2),
        "tie_dof": np.array([DOFS.index(dof) for _, dof in ties], dtype=np.int64),
    }


def sensor_output(
    sensor: Sensor, nodes: dict[str, int], members: dict[str, int]
) -> tuple[int, int, int, tuple[float, float, float], bool]:
    """What the core reads for a sensor: kind, index, other, vector and total."""
    kind = OUTPUT_KIND[sensor.kind]
    if sensor.member is not None and sensor.kind in ("strain", "force"):
        axial = 0 if sensor.kind == "force" else -1
        place = sensor.at, sensor.y, sensor.z
        return kind, members[sensor.member], axial, place, sensor.total
    assert sensor.node is not None  # by the schema
    assert sensor.direction is not None
    x, y, z = np.array(sensor.direction) / np.linalg.norm(sensor.direction)
    other = -1 if sensor.relative_to is None else nodes[sensor.relative_to]
    return kind, nodes[sensor.node], other, (float(x), float(y), float(z)), False
