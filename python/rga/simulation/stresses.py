"""Stresses at the fibres of sections."""

from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Values
from rga.model.schema import Model, Section
from rga.model.structure import build_structure

#: the fibre of a section that states none: the stress of its axial force alone
AXIS = "axis"


@dataclass(frozen=True)
class Stresses:
    """Stresses of members, tension positive.

    Attributes:
        of_members: member -> fibre -> stress [Pa], float[rows, stations].
        reduced: members whose section an effect has reduced -> what is left of it over what is
            drawn, float[rows].
    """

    of_members: dict[str, dict[str, FloatArray]]
    reduced: dict[str, FloatArray]

    def extremes(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest stress of every member, float[members] each [Pa]."""
        of_all = [np.stack(list(fibres.values())) for fibres in self.of_members.values()]
        lowest = np.array([values.min(initial=np.inf) for values in of_all])
        return lowest, np.array([values.max(initial=-np.inf) for values in of_all])


def section_stresses(
    model: Model, section_forces: FloatArray, parameters: dict[str, Values]
) -> Stresses:
    """Stresses N / A + My z / Iy - Mz y / Iz of the sections as drawn, less what they have lost.

    An effect that takes a share of a section (`member_stiffness` with a factor below one) takes it
    of A, Iy and Iz alike: at the same force a loss of 25 % is a third more stress. A section
    that is stiffer than drawn is not credited with more area.

    Args:
        model: the structure with its effects.
        section_forces: N, Vy, Vz, T, My, Mz, float[rows, members, stations, 6] [N, N m].
        parameters: of all effects, by name, as `Simulator.resolve` gives them.
    """
    left = remaining_sections(model, len(section_forces), parameters)
    found = {}
    for number, (name, member) in enumerate(model.members.items()):
        forces = section_forces[:, number]
        if name in left:
            forces = forces / left[name][:, None, None]
        found[name] = fibre_stresses(model.sections[member.section], forces)
    return Stresses(found, left)


def fibre_stresses(section: Section, forces: FloatArray) -> dict[str, FloatArray]:
    """Stress at each fibre of a section [Pa], or at its axis where it states none.

    Args:
        section: with A [m2], Iy, Iz [m4] and fibres (y, z) [m].
        forces: N, Vy, Vz, T, My, Mz, float[..., 6] [N, N m].

    Returns:
        float[...] of each fibre.

    >>> square = Section(A=0.01, Iy=1e-5, Iz=1e-5, fibres={"top": (0.0, 0.05)})
    >>> float(fibre_stresses(square, np.array([1e4, 0, 0, 0, 2e3, 0]))["top"])
    11000000.0
    """
    axial = forces[..., 0] / section.A
    if not section.fibres:
        return {AXIS: axial}
    about_y = forces[..., 4] / section.Iy if section.Iy else 0.0 * axial
    about_z = forces[..., 5] / section.Iz if section.Iz else 0.0 * axial
    return {fibre: axial + about_y * z - about_z * y for fibre, (y, z) in section.fibres.items()}


def remaining_sections(
    model: Model, rows: int, parameters: dict[str, Values]
) -> dict[str, FloatArray]:
    """Members that have lost a share of their section -> the share that is left, float[rows]."""
    structure = build_structure(model)
    names = list(model.members)
    left = np.ones((len(names), rows))
    for name, effect in model.effects.items():
        if effect.takes_section:
            chosen = structure.named(
                getattr(effect, "member", None), getattr(effect, "group", None)
            )
            left[chosen] *= np.minimum(parameters[name]["factor"], 1.0)
    return {names[k]: left[k] for k in np.flatnonzero((left < 1.0).any(axis=1))}
