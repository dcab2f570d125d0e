"""Members and springs whose force is no multiple of their elongation: slack, play and stops."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rga._core import Condensation, OutputKind, UnstableSample
from rga.arrays import FloatArray, IntArray, by_name
from rga.errors import InputError
from rga.model.structure import Law, Structure


@dataclass(frozen=True)
class LawTable:
    """Laws of terms in several states, in the order of `terms_of`.

    Attributes:
        size: up to which a term is idle, float[states, terms] [m]; infinite where it never bears.
        stiffness: of the springs among them, beyond, float[states, springs] [N/m].
    """

    size: FloatArray
    stiffness: FloatArray


def respond_with_laws(
    structure: Structure,
    linear: Condensation,
    coefficients: FloatArray,
    table: LawTable | None = None,
) -> FloatArray:
    """Sensors of rows, float[rows, sensors] in SI units.

    Args:
        structure: with its laws.
        linear: the structure condensed onto the terms that have them, in the order of
            `terms_of`.
        coefficients: of the load patterns, float[rows, patterns].
        table: the laws of every row; None: those of the structure.

    Raises:
        InputError: play or slack leaves a row nothing that holds it.
    """
    laws = sorted(structure.laws, key=_order)
    rod = np.array([law.kind == "tension" for law in laws])
    size = np.tile([law.size for law in laws], (len(coefficients), 1))
    stiffness = np.tile(linear.stiffness, (len(coefficients), 1))
    if table is not None:
        size, springs = table.size, table.stiffness.shape[1]
        stiffness[:, len(laws) - springs :] = table.stiffness
    try:
        pseudo = linear.pseudo_forces(coefficients, size, stiffness, rod)
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


def laws_alone(structures: Sequence[Structure]) -> tuple[Structure, LawTable] | None:
    """A structure that differs from others in its laws alone, with the laws of all.

    A stop may be stiffer in one than in another, or not be there; the structure is the one in which
    it is softest, so that it bears at least as much in the others.

    Returns:
        The structure, and the laws of all structures; None where more differs.
    """
    having = [one for one in structures if one.laws]
    if not having or any(one.bearings or one.nonlinear for one in structures):
        return None
    softest = min(having, key=lambda one: float(_of_springs(one).sum()))
    laws = sorted(softest.laws, key=_order)
    places = [replace(law, size=0.0) for law in laws]
    stops = np.array([law.spring for law in laws if law.spring is not None], dtype=np.int64)
    sizes, stiffnesses = [], []
    for one in structures:
        if not _same_but_stops(softest, one, stops):
            return None
        others = sorted(one.laws, key=_order)
        if not others and any(law.kind == "tension" for law in laws):
            return None
        if others:
            if [replace(law, size=0.0) for law in others] != places:
                return None
            if (_of_springs(one) < _of_springs(softest)).any():
                return None
            sizes.append([law.size for law in others])
            stiffnesses.append(_of_springs(one))
        else:
            # A member without play bears at once, a stop that is not there never.
            sizes.append([0.0 if law.spring is None else np.inf for law in laws])
            stiffnesses.append(_of_springs(softest))
    return softest, LawTable(np.array(sizes), np.array(stiffnesses))


def _of_springs(structure: Structure) -> FloatArray:
    """Stiffness of the springs that have a law, in the order of `terms_of`."""
    laws = sorted(structure.laws, key=_order)
    return structure.arrays["spring_stiffness"][
        [law.spring for law in laws if law.spring is not None]
    ]


def _same_but_stops(one: Structure, other: Structure, stops: IntArray) -> bool:
    """Whether two structures are the same, the stiffness of stops left aside, or the stops."""
    pairs = [(one.alpha, other.alpha), (one.host, other.host)]
    known = dict(by_name(other.arrays).items())
    for name, array in by_name(one.arrays).items():
        theirs = known[name]
        # Stops go by their numbers in the first.
        if other.laws and len(theirs) != len(array):
            return False
        # What is no stop's stiffness, or where there is no stop no stop's at all.
        if name == "spring_stiffness" or (name.startswith("spring_") and not other.laws):
            array = np.delete(array, stops, axis=0)
            theirs = np.delete(theirs, stops, axis=0) if other.laws else theirs
        pairs.append((array, theirs))
    outputs = dict(by_name(other.outputs).items())
    pairs += [(array, outputs[name]) for name, array in by_name(one.outputs).items()]
    return all(
        ours is theirs or np.array_equal(ours, theirs, equal_nan=ours.dtype.kind == "f")
        for ours, theirs in pairs
    )


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
