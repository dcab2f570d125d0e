"""What a structure weighs, part by part: every per cent is half a per cent of all frequencies."""

from dataclasses import dataclass

import numpy as np

from rga.model.schema import Model

#: members that are in no group
OTHERS = "members of no group"
ON_NODES = "on nodes"


@dataclass(frozen=True)
class MassLine:
    """The mass of some parts.

    Attributes:
        of: a group of members, each of which is counted in the first of its groups; or masses on
            nodes.
        members: of the members themselves, density times area times length [kg].
        beside: what moves with them, or on nodes [kg].
    """

    of: str
    members: float
    beside: float

    @property
    def total(self) -> float:
        """Both [kg]."""
        return self.members + self.beside


def mass_budget(model: Model) -> list[MassLine]:
    """The mass of every group of members and of masses on nodes, the heaviest first.

    Args:
        model: as it was given; what effects add is not in it.

    Examples:
        >>> from rga import ModelBuilder
        >>> mast = ModelBuilder("mast").add_material("steel", E="210 GPa", density=7850)
        >>> mast = mast.add_section("tube", A="40 cm2").add_node("foot").add_node("head", z="5 m")
        >>> mast = mast.add_member("foot", "head", "tube", groups="shaft").support("foot", "pinned")
        >>> mast = mast.mass("head", "500 kg").mass_along("shaft", "40 kg/m", name="cables")
        >>> [(one.of, one.members, one.beside) for one in mass_budget(mast.build())]
        [('on nodes', 0.0, 500.0), ('shaft', 157.0, 200.0)]
    """
    along = [
        (set(_listed(one.group)), float(one.per_length or 0.0))
        for one in model.masses.values()
        if one.group is not None
    ]
    own: dict[str, float] = {}
    beside: dict[str, float] = {}
    for member in model.members.values():
        first, last = (np.array(model.nodes[node], dtype=float) for node in member.nodes)
        length = float(np.linalg.norm(last - first))
        of = member.groups[0] if member.groups else OTHERS
        density = model.materials[member.material].density
        own[of] = own.get(of, 0.0) + density * model.sections[member.section].A * length
        more = sum(line for groups, line in along if groups & set(member.groups))
        beside[of] = beside.get(of, 0.0) + more * length
    on_nodes = sum(one.mass or 0.0 for one in model.masses.values() if one.node is not None)
    lines = [MassLine(of, own[of], beside[of]) for of in own]
    lines.append(MassLine(ON_NODES, 0.0, float(on_nodes)))
    return sorted((one for one in lines if one.total > 0), key=lambda one: -one.total)


def _listed(groups: str | list[str] | None) -> list[str]:
    if groups is None:
        return []
    return [groups] if isinstance(groups, str) else groups
