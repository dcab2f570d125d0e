"""Modes and gauges that could be measured, side by side: they share explanations, and no error."""

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.linalg import block_diag

from rga.arrays import FloatArray
from rga.experiments.candidates import Added, LoadTest
from rga.experiments.explanation import CandidateModel
from rga.experiments.measurement_model import Errors, MeasurementModel, by_unknowns
from rga.model.effect import Effect
from rga.planning.modal.site import SILENT, ModalSite


class SiteWithModes:
    """A site (`rga.experiments.site.Site`) of gauges, and one of modes.

    Args:
        gauges: what gauges could measure.
        modes: what could be measured of modes.
    """

    def __init__(self, gauges: MeasurementModel, modes: ModalSite) -> None:
        self._gauges, self._modes = gauges, modes
        self.standing = gauges.standing + modes.standing
        self.operating = gauges.operating + modes.operating
        self.added: Sequence[Added] = [*gauges.added, *modes.added]
        self.tests: Sequence[LoadTest] = [*gauges.tests, *modes.tests]
        self._columns = np.argsort(self._kinds(gauges.standing, len(gauges.added), modes.standing,
                                               len(modes.added)), kind="stable")  # fmt: skip
        self._rows = np.argsort(self._kinds(gauges.operating, len(gauges.tests), modes.operating,
                                            len(modes.tests)), kind="stable")  # fmt: skip
        names = [*gauges.sensors, *modes.sensors]
        self.sensors = [names[column] for column in self._columns]

    @staticmethod
    def _kinds(first: int, more: int, of_modes: int, more_of_modes: int) -> list[int]:
        """0 for what is there, 1 for what is added, of gauges and then of modes."""
        return [0] * first + [1] * more + [0] * of_modes + [1] * more_of_modes

    def _own(self, column: int) -> tuple[MeasurementModel | ModalSite, int]:
        """The site that has a column, and its number there."""
        number, count = int(self._columns[column]), len(self._gauges.sensors)
        return (self._gauges, number) if number < count else (self._modes, number - count)

    def unit(self, column: int) -> str:
        """Unit of a column."""
        site, number = self._own(column)
        return site.unit(number)

    def without_test(self, column: int, apart: FloatArray) -> tuple[FloatArray, str]:
        """What of the measurements without a test shows in one number that two differ."""
        site, number = self._own(column)
        first = 0 if site is self._gauges else self._gauges.operating
        weights, words = site.without_test(number, apart[first : first + site.operating])
        whole = np.zeros(len(self._rows))
        whole[first : first + site.operating] = weights[: site.operating]
        return whole, words

    def measurements(self, effects: Mapping[str, Effect]) -> FloatArray:
        """What would be measured with more effects, float[measurements, sensors].

        Raises:
            InputError: the effects cannot be simulated.
        """
        both = (one.measurements(effects) for one in (self._gauges, self._modes))
        return self._ordered(block_diag(*both))

    def derivatives(self, one: CandidateModel, about: FloatArray | Sequence[float]) -> FloatArray:
        """By the unknowns in standard deviations, float[unknowns, measurements, sensors]."""
        return by_unknowns(self.measurements, one, about, (len(self._rows), len(self._columns)))

    def errors(self, effects: Mapping[str, Effect]) -> Errors:
        """The errors about the structure with effects."""
        gauges, modes = (one.errors(effects) for one in (self._gauges, self._modes))
        silent = block_diag(np.ones_like(gauges.noise), np.ones_like(modes.noise)) == 0.0
        noise = np.where(silent, SILENT, block_diag(gauges.noise, modes.noise))
        shared = np.array([
            *(block_diag(one, np.zeros_like(modes.noise)) for one in gauges.shared),
            *(block_diag(np.zeros_like(gauges.noise), one) for one in modes.shared),
        ]).reshape(-1, *noise.shape)  # fmt: skip
        return Errors(
            self._ordered(noise),
            self._ordered(block_diag(gauges.gain, modes.gain)),
            shared[:, self._rows][:, :, self._columns],
        )

    def _ordered(self, table: FloatArray) -> FloatArray:
        """Of gauges and then of modes, in the order of rows and columns here."""
        return np.asarray(table[self._rows][:, self._columns])
