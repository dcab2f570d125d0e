"""Contexts of all rows and unknowns of the structure, inferred together.

Unknowns are the same in all rows, contexts are not: rows without any label show both, as far as
sensors outnumber contexts. Rows whose contexts are known, load tests, join in with them.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference.joint.checked_input import (
    PLACE,
    check_plausible,
    instruments,
    joint_noise,
    joint_rows,
    table_of,
)
from rga.inference.joint.gauss_newton import Search
from rga.inference.joint.joint_prior import JointPrior, parameter_units
from rga.inference.joint.measured_contexts import MeasuredContexts
from rga.inference.joint.row_spread import row_spread
from rga.inference.joint.sensor_errors import CorrectedTwin
from rga.inference.joint.structural_parameters import Unknowns
from rga.inference.map.array_simulator import TwinOnArrays
from rga.inference.map.initial_guess import QuadraticGuess
from rga.inference.map.posterior_mode import REACH, Mode, mode_beyond, posterior_mode
from rga.inference.rows import Rows
from rga.simulation import Simulator

#: rounds in which rows are given another chance to leave a wrong mode, steps of each; steps from an
#: earlier result
ROUNDS, STEPS, AGAIN = 3, 8, 3
#: rounds and steps from a prior
LATER = 3, 12


@dataclass(frozen=True)
class Joint:
    """What was found.

    Attributes:
        unknowns: of the structure.
        values: of them, float[unknowns].
        gains: of the sensors, float[sensors].
        offsets: of the sensors, in their units, float[sensors].
        independent: covariance of unknowns, gains and offsets in units of their priors, were all
            rows independent, float[parameters, parameters].
        pulled: what the model's error at each sensor pulls them by, in the same units; behind the
            sensors, at those that were there earlier, float[sensors or more, parameters].
        noise: standard deviation of the noise of each sensor, as it was given, float[sensors].
        variance: of what readings still differ by from the twin, float[sensors].
        uncertainty: covariance of readings because unknowns are not sure, float[sensors, sensors].
        rows: measured rows with the contexts found; load tests are not among them.
        source: contexts to start from, float[m, contexts].
    """

    unknowns: Unknowns
    values: FloatArray
    gains: FloatArray
    offsets: FloatArray
    independent: FloatArray
    pulled: FloatArray
    noise: FloatArray
    variance: FloatArray
    uncertainty: FloatArray
    rows: Rows
    source: FloatArray

    def infer(self, readings: FloatArray, measured: MeasuredContexts | None = None) -> Mode:
        """Contexts of rows, of others than these as well, with their standard deviations.

        Args:
            readings: float[n, sensors], NaN where missing.
            measured: contexts that instruments read at these rows.

        Raises:
            InputError: a table of another shape, or no numbers.
        """
        table = table_of("readings", readings, len(self.gains))
        known = instruments(measured, len(table), self.unknowns.model)
        modes = RowModes(self.twin, self.variance, self.source, known, self.uncertainty)
        found = modes(table, known)
        variance = np.tile(self.variance, (len(table), 1))
        unsure = self.spread(found.value, np.isfinite(table), known, variance)
        return replace(found, spread=np.maximum(found.spread, unsure))

    def spread(
        self,
        contexts: FloatArray,
        observed: NDArray[np.bool_],
        measured: MeasuredContexts,
        variance: FloatArray,
    ) -> FloatArray:
        """Standard deviations of contexts, what is unsure of the structure as large as there.

        Args:
            contexts: float[n, contexts].
            observed: readings that they were found by, bool[n, sensors].
            measured: contexts that instruments read at these rows.
            variance: of what readings differ by from the twin, float[n, sensors].

        Returns:
            float[n, contexts].
        """
        if not len(contexts):
            return np.zeros(contexts.shape)
        root = self.units[:, None] * np.linalg.cholesky(self.sure)
        parameters = (self.values, self.gains, self.offsets)
        return row_spread(self.unknowns, parameters, root, variance, contexts, observed, measured)

    @property
    def sure(self) -> FloatArray:
        """Covariance of parameters in units of their priors, float[parameters, parameters]."""
        return np.asarray(self.independent + self.pulled.T @ self.pulled)

    @property
    def units(self) -> FloatArray:
        """What `sure` counts unknowns, gains and offsets in, float[unknowns + 2 sensors]."""
        return parameter_units(self.unknowns, self.noise)

    def about(self, unknowns: Unknowns) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Parameters, `independent` and `pulled`, as of a model with other effects or sensors.

        What was not looked for is as its prior says.

        Returns:
            float[parameters] and, in units of the priors, float[parameters, parameters] and
            float[sensors or more, parameters].
        """
        place = {label: number for number, label in enumerate(self.labels)}
        labels, sensors = _labels(unknowns), list(unknowns.model.sensors)
        shared = np.array([number for number, label in enumerate(labels) if label in place], int)
        taken = [place[labels[number]] for number in shared]
        value = np.concatenate([unknowns.centre, np.ones(len(sensors)), np.zeros(len(sensors))])
        independent = np.eye(len(value))
        value[shared] = self.parameters[taken]
        independent[np.ix_(shared, shared)] = self.independent[np.ix_(taken, taken)]
        mine = list(self.unknowns.model.sensors)
        gone = list(range(len(mine), len(self.pulled)))
        gone += [number for number, name in enumerate(mine) if name not in sensors]
        pulled = np.zeros((len(sensors) + len(gone), len(value)))
        for row, name in enumerate(sensors):
            if name in mine:
                pulled[row, shared] = self.pulled[mine.index(name), taken]
        pulled[len(sensors) :, shared] = self.pulled[np.ix_(gone, taken)]
        return value, independent, pulled

    @property
    def labels(self) -> list[tuple[str, str]]:
        """What each parameter is of: unknowns, then gains, then offsets of sensors."""
        return _labels(self.unknowns)

    def is_about(self, unknowns: Unknowns) -> bool:
        """Whether it has all parameters of a model, and no others."""
        return self.labels == _labels(unknowns)

    def carried(self, unknowns: Unknowns) -> "Joint":
        """The same about a model of the same sensors with other effects, not found anew."""
        value, independent, pulled = self.about(unknowns)
        values, gains, offsets = np.split(
            value, [len(unknowns.centre), len(unknowns.centre) + len(self.gains)]
        )
        return replace(
            self,
            unknowns=unknowns,
            values=values,
            gains=gains,
            offsets=offsets,
            independent=independent,
            pulled=pulled,
        )

    @property
    def parameters(self) -> FloatArray:
        """Unknowns, gains and offsets, float[unknowns + 2 sensors]."""
        return np.concatenate([self.values, self.gains, self.offsets])

    @property
    def twin(self) -> CorrectedTwin:
        """The model with its unknowns as they were found."""
        return self.twin_at(self.unknowns.time)

    def twin_at(self, time: float | None) -> CorrectedTwin:
        """The same at a clock [s] that effects with an onset go by."""
        simulator = Simulator(self.unknowns.at(self.values))
        return CorrectedTwin(simulator, self.gains, self.offsets, time=time)

    @property
    def covariance(self) -> FloatArray:
        """Of what readings differ by from the twin, float[sensors, sensors]."""
        return np.asarray(np.diag(self.variance) + self.uncertainty)


