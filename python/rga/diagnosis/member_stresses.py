"""What the causes mean for the stresses of members."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.findings.arrays import DiagnosisArrays
from rga.model.schema import Model
from rga.simulation.stresses import section_stresses
from rga.simulation.structural_results import forces_along, forces_of_members

#: places along a member that are solved for: its ends, and the thirds that bowed members need
STATIONS = 4


@dataclass(frozen=True)
class MemberStress:
    """The worst of one member in one row.

    Attributes:
        moment: largest bending moment about either axis, without sign [N m].
        stress: that of the worst fibre, tension positive [Pa].
        utilisation: its size over the yield strength; None where none is stated.
        left: share of the section that is left, 1 for a whole one.
    """

    moment: float
    stress: float
    utilisation: float | None
    left: float


def member_stresses(
    account: DiagnosisArrays, members: Sequence[str], row: int
) -> dict[str, tuple[MemberStress, MemberStress]] | None:
    """Stresses as given and with the causes, by member, in one row of the record.

    Args:
        account: of a diagnosis.
        members: names.
        row: number of the row.

    Returns:
        None where the structure cannot be solved with or without the causes.
    """
    try:
        given, extended = (
            _worst(model, account.contexts, members, row)
            for model in (account.model, account.extended)
        )
    except InputError:
        return None
    return {name: (given[name], extended[name]) for name in members}


def _worst(
    model: Model, contexts: Mapping[str, FloatArray], members: Sequence[str], row: int
) -> dict[str, MemberStress]:
    # Some effects remember the rows before, and a train heads where all rows say.
    forces, parameters = forces_of_members(model, contexts, members, stations=STATIONS)
    along = forces_along(model, contexts, members, forces, parameters)
    stresses, here = section_stresses(forces, along), slice(row, row + 1)
    moments = np.abs(along.limits(here)[0, :, 4:]).max(axis=(1, 2))
    found = {}
    for number, (name, fibres) in enumerate(stresses.limits(here).items()):
        values = np.concatenate([one[0] for one in fibres.values()])
        stress = float(values[np.argmax(np.abs(values))])
        limit = model.materials[model.members[name].material].yield_strength
        left = stresses.reduced.get(name)
        found[name] = MemberStress(
            moment=float(moments[number]),
            stress=stress,
            utilisation=None if limit is None else abs(stress) / limit,
            left=1.0 if left is None else float(left[row]),
        )
    return found
