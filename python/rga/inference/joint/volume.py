"""How the room that readings leave to contexts changes with the structure."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.inference.joint.structural_parameters import Unknowns

#: rows by which it is seen how derivatives change
SAMPLE = 32
#: share of a prior deviation by which contexts are moved for that
MOVED = 0.1


@dataclass(frozen=True)
class Curvature:
    """How derivatives by contexts change with unknowns and with contexts.

    Attributes:
        rows: some of the rows, int[sample].
        here: derivatives of readings by contexts there, float[sample, sensors, contexts].
        by_unknowns: their change per prior spread of an unknown, float[unknowns, sample, sensors,
            contexts].
        by_contexts: their change per prior deviation of a context, float[contexts, sample, sensors,
            contexts].
    """

    rows: IntArray
    here: FloatArray
    by_unknowns: FloatArray
    by_contexts: FloatArray

    @classmethod
    def of(cls, unknowns: Unknowns, contexts: FloatArray, scale: FloatArray) -> Self:
        """That of a sample of rows, about the centre of the unknowns.

        Args:
            unknowns: of the structure.
            contexts: of the rows, float[rows, contexts].
            scale: prior deviations of the contexts, float[contexts].
        """
        rows = np.unique(np.linspace(0, len(contexts) - 1, SAMPLE).astype(int))
        count = len(scale)
        moves = np.vstack([np.zeros(count), np.diag(MOVED * scale)])
        around = (contexts[rows] + moves[:, None]).reshape(-1, count)
        _, by_contexts, by_unknowns = (
            part.reshape(1 + count, len(rows), *part.shape[1:])
            for part in unknowns.linearise(around, unknowns.centre)
        )
        mixed = (by_unknowns[1:] - by_unknowns[0]) / (MOVED * scale)[:, None, None, None]
        return cls(
            rows,
            by_contexts[0],
            mixed.transpose(3, 1, 2, 0) * unknowns.spread[:, None, None, None],
            (by_contexts[1:] - by_contexts[0]) / MOVED,
        )

    def volume_slope(
        self, weight: FloatArray, width: FloatArray, follow: FloatArray, gain: float
    ) -> FloatArray:
        """Half the slope of the log determinant of the rows' precision along the parameters.

        The mode over contexts and unknowns is off: contexts that vary less please their prior, so
        that a structure that is too soft would be found (Neyman and Scott, Econometrica 16, 1948).
        The likelihood of the unknowns alone has the determinant beside it (Laplace), at the
        contexts that each value of them would give.

        Args:
            weight: one over the deviation of each reading, times the deviation of each context;
                0 where nothing was read, float[sample, sensors, contexts].
            width: prior deviations of the contexts in their units, float[sample, contexts].
            follow: what contexts lose by a parameter, in their units, float[sample, contexts,
                parameters].
            gain: prior spread of a sensor's gain.

        Returns:
            float[parameters], the mean of the rows.
        """
        here = self.here * weight
        turned = here.transpose(0, 2, 1)
        back = here @ np.linalg.inv(turned @ here + np.eye(width.shape[1]) / width[:, :, None] ** 2)
        heavy = back * weight
        of_unknowns = np.einsum("nsc,knsc->k", heavy, self.by_unknowns, optimize=True)
        of_gains = gain * np.einsum("nsc,nsc->s", back, here)
        slope = np.concatenate([of_unknowns, of_gains, np.zeros(here.shape[1])])
        of_contexts = np.einsum("nsc,jnsc->nj", heavy, self.by_contexts, optimize=True)
        slope -= np.einsum("nj,njk->k", of_contexts, follow, optimize=True)
        return np.asarray(slope / len(here))