class RowModes:
    """Contexts of single rows under a twin.

    Args:
        twin: it.
        variance: of what readings differ by from it, float[sensors].
        source: contexts to start from, float[m, contexts].
        measured: contexts that instruments read; which, and how well.
        uncertainty: covariance of readings because the twin is not sure, float[sensors, sensors];
            it widens intervals. None: the twin is sure.
    """

    def __init__(
        self,
        twin: TwinOnArrays,
        variance: FloatArray,
        source: FloatArray,
        measured: MeasuredContexts,
        uncertainty: FloatArray | None = None,
    ) -> None:
        sensors, self._bare = len(variance), twin
        self._twin, self._ranges = measured.beside(twin), measured.widest(twin.ranges)
        self._noise = measured.behind_noise(np.sqrt(variance))
        self._unsure = None
        if uncertainty is not None:
            self._unsure = np.diag(self._noise**2)
            self._unsure[:sensors, :sensors] += uncertainty
        simulated = Rows(source, self._twin.simulate(source))
        self._guess = QuadraticGuess(simulated, self._noise, self._ranges, seed=0)

    def simulate(self, contexts: FloatArray) -> FloatArray:
        """Readings of the sensors without noise, float[n, sensors], of float[n, contexts]."""
        return self._bare.simulate(contexts)

    def __call__(self, readings: FloatArray, measured: MeasuredContexts) -> Mode:
        """Contexts of rows, with their standard deviations.

        Args:
            readings: float[n, sensors], NaN where missing.
            measured: contexts that instruments read at these rows, the same ones.
        """
        read, twin, ranges = measured.behind(readings), self._twin, self._ranges
        own = np.diag(self._noise**2)
        found = mode_beyond(
            twin.simulate, twin.jacobian, read, own, self._noise, ranges, self._guess(read)
        )
        if self._unsure is None:
            return found
        # Other rows show more or less of what is not sure: it widens, and moves nothing.
        wide = posterior_mode(
            twin.simulate, twin.jacobian, read, self._unsure, ranges, found.value, 0, REACH
        )
        return replace(found, spread=wide.spread)


