"""Which contexts the sensors can see at all."""

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.standard_units import standard
from rga.simulation import Simulator

#: a context of whose prior variance more than this share is left is not seen
BLIND = 0.9


def unseen_share(simulator: Simulator, contexts: FloatArray, noise: FloatArray) -> FloatArray:
    """Share of the prior variance of each context that readings of a row leave, 0 to 1.

    The posterior precision of a row is J' S^-1 J + P^-1 (Laplace): J the derivatives of the
    sensors, S the variance of their noise, P that of contexts spread evenly over their ranges. It
    takes the model as true: no method can do better on single rows, and a wrong model does worse.

    Args:
        simulator: of a model of which all contexts are latent.
        contexts: rows to look at, float[n, contexts].
        noise: standard deviation of each sensor's noise, float[sensors].

    Returns:
        float[contexts], a mean over the rows.
    """
    twin = TwinOnArrays(simulator)
    _, scale = standard(twin.ranges)
    slopes = twin.jacobian(contexts) * scale / noise[:, None]
    precision = slopes.transpose(0, 2, 1) @ slopes + np.eye(len(scale))
    return np.asarray(np.diagonal(np.linalg.inv(precision), axis1=1, axis2=2).mean(axis=0))
