"""What a mode is expected to look like, and how alike two shapes are."""

from dataclasses import dataclass

from rga.arrays import FloatArray, IntArray

#: points that say anything of a shape: at a single one all are alike
FEWEST = 2
#: what 1 - MAC of a mode and itself is, on average, where the model errs and sensors are noisy
SHAPE_ERROR = 0.05


@dataclass(frozen=True)
class Expected:
    """What a mode looks like.

    Attributes:
        near: frequency about which it is expected [Hz].
        within: share of that by which it may well differ.
        at: numbers of the points of its shape, int[points].
        shape: its motion there, float[points]; empty, or zero all over: known by its frequency
            alone.
    """

    near: float
    within: float
    at: IntArray
    shape: FloatArray

    @property
    def unseen(self) -> bool:
        """Whether all points of its shape stand still in it, and so see nothing of it."""
        return len(self.shape) > 0 and not self.shape.any()


def mac(one: FloatArray, other: FloatArray) -> float:
    """Modal assurance criterion of two shapes: 1 where they are alike but for their scale.

    Source: Allemang, The modal assurance criterion - twenty years of use and abuse, Sound and
    Vibration 37, 2003.

    >>> import numpy as np
    >>> mac(np.array([1.0, 2.0]), np.array([-2.0, -4.0])), mac(np.eye(2)[0], np.eye(2)[1])
    (1.0, 0.0)
    """
    lengths = float((one @ one) * (other @ other))
    return float((one @ other) ** 2 / lengths) if lengths > 0 else 0.0
