"""What planned measurements will show: the readings in which explanations differ most."""

from collections.abc import Sequence

import numpy as np

from rga.arrays import FloatArray
from rga.experiments.candidates import LoadTest
from rga.experiments.explanation import HALF_WIDTH
from rga.experiments.measurement_model import Errors
from rga.experiments.separation import Pair
from rga.experiments.site import Site
from rga.planning.result import PlannedSensor, PlannedTest, Says, Telling
from rga.planning.selection import Choice

#: readings of a test that are shown
SHOWN = 3


def planned_sensor(
    site: Site, errors: Errors, pairs: Sequence[Pair], choice: Choice, column: int
) -> PlannedSensor:
    """A chosen sensor, with the change of its readings in operation that separates them most."""
    one = site.added[column - site.standing]
    operating = slice(0, site.operating)
    lead = max(pairs, key=lambda pair: float(np.ptp(pair.difference[operating, column])))
    tells = []
    if any(np.any(pair.difference[operating, column]) for pair in pairs):
        weights, change = site.without_test(column, lead.difference[operating, column])
        tells.append(_telling(site, errors, pairs, weights, column, change))
    tells += [
        _of_test(site, errors, pairs, test, column)
        for test in choice.tests
        if any(_reads(pair, site.operating + test, column) for pair in pairs)
    ]
    return PlannedSensor(
        words=one.words,
        sensor=one.sensor.model_dump(mode="json", exclude_defaults=True) if one.sensor else None,
        context=one.context or None,
        point=one.point.model_dump(mode="json") if one.point else None,
        unit=one.unit,
        noise=one.noise,
        cost=one.cost,
        tells=tells,
    )


def planned_test(
    site: Site, errors: Errors, pairs: Sequence[Pair], choice: Choice, number: int
) -> PlannedTest:
    """A chosen test, with the readings of it that separate them most."""
    test: LoadTest = site.tests[number]
    row = site.operating + number
    spread = np.sqrt(errors.noise[row] ** 2 + errors.gain[row] ** 2)
    apart = np.max([np.abs(pair.difference[row]) for pair in pairs], axis=0)
    measured = [
        k
        for k in (*range(site.standing), *choice.sensors)
        if any(_reads(pair, row, k) for pair in pairs)
    ]
    order = sorted(measured, key=lambda k: -apart[k] / max(spread[k], 1e-12))
    return PlannedTest(
        words=test.words,
        position=test.position,
        contexts=test.at,
        against=test.against,
        cost=test.cost,
        tells=[_of_test(site, errors, pairs, number, k) for k in order[:SHOWN]],
    )


def _reads(pair: Pair, row: int, column: int) -> bool:
    """Whether a sensor reads anything in a measurement: gauges read nothing of modes."""
    return bool(pair.predicted[:, row, column].any() or pair.unknown[:, row, column].any())


def _of_test(
    site: Site, errors: Errors, pairs: Sequence[Pair], number: int, column: int
) -> Telling:
    weights = np.zeros(len(errors.noise))
    weights[site.operating + number] = 1.0
    return _telling(site, errors, pairs, weights, column, site.tests[number].words)


def _telling(
    site: Site,
    errors: Errors,
    pairs: Sequence[Pair],
    weights: FloatArray,
    column: int,
    change: str,
) -> Telling:
    """What explanations say of a weighted sum of one sensor's measurements."""
    shared = float(((errors.shared[:, :, column] @ weights) ** 2).sum())
    gain = float(errors.gain[:, column] @ weights) ** 2
    noise = float(((errors.noise[:, column] * weights) ** 2).sum())

    def says(words: str, predicted: FloatArray, unknown: FloatArray) -> Says:
        value = float(predicted[:, column] @ weights)
        own = float(((unknown[:, :, column] @ weights) ** 2).sum())
        half = HALF_WIDTH * float(np.sqrt(shared + gain + noise + own))
        return Says(explanation=words, value=value, ci90=(value - half, value + half))

    predictions: dict[str, Says] = {}
    for pair in pairs:
        count = len(pair.cause.unknowns)
        for one, predicted, unknown in (
            (pair.cause, pair.predicted[0], pair.unknown[:count]),
            (pair.rival, pair.predicted[1], pair.unknown[count:]),
        ):
            predictions.setdefault(one.words, says(one.words, predicted, unknown))
    return Telling(
        sensor=site.sensors[column],
        unit=site.unit(column),
        change=change,
        says=list(predictions.values()),
    )
