"""Causes that readings speak for which were not fitted: rows that no step saw, channels left out.

Evidence is only as good as the noise and the freedom that it assumes. A cause of the structure
stays where it brings the model closer to held-out rows, by an interval that leaves zero out, and
where channels left out of the fit get no worse by it. Channels are left out in groups. That the
others know a parameter badly, and miss a group by chance, is no harm: a larger gap counts where
the readings of a group are less likely, as the others predict them. A cause at a sensor, which
harms nobody else, stays where held-out rows do not speak against it, or where it is twice as sure
and they do not surely get worse. No cause stands on a reading or two: an outlier is no cause.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from rga.diagnosis.checks.explanations import groups_left_out, hiding, on_unseen
from rga.diagnosis.checks.whole_record import WholeRecord, about
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.laplace import Fit, evidence_without, refit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.stepwise import Found, settled_with, without_cause


def supported(
    found: Found,
    start: Problem,
    whole: WholeRecord,
    seed: int,
    weighed: Callable[[Found], Found],
) -> tuple[Found, list[Hypothesis]]:
    """What was found, less the causes that nothing speaks for but the readings fitted.

    Args:
        found: the end of the search.
        start: where it began.
        whole: the record with its held-out rows.
        seed: of the bootstrap.
        weighed: weighs causes that are left against each other anew.

    Returns:
        What is left, and what was taken out of the structure.
    """
    dropped: list[Hypothesis] = []
    while True:
        number = _least_supported(found, start, whole, seed)
        if number is None:
            return found, dropped
        one = found.fit.hypotheses[number]
        dropped += [] if one.kind.on_sensors else [one]
        without = without_cause(found.problem, found.base, found.fit, number)
        found = weighed(_settled(found, without))


def _settled(found: Found, fit: Fit) -> Found:
    problem, fit = settled_with(found.base, found.problem, fit)
    none: tuple[()] = ()
    return Found(problem, fit, found.base, none, none)


def _least_supported(found: Found, start: Problem, whole: WholeRecord, seed: int) -> int | None:
    """The number of the cause that least speaks for, of those to take out; None: of none.

    Causes may undo each other, as the stiffness of a member and the gain of its gauge do: each is
    needed only because of the other. Where all of them together do not bring the model closer,
    none of the structure is left.
    """
    problem, base, criteria = found.problem, found.base, found.problem.criteria.naming
    after = whole.simulated(problem)
    gains, of_structure = {}, {}
    for number, one in enumerate(found.fit.hypotheses):
        without = without_cause(problem, base, found.fit, number)
        before = whole.simulated(about(problem, without.simulator(base)))
        gained = whole.gain(before, after, found.fit.hypotheses, seed)
        if one.kind.on_sensors:
            lead = found.fit.log_evidence - without.log_evidence
            sure = lead >= criteria.sensor_multiple * criteria.log_odds
            harmful = gained.interval[1] < 0 or (gained.before <= gained.after and not sure)
        else:
            of_structure[number] = gained.interval[0]
            harmful = gained.interval[0] <= 0 or worsens(found, without)
        if harmful or stands_on_few(found, without):
            gains[number] = gained.interval[0]
    if not gains and of_structure:
        together = whole.gain(whole.simulated(start), after, found.fit.hypotheses, seed)
        gains = of_structure if together.interval[0] <= 0 else {}
    return min(gains, key=lambda number: gains[number]) if gains else None


def gaps_left_out(found: Found) -> tuple[float, float] | None:
    """Gap of channels left out of the fit, without the causes of the structure and with them.

    Of groups that speak against the causes; None where there is no such group.
    """
    hypotheses = found.fit.hypotheses
    numbers = [k for k, one in enumerate(hypotheses) if not one.kind.on_sensors]
    if not numbers:
        return None
    without = without_cause(found.problem, found.base, found.fit, *numbers)
    least = found.problem.criteria.naming.group_against
    against = [names for names, odds in _against(found, without) if odds > least]
    if not against:
        return None
    before, after = on_unseen(found.problem, found.base, [without, found.fit], against)
    return before.gap, after.gap


def worsens(found: Found, without: Fit) -> bool:
    """Whether channels that were left out speak against a cause, one group of them strongly.

    Args:
        found: with the cause.
        without: fitted without it.
    """
    against = [odds for _, odds in _against(found, without)]
    least = found.problem.criteria.naming.group_against
    return sum(against) > 0 and max(against) > least


def _against(found: Found, without: Fit) -> Iterator[tuple[list[str], float]]:
    """Groups of channels, and the log-odds by which each speaks against a cause.

    What a cause leads by on all channels is its lead on those outside a group, and what it makes
    of the group's readings given the others.

    Args:
        found: with the cause.
        without: fitted without it.
    """
    lead = found.fit.log_evidence - without.log_evidence
    for names in groups_left_out(found.base.model, found.problem.data.sensors):
        part = hiding(found.problem, names)
        beside, alone = refit(part, found.base, [found.fit, without])
        yield names, beside.log_evidence - alone.log_evidence - lead


def stands_on_few(found: Found, without: Fit) -> bool:
    """Whether a cause hangs on a reading or two: those that speak most for it.

    Args:
        found: with the cause.
        without: fitted without it.
    """
    criteria = found.problem.criteria.naming
    # As read: tails that were judged beside a cause may speak for it.
    problem = replace(found.problem, tails=np.zeros_like(found.problem.tails))
    before, after = (problem.residual(one.simulated) for one in (without, found.fit))
    inverse = problem.covariance.inverse_times(before + after).T
    # Summed up, these are twice what they gain by the cause.
    gained = np.where(problem.data.observed, inverse * (before - after), 0.0)
    most = np.argsort(-gained, axis=None)[: criteria.few_readings]
    cells = np.column_stack(np.unravel_index(most[gained.ravel()[most] > 0], gained.shape))
    with_all, with_fewer = (
        float(np.subtract(*evidence_without(problem, [found.fit, without], hidden)))
        for hidden in (cells[:0], cells)
    )
    # As read, outliers elsewhere may speak against a cause; that is another matter.
    return with_all > 0 >= with_fewer