def infer_jointly(
    unknowns: Unknowns,
    readings: FloatArray,
    noise: FloatArray,
    source: FloatArray,
    *,
    load_tests: Rows | None = None,
    measured: MeasuredContexts | None = None,
    start: Joint | None = None,
    prior: Joint | None = None,
    progress: Callable[[float], None] | None = None,
) -> Joint:
    """The mode of the joint posterior of contexts and unknowns, by Gauss-Newton steps.

    The unknowns' normal equations are left by eliminating the contexts of each row (Schur's
    complement), so that the cost grows with the number of rows alone. Noise that turns out larger
    than stated is a model error that no unknown explains: it weakens all evidence.

    Args:
        unknowns: of the structure.
        readings: measured rows, float[n, sensors], NaN where missing.
        noise: standard deviation of each sensor's noise, float[sensors].
        source: contexts to start from, float[m, contexts].
        load_tests: measured rows whose contexts are known.
        measured: contexts that instruments read at the measured rows.
        start: an earlier result, about which unknowns are looked for again. Its rows are among the
            measured ones: a sensor that has changed since weighs less, and is not corrected.
        prior: an earlier result, taken as prior, of this model or of one with other effects or
            sensors: the rows that it came from need not be among the measured ones. Since then
            unknowns may have moved, and sensors may lie.
        progress: called with the share that is done.

    Raises:
        InputError: a table of another shape or no numbers, no row, a noise that is not positive,
            contexts that are not finite, a reading that is no measurement, an earlier result of
            another model, or both `start` and `prior`.
    """
    readings, source, load_tests = joint_rows(unknowns, readings, source, load_tests)
    noise = joint_noise(unknowns, noise)
    _check_earlier(unknowns, start, prior)
    for table in (readings, *([] if load_tests is None else [load_tests.readings])):
        check_plausible(unknowns, table, noise)
    known = JointPrior.fresh(unknowns, len(noise))
    if prior is not None:
        known = JointPrior.later(*prior.about(unknowns))
    read = instruments(measured, len(readings), unknowns.model)
    search = Search(unknowns, readings, noise, load_tests, known, read)
    rounds, steps = (ROUNDS, STEPS) if prior is None else LATER
    if start is not None:
        search.begin(start.parameters, start.variance)
        rounds, steps = 1, AGAIN
    for number in range(rounds):
        search.place(source, near=number > 0 or start is not None)
        for step in range(steps):
            if progress is not None:
                progress((number + step / steps) / rounds)
            if not search.step():
                break
    return _told(search, source)


def _check_earlier(unknowns: Unknowns, start: Joint | None, prior: Joint | None) -> None:
    if start is not None and prior is not None:
        problem = "an earlier result cannot be both the start and the prior"
        raise InputError(problem, PLACE, "give start or prior")
    for earlier in (start, prior):
        if earlier is None:
            continue
        if not isinstance(earlier, Joint) or not _fits(earlier, unknowns, whole=earlier is start):
            raise InputError(
                "the earlier result is not of this model", PLACE, "give what was found for it"
            )


def _fits(earlier: Joint, unknowns: Unknowns, whole: bool) -> bool:
    """Whether an earlier result has all parameters of a model, or some of its structure's."""
    if whole:
        return earlier.is_about(unknowns)
    shared = {part.name for part in earlier.unknowns.parts} & {part.name for part in unknowns.parts}
    return bool(shared) and list(earlier.unknowns.model.context) == list(unknowns.model.context)


def _labels(unknowns: Unknowns) -> list[tuple[str, str]]:
    """What each parameter is of: unknowns, then gains, then offsets of sensors."""
    sensors = unknowns.model.sensors
    return [
        *(("structure", part.name) for part in unknowns.parts),
        *(("gain", name) for name in sensors),
        *(("offset", name) for name in sensors),
    ]


def _told(search: Search, source: FloatArray) -> Joint:
    """What was found, with how sure it is."""
    search.solve(last=True)
    values, gains, offsets = search.split(search.value)
    sure = search.covariance + search.pulled.T @ search.pulled
    moved = search.slopes @ np.linalg.cholesky(sure)
    moved = moved.transpose(1, 0, 2).reshape(len(gains), -1)
    return Joint(
        unknowns=search.unknowns,
        values=values,
        gains=gains,
        offsets=offsets,
        independent=search.covariance,
        pulled=search.pulled,
        noise=search.noise,
        variance=search.variance,
        uncertainty=moved @ moved.T / max(len(search.slopes), 1),
        rows=Rows(search.contexts[: search.many], search.readings[: search.many]),
        source=source,
    )
