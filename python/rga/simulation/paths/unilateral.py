"""Members and springs whose force is no multiple of their elongation: slack, play and stops."""

import numpy as np
from numpy.typing import NDArray

from rga._core import Condensation, OutputKind, UnstableSample
from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.structure import Law, Structure


def respond_with_laws(
    structure: Structure, linear: Condensation, coefficients: FloatArray
) -> FloatArray:
    """Sensors of rows, float[rows, sensors] in SI units.

    Args:
        structure: with its laws.
        linear: the structure condensed onto the terms that have them, in the order of
            `terms_of`.
        coefficients: of the load patterns, float[rows, patterns].

    Raises:
        InputError: play or slack leaves a row nothing that holds it.
    """
    laws = sorted(structure.laws, key=_order)
    size = np.array([law.size for law in laws])
    rod = np.array([law.kind == "tension" for law in laws])
    try:
        pseudo = linear.pseudo_forces(coefficients, size, rod)
    except UnstableSample as error:
        raise InputError(
            "play or slack leaves nothing that holds the structure",
            f"row {error.row + 1}",
            "reduce the slack, or name fewer members",
        ) from None
    influence, arrays, outputs = linear.influence, structure.arrays, structure.outputs
    # A gauge on a slack member reads its force, not the way that its ends have moved.
    gauges = np.where(
        outputs["total"] | (outputs["kind"] != OutputKind.STRAIN), -1, outputs["index"]
    )
    for term, law in enumerate(laws):
        if law.member is not None:
            axial = arrays["E"][law.member] * arrays["A"][law.member]
            influence[term, gauges == law.member] -= 1.0 / axial
    return np.asarray(coefficients @ linear.loaded - pseudo @ influence)


def terms_of(structure: Structure) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Members and springs with a law.

    Raises:
        InputError: one has two.
    """
    laws = sorted(structure.laws, key=_order)
    places = [(law.member, law.spring) for law in laws]
    if len(set(places)) < len(places):
        raise InputError(
            "a member has two of joint_slip and tension_only", "effects", "leave it one of them"
        )
    members = [law.member for law in laws if law.member is not None]
    springs = [law.spring for law in laws if law.spring is not None]
    return np.array(members, dtype=np.int64), np.array(springs, dtype=np.int64)


def _order(law: Law) -> tuple[bool, int]:
    """Members first, as a condensation has its terms."""
    return law.member is None, (law.spring if law.member is None else law.member) or 0
