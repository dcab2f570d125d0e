"""Expected modes that are hardly known by what they look like."""

from collections.abc import Iterator, Mapping
from itertools import combinations

import numpy as np

from rga.simulation.modal.expected import FEWEST, SHAPE_ERROR, Expected, mac
from rga.simulation.modal.mixed_shapes import COUPLING


def unseen_modes(expected: Mapping[str, Expected]) -> list[str]:
    """Names of modes in which every point stands still."""
    return [name for name, one in expected.items() if one.unseen]


def twin_modes(expected: Mapping[str, Expected]) -> Iterator[tuple[str, str]]:
    """Pairs of names of modes that look the same, by frequency and by what both have of a shape.

    >>> at, up, turn = np.arange(2), np.array([1.0, 1.0]), np.array([1.0, -1.0])
    >>> modes = {name: Expected(2.0, 0.1, at, shape) for name, shape in (("m1", up), ("m2", turn))}
    >>> list(twin_modes(modes)), list(twin_modes({**modes, "m3": modes["m1"]}))
    ([], [('m1', 'm3')])
    """
    for (name, one), (other_name, other) in combinations(expected.items(), 2):
        if abs(np.log(one.near / other.near)) < COUPLING and _unlike(one, other) < SHAPE_ERROR:
            yield name, other_name


def unclear_looks(expected: Mapping[str, Expected]) -> tuple[str, ...]:
    """In words: modes that are hardly known by what they look like."""
    words = [
        f"no point sees mode {name}: all stand still in it, and it is known by its frequency alone"
        for name in unseen_modes(expected)
    ]
    words += [
        f"modes {name} and {other} cannot be told apart: they look the same by frequency and shape"
        for name, other in twin_modes(expected)
    ]
    return tuple(words)


def _unlike(one: Expected, other: Expected) -> float:
    """1 - MAC at the points of both; 0 where they say nothing."""
    _, own, others = np.intersect1d(one.at, other.at, return_indices=True)
    shapes = one.shape[own], other.shape[others]
    if len(own) < FEWEST or not all(shape.any() for shape in shapes):
        return 0.0
    return 1.0 - mac(*shapes)
