"""Masses of a model, as the core takes them, all together and by what they are of."""

from collections.abc import Iterable

import numpy as np

from rga.arrays import FloatArray, MassArrays
from rga.model.parameter import listed
from rga.model.schema import Mass, Model


def masses_of(
    model: Model, materials: Iterable[str] | None = None, names: Iterable[str] | None = None
) -> MassArrays:
    """Masses of members by density and area, and those that the model states beside them.

    A section turns with its member about the local x axis; about the others where the member
    deforms in shear, without which this is as small (Timoshenko, On the correction for shear of the
    differential equation for transverse vibrations of prismatic bars, Phil. Mag. 41, 1921).

    Args:
        model: the model.
        materials: whose members are weighed; None: all.
        names: of masses of the model that are weighed; None: all.

    Returns:
        line float[members] [kg/m], section float[members, 3] [kg m], nodal float[nodes, 6] [kg and
        kg m2].
    """
    weighed = set(model.materials if materials is None else materials)
    members = list(model.members.values())
    density = np.array(
        [model.materials[m.material].density if m.material in weighed else 0.0 for m in members]
    )
    sections = [model.sections[member.section] for member in members]
    line = density * np.array([section.A for section in sections])
    turning = [
        (one.Iy + one.Iz, one.Iy if one.Asz else 0.0, one.Iz if one.Asy else 0.0)
        for one in sections
    ]
    nodal = np.zeros((len(model.nodes), 6))
    nodes = {name: number for number, name in enumerate(model.nodes)}
    numbers = {name: number for number, name in enumerate(model.members)}
    for name in model.masses if names is None else names:
        mass = model.masses[name]
        if mass.node is not None:
            nodal[nodes[mass.node]] += _on_node(mass)
        else:
            named = {member for group in listed(mass.group) for member in model.groups[group]}
            line[[numbers[member] for member in sorted(named)]] += mass.per_length or 0.0
    section = density[:, None] * np.array(turning, dtype=float).reshape(-1, 3)
    return {"line": line, "section": section, "nodal": nodal}


def _on_node(mass: Mass) -> FloatArray:
    return np.array([*[mass.mass or 0.0] * 3, *mass.inertia])
