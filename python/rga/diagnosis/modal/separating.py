"""What to measure to tell two explanations of the same modes apart."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.fit import ModalFit
from rga.diagnosis.modal.likelihood import ModalLikelihood

#: difference of a shape, over its largest motion, that an accelerometer is worth
WORTH = 0.1
#: kinds that move all modes much alike, and what tells each from those of the other lines
TESTS: tuple[tuple[frozenset[str], str], ...] = (
    (frozenset({"mass_factor", "added_mass"}), "a parked truck of known mass"),
    (frozenset({"elastic_modulus", "member_stiffness"}), "a static test under a known load"),
    (frozenset({"clock_rate"}), "a tone of known frequency in the same logger"),
)
COMMON = frozenset[str]().union(*(kinds for kinds, _ in TESTS))
AXES = ("x", "y", "z")


def separating(likelihood: ModalLikelihood, one: ModalFit, other: ModalFit) -> str:
    """In words: where shapes of two explanations differ most, a point to check, or another test."""
    points = [point for fit in (one, other) for point in fit.points]
    advice = [f"another accelerometer beside point {point}" for point in dict.fromkeys(points)]
    place = _place(likelihood, one, other)
    if place is not None:
        node, axis, mode, apart = place
        advice.append(
            f"an accelerometer at {node} along {axis}: in mode {mode} the two differ there by "
            f"{apart:.0%} of its largest motion"
        )
    advice += common_tests({fit.hypotheses[-1].name for fit in (one, other) if fit.hypotheses})
    return "; or ".join(advice) or "no point of the structure tells them apart by its shapes"


def common_tests(kinds: set[str]) -> list[str]:
    """What tells two kinds apart that move all modes much alike; nothing of other kinds.

    >>> common_tests({"mass_factor", "clock_rate"})
    ['a parked truck of known mass', 'a tone of known frequency in the same logger']
    >>> common_tests({"elastic_modulus"}), common_tests({"elastic_modulus", "support_spring"})
    ([], [])
    """
    lines = [(those & kinds, test) for those, test in TESTS]
    told = [test for own, test in lines if own]
    return told if kinds <= COMMON and len(told) > 1 else []


def _place(
    likelihood: ModalLikelihood, one: ModalFit, other: ModalFit
) -> tuple[str, str, str, float] | None:
    """Node, axis and mode with the largest difference, and it."""
    if one.prediction is None or other.prediction is None:
        return None
    nodes = list(likelihood.trials.model.nodes)
    best: tuple[float, str, str, str] = (WORTH, "", "", "")
    for mode, name in enumerate(likelihood.readings.modes):
        first, second = (_scaled(fit.prediction.shapes[mode]) for fit in (one, other))  # type: ignore[union-attr]
        second = second * np.sign(float((first * second).sum()) or 1.0)
        apart = np.abs(first - second)
        node, axis = np.unravel_index(int(apart.argmax()), apart.shape)
        if apart[node, axis] > best[0]:
            best = (float(apart[node, axis]), nodes[node], AXES[axis], name)
    return (*best[1:], best[0]) if best[1] else None


def _scaled(shape: FloatArray) -> FloatArray:
    return np.asarray(shape / max(float(np.abs(shape).max()), 1e-300))
