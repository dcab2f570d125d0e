"""What infers contexts in a run: the protocol that every way to do so follows."""

from collections.abc import Callable, Sequence
from typing import Protocol

from rga.arrays import FloatArray
from rga.inference import Joint
from rga.model import ContextVariable
from rga.twin.calibration.correction import Correction
from rga.twin.calibration.lesson import Lesson


class ContextEstimator(Protocol):
    """Infers the contexts that nothing measures; it has learned from a calibration's rows.

    Attributes:
        kind: its name in a repository.
        remembers: whether it looks at rows before those that it infers.
    """

    kind: str
    remembers: bool

    @property
    def found(self) -> Joint | None:
        """The joint posterior that it goes by; None where it goes by none."""

    @property
    def correction(self) -> Correction | None:
        """What it has found of structure and sensors; None where it takes the model as it is."""

    def refined(self, lesson: Lesson) -> "ContextEstimator":
        """What it becomes by the rows of a lesson that are new."""

    def infer(
        self,
        first: int,
        readings: FloatArray,
        contexts: FloatArray,
        time: FloatArray,
        laws: Sequence[ContextVariable],
    ) -> tuple[FloatArray, FloatArray]:
        """Latent contexts from a row on, and their standard deviations.

        The rows begin with a block (`blocks`), or with the first of the run where the estimator
        remembers or a context does not move independently from row to row.

        Args:
            first: number of the first row to infer, among these.
            readings: of the rows, float[rows, channels], NaN where missing.
            contexts: all contexts of these rows; latent ones are not looked at.
            time: of these rows [s].
            laws: how each latent context moves.

        Returns:
            float[rows - first, latent] each; the same bits for packets of any size.
        """

    def to_bytes(self) -> bytes:
        """Its state, but for the simulation; reading it runs no code."""


#: learns from a lesson
Learn = Callable[[Lesson], ContextEstimator]
