"""What is known of structure and sensors before the rows of a joint inference."""

from typing import NamedTuple

import numpy as np

from rga.arrays import FloatArray
from rga.inference.joint.structural_parameters import Unknowns

#: prior spread of the gain of a sensor [-], and of its offset [standard deviations of its noise]
GAIN, OFFSET = 0.01, 0.3


class JointPrior(NamedTuple):
    """What is known of the parameters before the rows, in units of their standard deviations.

    They are normal around something that may have changed.

    Attributes:
        mean: unknowns, then gains, then offsets, float[parameters], in their own units.
        covariance: were the rows that it comes from independent, float[parameters, parameters].
        pulled: what the model's error at each sensor has pulled them by, float[sensors or more,
            parameters].
        change: scale of what each differs by beside that, by Student's distribution,
            float[parameters].
        earlier: whether it is an earlier result, since which few of them may have changed.
    """

    mean: FloatArray
    covariance: FloatArray
    pulled: FloatArray
    change: FloatArray
    earlier: bool

    @classmethod
    def fresh(cls, unknowns: Unknowns, sensors: int) -> "JointPrior":
        """Unknowns as their priors say; sensors are sound, but for some."""
        own = np.repeat([1.0, 0.0], [len(unknowns.centre), 2 * sensors])
        mean = np.concatenate([unknowns.centre, np.ones(sensors), np.zeros(sensors)])
        none = np.zeros((sensors, len(mean)))
        return cls(mean, np.diag(own), none, 1.0 - own, earlier=False)

    @classmethod
    def later(cls, mean: FloatArray, covariance: FloatArray, pulled: FloatArray) -> "JointPrior":
        """What was found earlier."""
        return cls(mean, covariance, pulled, np.zeros(len(mean)), earlier=True)


def parameter_units(unknowns: Unknowns, noise: FloatArray) -> FloatArray:
    """Prior spreads of unknowns, gains and offsets, float[unknowns + 2 sensors]."""
    return np.concatenate([unknowns.spread, np.full(len(noise), GAIN), OFFSET * noise])
