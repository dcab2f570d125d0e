"""What a plan asks of a structure with all that could be measured on it."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from rga.arrays import FloatArray
from rga.experiments.candidates import Added, LoadTest
from rga.experiments.explanation import CandidateModel
from rga.experiments.measurement_model import Errors
from rga.model.effect import Effect


class Site(Protocol):
    """Sensors that stand, sensors that could be added, and tests.

    Attributes:
        sensors: names of the columns: those that work, those that could be added.
        standing: how many of them work already.
        operating: how many measurements are made without a test; those of the tests follow.
        added: what could be added, in the order of their columns.
        tests: in the order of their measurements.
    """

    sensors: list[str]
    standing: int
    operating: int
    added: Sequence[Added]
    tests: Sequence[LoadTest]

    def unit(self, column: int) -> str:
        """Unit of a column."""

    def without_test(self, column: int, apart: FloatArray) -> tuple[FloatArray, str]:
        """What of the measurements without a test shows in one number that two differ.

        Args:
            column: of the sensor.
            apart: difference of the two, float[operating].

        Returns:
            The weight of every measurement in it, float[measurements], and what it is, in words.
        """

    def measurements(self, effects: Mapping[str, Effect]) -> FloatArray:
        """What would be measured with more effects, float[measurements, sensors].

        Raises:
            InputError: the effects cannot be simulated.
        """

    def derivatives(self, one: CandidateModel, about: FloatArray | Sequence[float]) -> FloatArray:
        """By the unknowns in standard deviations, float[unknowns, measurements, sensors]."""

    def errors(self, effects: Mapping[str, Effect]) -> Errors:
        """The errors about the structure with effects."""
