"""Modes as they are computed of a structure, and as a model has them."""

from dataclasses import dataclass

from rga.arrays import FloatArray, IntArray


@dataclass(frozen=True)
class Computed:
    """Modes of a structure as they are computed.

    Attributes:
        log_f: [ln Hz], float[computed].
        moving: motion of all nodes along the axes, float[computed, nodes, 3].
        at_points: at the points, float[computed, points].
        shift: logarithm of the factor by which a clock reads frequencies larger.
    """

    log_f: FloatArray
    moving: FloatArray
    at_points: FloatArray
    shift: float


@dataclass(frozen=True)
class Prediction:
    """Modes as a model has them.

    Attributes:
        log_f: [ln Hz], float[windows, modes], or of the contexts that stand for all.
        shapes: motion of all nodes along the axes in the middle of what the contexts were,
            averaged over the windows, float[modes, nodes, 3].
        number: of the computed mode that each is, there, int[modes].
        at_points: motion that is read at the points, with what sensors there make of it, averaged
            as the shapes are, float[modes, points].
        every: motion of all computed modes of the structures at the points, float[k, points].
        recorded: the same as sensors there record it, float[k, points].
        mixing: how much of each may be in each measured one, float[modes, k].
        mac: of each with the measured shape, float[modes]; NaN without shape.
        doubtful: measured modes that are nearly as probably another computed one, with the number
            of the one and of the other.
        parts: of other modes that may be in each shape at its points, float[k, points] each.
    """

    log_f: FloatArray
    shapes: FloatArray
    number: IntArray
    at_points: FloatArray
    every: FloatArray
    recorded: FloatArray
    mixing: FloatArray
    mac: FloatArray
    doubtful: frozenset[tuple[int, int, int]]
    parts: tuple[FloatArray, ...]

    @property
    def size(self) -> int:
        """How many numbers it holds."""
        several = (self.log_f, self.shapes, self.at_points, self.every, self.recorded, self.mixing)
        return sum(one.size for one in (*several, *self.parts))
