"""What sizes of effects are counted in: areas and axial stiffnesses of members."""

import numpy as np

from rga.model.schema import Model


def mean_area(model: Model, group: str) -> float:
    """Mean A of the members of a group [m2]."""
    return float(np.mean([model.sections[model.members[m].section].A for m in model.groups[group]]))


def axial_stiffness(model: Model, name: str) -> float:
    """EA/L of a member [N/m]."""
    member = model.members[name]
    ends = [np.array(model.nodes[node]) for node in member.nodes]
    modulus = model.materials[member.material].E
    return float(modulus * model.sections[member.section].A / np.linalg.norm(ends[1] - ends[0]))


def mean_axial_stiffness(model: Model) -> float:
    """Mean EA/L of all members [N/m]."""
    return float(np.mean([axial_stiffness(model, name) for name in model.members]))
