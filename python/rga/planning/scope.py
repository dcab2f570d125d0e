"""What is planned on: the explanations, and all that could be measured to tell them apart."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.standing import weather
from rga.diagnosis.noise import random_effects
from rga.errors import InputError
from rga.experiments.candidates import added_sensors, settings, stands
from rga.experiments.defaults import usual_operation
from rga.experiments.explanation import CandidateModel
from rga.experiments.measurement_model import Errors, MeasurementModel
from rga.experiments.separation import Pair, paired, success
from rga.experiments.site import Site
from rga.experiments.truck import Lane, Truck
from rga.findings import Findings
from rga.findings.criteria import Criteria
from rga.model import Model
from rga.planning.modal.candidates import (
    PARKED_MASS,
    accelerometers,
    more_windows,
    parked,
    seasons,
)
from rga.planning.modal.practical import mass_of
from rga.planning.modal.site import ModalSite
from rga.planning.modal.with_gauges import SiteWithModes
from rga.planning.rivals import working_sensors
from rga.planning.selection import Choice, Chooser
from rga.simulation import Simulator

#: as-built scatter that is reckoned with: a deviation above what a diagnosis expects [-]
LEVELS = np.array([level.median * np.exp(level.spread) for level in random_effects.LEVELS])


@dataclass(frozen=True)
class Scope:
    """What is planned on.

    Attributes:
        site: with all that could be measured.
        gauges: what of it is measured by gauges.
        modes: what of it is measured of modes; None where the findings have no windows of any.
        errors: about the causes.
        pairs: of causes and rivals.
        best: d_perp of each pair with everything measured, float[pairs].
        criteria: those of the findings.
    """

    site: Site
    gauges: MeasurementModel
    modes: ModalSite | None
    errors: Errors
    pairs: list[Pair]
    best: FloatArray
    criteria: Criteria

    def success(self, separation: float) -> float:
        """Chance that the true explanation of a pair wins by the log-odds asked for."""
        return success(separation, self.criteria.rivals.log_odds)

    def chooser(self, numbers: Sequence[int]) -> Chooser:
        """Chooses measurements for some of the pairs."""
        pairs = [self.pairs[one] for one in numbers]
        return Chooser(self.site, self.errors, pairs, self.criteria.advice.enough)

    def chosen(self, choice: Choice, lane: Lane | None, truck: Truck | None) -> Site:
        """The site with nothing but a choice."""
        site, gauges = self.site, self.gauges
        added = [one - site.standing for one in sorted(choice.sensors)]
        of_gauges = MeasurementModel(
            gauges.model,
            gauges.sensors[: gauges.standing],
            [gauges.added[one] for one in added if one < len(gauges.added)],
            [gauges.tests[one] for one in choice.tests if one < len(gauges.tests)],
            usual_operation(gauges.model),
            lane,
            truck,
            LEVELS,
        )
        if self.modes is None:
            return of_gauges
        of_modes = self.modes.only(
            [one - len(gauges.added) for one in added if one >= len(gauges.added)],
            [one - len(gauges.tests) for one in choice.tests if one >= len(gauges.tests)],
        )
        return SiteWithModes(of_gauges, of_modes)


def scope_of(
    model: Model,
    findings: Findings,
    rivalries: Sequence[tuple[CandidateModel, CandidateModel]],
    lane: Lane | None,
    truck: Truck | None,
    warnings: list[str],
) -> Scope:
    """Everything that could be measured; pairs that cannot be simulated become warnings."""
    needed = {
        context
        for both in rivalries
        for one in both
        for context in Simulator(model).extended(one.effects).needed
    }
    tests = settings(model, needed)
    if lane is not None and truck is not None:
        tests += stands(lane, truck)
    working = working_sensors(model, findings)
    added = [one for one in added_sensors(model) if not one.context or one.context in needed]
    gauges = MeasurementModel(
        model, working, added, tests, usual_operation(model), lane, truck, LEVELS
    )
    named = rivalries[0][0].effects
    every_one = [one for both in rivalries for one in both]
    modes = _modes(model, findings, every_one, lane, truck, warnings)
    site: Site = gauges if modes is None else SiteWithModes(gauges, modes)
    pairs, failed = [], []
    for cause, rival in rivalries:
        try:
            pairs.append(paired(site, cause, rival))
        except InputError as error:
            failed.append(error)
            warnings.append(f"{rival.words} was left aside: {error}")
    if not pairs:
        raise failed[0]
    errors = site.errors(named)
    every = range(site.standing, len(site.sensors))
    criteria = findings.criteria
    everything = Chooser(site, errors, pairs, criteria.advice.enough)
    best = everything.separation(every, range(len(site.tests)))
    return Scope(site, gauges, modes, errors, pairs, best, criteria)


def _modes(
    model: Model,
    findings: Findings,
    explanations: Sequence[CandidateModel],
    lane: Lane | None,
    truck: Truck | None,
    warnings: list[str],
) -> ModalSite | None:
    """What could be measured of modes, but for places of a truck that make their names doubtful.

    They do where they do by any of the explanations that can be simulated. That no place is left
    becomes a warning.
    """
    windows = findings.windows
    if windows is None:
        return None
    tests = [more_windows(windows), *seasons(model, windows, weather(model, model.context))]
    if lane is not None and truck is not None:
        tests += parked(lane, truck)
    late = all(cause.onset is not None for cause in findings.causes)
    site = ModalSite(model, windows, accelerometers(model), tests, lane, truck, late)
    doubtful: set[int] = set()
    for one in explanations:
        with suppress(InputError):
            doubtful |= set(site.doubtful(one.effects))
    clear = [number for number in range(len(tests)) if number not in doubtful]
    parking = [number for number, test in enumerate(tests) if test.kind == PARKED_MASS]
    if truck is not None and parking and not set(parking) & set(clear):
        warnings.append(
            f"no parked mass is planned: {mass_of(truck):.3g} t make it doubtful wherever they "
            "stand which mode is which; give a lighter truck with --truck"
        )
    return site.only(range(len(site.added)), clear)
