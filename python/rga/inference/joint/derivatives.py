"""Readings as sensors show them, and how they follow contexts and all parameters."""

from typing import NamedTuple

import numpy as np

from rga.arrays import FloatArray
from rga.inference.joint.structural_parameters import Unknowns


class Derivatives(NamedTuple):
    """Readings of rows, and their derivatives.

    Attributes:
        readings: without noise, float[rows, sensors].
        by_contexts: float[rows, sensors, contexts].
        by_parameters: by unknowns, gains and offsets, float[rows, sensors, unknowns + 2 sensors].
    """

    readings: FloatArray
    by_contexts: FloatArray
    by_parameters: FloatArray


def derivatives(
    unknowns: Unknowns,
    contexts: FloatArray,
    parameters: tuple[FloatArray, FloatArray, FloatArray],
) -> Derivatives:
    """Readings gains * y + offsets of rows, y being the structure's.

    Args:
        unknowns: of the structure.
        contexts: of the rows, float[rows, contexts].
        parameters: unknowns, gains and offsets.
    """
    values, gains, offsets = parameters
    plain, by_contexts, by_unknowns = unknowns.linearise(contexts, values)
    each = np.eye(len(gains))
    by_parameters = np.concatenate(
        [
            by_unknowns * gains[:, None],
            plain[:, :, None] * each,
            np.ones_like(plain)[:, :, None] * each,
        ],
        axis=2,
    )
    return Derivatives(gains * plain + offsets, by_contexts * gains[:, None], by_parameters)
