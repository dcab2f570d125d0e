"""Stresses at the fibres of sections."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import chain

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Values
from rga.model.parameter import listed
from rga.model.schema import Model, Section
from rga.simulation.critical_places import EVERY, ForcesAlong, limits

#: the fibre of a section that states none: the stress of its axial force alone
AXIS = "axis"


@dataclass(frozen=True)
class Stresses:
    """Stresses of members, tension positive.

    Attributes:
        of_members: member -> fibre -> stress [Pa], float[rows, stations].
        reduced: members whose section an effect has reduced -> what is left of it over what is
            drawn, float[rows].
        along: section forces everywhere along these members.
    """

    of_members: dict[str, dict[str, FloatArray]]
    reduced: dict[str, FloatArray]
    along: ForcesAlong

    def limits(self, rows: slice = EVERY) -> dict[str, dict[str, FloatArray]]:
        """Lowest and highest stress along a member, between its stations too.

        Returns:
            member -> fibre -> float[rows, 2] [Pa].
        """
        model, names = self.along.model, self.along.members
        parts: dict[str, dict[str, list[FloatArray]]] = {name: {} for name in names}
        for one in self.along.pieces(rows):
            of_sections: dict[str, list[int]] = {}
            for place, member in enumerate(one.members):
                of_sections.setdefault(model.members[names[member]].section, []).append(place)
            for section, places in of_sections.items():
                forces, own = one.forces[:, places], [names[one.members[k]] for k in places]
                for k, name in enumerate(own):
                    if name in self.reduced:
                        forces[:, k] /= self.reduced[name][rows][one.rows, None, None, None]
                for fibre, values in fibre_stresses(model.sections[section], forces).items():
                    for name, of_rows in zip(own, limits(values).swapaxes(0, 1), strict=True):
                        parts[name].setdefault(fibre, []).append(of_rows)
        return {
            name: {fibre: np.concatenate(of_rows) for fibre, of_rows in fibres.items()}
            for name, fibres in parts.items()
        }

    def extremes(self, rows: slice = EVERY) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest stress of every member in some rows, float[members] each [Pa]."""
        of_all = [np.stack(list(one.values())) for one in self.limits(rows).values()]
        lowest = np.array([values.min() for values in of_all])
        return lowest, np.array([values.max() for values in of_all])


def section_stresses(section_forces: FloatArray, along: ForcesAlong) -> Stresses:
    """Stresses N / A + My z / Iy - Mz y / Iz of the sections as drawn, less what they have lost.

    An effect that takes a share of a section (`member_stiffness` with a factor below one) takes it
    of A, Iy and Iz alike: at the same force a loss of 25 % is a third more stress. A section
    that is stiffer than drawn is not credited with more area.

    Args:
        section_forces: N, Vy, Vz, T, My, Mz, float[rows, members, stations, 6] [N, N m].
        along: the same everywhere along these members.
    """
    model = along.model
    left = remaining_sections(model, len(section_forces), along.parameters)
    found = {}
    for number, name in enumerate(along.members):
        forces = section_forces[:, number]
        if name in left:
            forces = forces / left[name][:, None, None]
        found[name] = fibre_stresses(model.sections[model.members[name].section], forces)
    return Stresses(found, {name: left[name] for name in along.members if name in left}, along)


def fibre_stresses(section: Section, forces: FloatArray) -> dict[str, FloatArray]:
    """Stress at each fibre of a section [Pa], or at its axis where it states none.

    Args:
        section: with A [m2], Iy, Iz [m4] and fibres (y, z) [m].
        forces: N, Vy, Vz, T, My, Mz, float[..., 6] [N, N m].

    Returns:
        float[...] of each fibre.

    >>> square = Section(A=0.01, Iy=1e-5, Iz=1e-5, fibres={"top": (0.0, 0.05)})
    >>> round(float(fibre_stresses(square, np.array([1e4, 0, 0, 0, 2e3, 0]))["top"]))
    11000000
    """
    axial = forces[..., 0] / section.A
    if not section.fibres:
        return {AXIS: axial}
    about_y = forces[..., 4] / section.Iy if section.Iy else 0.0 * axial
    about_z = forces[..., 5] / section.Iz if section.Iz else 0.0 * axial
    return {fibre: axial + about_y * z - about_z * y for fibre, (y, z) in section.fibres.items()}


def remaining_sections(
    model: Model, rows: int, parameters: Mapping[str, Values]
) -> dict[str, FloatArray]:
    """Members that have lost a share of their section -> the share that is left, float[rows]."""
    left: dict[str, FloatArray] = {}
    for name, effect in model.effects.items():
        if not effect.takes_section:
            continue
        share = np.minimum(parameters[name]["factor"], 1.0)
        groups = [model.groups[group] for group in listed(effect.place.get("group"))]
        chosen = dict.fromkeys(listed(effect.place.get("member")) + list(chain(*groups)))
        if (share < 1.0).any():
            left |= {member: left.get(member, np.ones(rows)) * share for member in chosen}
    return left
