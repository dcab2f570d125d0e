"""The one measurement that would separate a cause from its rival: a sensor, or a load test."""

from contextlib import suppress

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.data.observations import Data
from rga.diagnosis.search.linearised import Problem
from rga.errors import InputError
from rga.experiments.candidates import added_sensors, settings, stands
from rga.experiments.defaults import usual_truck
from rga.experiments.explanation import CandidateModel
from rga.experiments.measurement_model import MeasurementModel
from rga.experiments.separation import (
    Pair,
    nothing,
    paired,
    success,
    whitened,
    whitened_apart,
    with_one_more,
)
from rga.experiments.truck import lane_of
from rga.model.schema import Model

#: rows of the record that stand for operation, and places at which a truck may stand
ROWS, STANDS = 12, 9

#: what is said where rivals predict the same of all that could be measured
NOTHING = "nothing that is measured from now on: both predict the same of it"


class Advice:
    """Looks for the measurement that separates a cause from its rival.

    Everything that could be measured is simulated once, about the causes together.

    Args:
        model: as it was diagnosed.
        problem: gives the channels that work, the contexts of operation, the scatter, and the
            criteria.
        together: the causes.
    """

    def __init__(self, model: Model, problem: Problem, together: CandidateModel) -> None:
        self._together, self._criteria = together, problem.criteria
        self._site: MeasurementModel | None = None
        with suppress(InputError):  # a structure that cannot bear the tests: no advice
            self._prepare(model, problem.data, problem.levels)

    def _prepare(self, model: Model, data: Data, levels: FloatArray) -> None:
        rows = np.unique(np.linspace(0, len(data.time) - 1, ROWS).astype(int))
        operation = {name: column[rows] for name, column in data.belief.table.items()}
        lane = lane_of(model)
        truck = usual_truck(model, lane) if lane else None
        needed = set(data.belief.centre) | set(data.belief.lines)
        tests = settings(model, needed)
        if lane and truck:
            tests += stands(lane, truck, STANDS)
        added = [one for one in added_sensors(model) if not one.context or one.context in needed]
        site = MeasurementModel(model, data.sensors, added, tests, operation, lane, truck, levels)
        self._errors = site.errors(self._together.effects)
        self._site = site

    def against(self, rival: CandidateModel) -> str:
        """What to measure against an explanation, in words; empty where it cannot be simulated."""
        site = self._site
        if site is None:
            return ""
        try:
            pair = paired(site, self._together, rival)
        except InputError:
            return ""
        options = [
            *((one.advice, one.cost) for one in site.added),
            *((one.advice, one.cost) for one in site.tests),
        ]
        by_tests = self._by_tests(site, pair)
        separation = np.concatenate([self._by_sensors(site, pair), by_tests]).tolist()
        best = max(range(len(options)), key=lambda k: separation[k])
        least = self._criteria.advice
        if self._success(separation[best]) >= least.success:
            enough = [k for k, one in enumerate(separation) if self._success(one) >= least.success]
            best = min(enough, key=lambda k: (options[k][1], -separation[k]))
            return f"{options[best][0]} tells them apart ({self._figures(separation[best])})"
        if separation[best] < least.alike:
            return NOTHING
        return (
            "no single added sensor or load test; the best is "
            f"{options[best][0]} ({self._figures(separation[best])})"
        )

    def _by_sensors(self, site: MeasurementModel, pair: Pair) -> FloatArray:
        """d_perp with each added sensor alone, in operation."""
        columns = range(site.standing, len(site.sensors))
        more = whitened(self._errors, [pair], range(site.operating), columns)
        return np.sqrt(with_one_more(nothing(self._errors, pair), more, 0))

    def _by_tests(self, site: MeasurementModel, pair: Pair) -> FloatArray:
        """d_perp with each load test alone, read by the sensors that work."""
        rows = range(site.operating, site.operating + len(site.tests))
        if not rows or not site.standing:
            return np.zeros(len(site.tests))
        more = whitened_apart(self._errors, pair, rows, range(site.standing))
        return np.sqrt(with_one_more(nothing(self._errors, pair), more, 0))

    def _success(self, separation: float) -> float:
        return success(separation, self._criteria.rivals.log_odds)

    def _figures(self, separation: float) -> str:
        chance = 100 * self._success(separation)
        return f"d_perp {separation:.2g}, with a chance of {chance:.0f} %"
