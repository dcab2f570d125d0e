"""Contexts of all rows and unknowns of the structure, inferred together.

Unknowns are the same in all rows, contexts are not: rows without any label show both, as far as
sensors outnumber contexts. Rows whose contexts are known, load tests, join in with them.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

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
from rga.inference.joint.gauss_newton import JointPrior, Search
from rga.inference.joint.measured_contexts import MeasuredContexts
from rga.inference.joint.sensor_errors import CorrectedTwin
from rga.inference.joint.structural_parameters import Unknowns
from rga.inference.map.initial_guess import QuadraticGuess
from rga.inference.map.posterior_mode import Mode, posterior_mode
from rga.inference.rows import Rows
from rga.simulation import Simulator

#: rounds in which rows are given another chance to leave a wrong mode, steps of each; steps from an
#: earlier result
ROUNDS, STEPS, AGAIN = 3, 8, 3
#: rounds and steps from a prior
LATER = 2, 6


@dataclass(frozen=True)
class Joint:
    """What was found.

    Attributes:
        unknowns: of the structure.
        values: of them, float[unknowns].
        gains: of the sensors, float[sensors].
        offsets: of the sensors, in their units, float[sensors].
        sure: covariance of unknowns, gains and offsets in units of their priors,
            float[parameters, parameters].
        variance: of what readings still differ by from the twin, float[sensors].
        uncertainty: covariance of readings because unknowns are not sure, float[sensors, sensors].
        rows: measured rows with the contexts found; load tests are not among them.
        source: contexts to start from, float[m, contexts].
    """

    unknowns: Unknowns
    values: FloatArray
    gains: FloatArray
    offsets: FloatArray
    sure: FloatArray
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
        twin = known.beside(self.twin)
        ranges = known.within(twin.twin.ranges)
        simulated = Rows(self.source, twin.simulate(self.source))
        noise = known.behind_noise(np.sqrt(np.diagonal(self.covariance)))
        covariance = np.diag(noise**2)
        covariance[: len(self.gains), : len(self.gains)] = self.covariance
        guess, read = QuadraticGuess(simulated, noise, ranges, seed=0), known.behind(table)
        return posterior_mode(twin.simulate, twin.jacobian, read, covariance, ranges, guess(read))

    @property
    def parameters(self) -> FloatArray:
        """Unknowns, gains and offsets, float[unknowns + 2 sensors]."""
        return np.concatenate([self.values, self.gains, self.offsets])

    @property
    def twin(self) -> CorrectedTwin:
        """The model with its unknowns as they were found."""
        simulator = Simulator(self.unknowns.at(self.values))
        return CorrectedTwin(simulator, self.gains, self.offsets, time=self.unknowns.time)

    @property
    def covariance(self) -> FloatArray:
        """Of what readings differ by from the twin, float[sensors, sensors]."""
        return np.asarray(np.diag(self.variance) + self.uncertainty)


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
        prior: an earlier result, taken as prior: the rows that it came from need not be
            among the measured ones. Since then unknowns may have moved, and sensors may lie.
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
        known = JointPrior.later(prior.parameters, prior.sure, len(prior.values))
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
        if not isinstance(earlier, Joint) or earlier.unknowns.names != unknowns.names:
            raise InputError(
                "the earlier result is not of this model", PLACE, "give what was found for it"
            )


def _told(search: Search, source: FloatArray) -> Joint:
    """What was found, with how sure it is."""
    search.solve()
    values, gains, offsets = search.split(search.value)
    sure = search.covariance + search.covariance @ search.pull @ search.covariance
    moved = search.slopes @ np.linalg.cholesky(sure)
    moved = moved.transpose(1, 0, 2).reshape(len(gains), -1)
    return Joint(
        unknowns=search.unknowns,
        values=values,
        gains=gains,
        offsets=offsets,
        sure=sure,
        variance=search.variance,
        uncertainty=moved @ moved.T / max(len(search.slopes), 1),
        rows=Rows(search.contexts[: search.many], search.readings[: search.many]),
        source=source,
    )
