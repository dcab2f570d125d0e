"""Gauges and modes side by side: each reads its own, and nothing is shared but explanations."""

import numpy as np
import pytest

from independent.mixed_bridge import with_gauges
from independent.modal_bridge import Hidden, described
from rga.experiments.candidates import added_sensors, settings
from rga.experiments.defaults import usual_operation
from rga.experiments.explanation import explanation
from rga.experiments.measurement_model import MeasurementModel
from rga.findings.schema import FoundMode, Windows
from rga.model import Model, read_effect, read_model
from rga.planning.modal.candidates import accelerometers, more_windows
from rga.planning.modal.site import SILENT, ModalSite
from rga.planning.modal.with_gauges import SiteWithModes
from rga.planning.scope import LEVELS

SOFTER = {
    "kind": "elastic_modulus",
    "material": "steel",
    "factor": {"value": 0.9, "ci90": [0.88, 0.92]},
}


@pytest.fixture(scope="module")
def model() -> Model:
    content, _ = described(0, Hidden(), modes=3)
    return read_model(with_gauges(content), "bridge")


@pytest.fixture(scope="module")
def gauges(model: Model) -> MeasurementModel:
    added = [one for one in added_sensors(model) if one.sensor is not None][:5]
    tests = settings(model, set(model.context))
    working = list(model.sensors)[:4]
    return MeasurementModel(
        model, working, added, tests, usual_operation(model), None, None, LEVELS
    )


@pytest.fixture(scope="module")
def modes(model: Model) -> ModalSite:
    found = {
        name: FoundMode(frequency=one.near, scatter=0.002, memory=0.0, found=1.0, shape=one.shape)
        for name, one in model.modes.items()
    }
    windows = Windows(count=20, modes=found)
    added = accelerometers(model)[:2]
    return ModalSite(model, windows, added, [more_windows(windows)], None, None, False)


@pytest.fixture(scope="module")
def both(gauges: MeasurementModel, modes: ModalSite) -> SiteWithModes:
    return SiteWithModes(gauges, modes)


def test_each_reads_its_own(
    both: SiteWithModes, gauges: MeasurementModel, modes: ModalSite, model: Model
) -> None:
    effects = explanation("softer", model, [read_effect(SOFTER, "softer")]).effects
    shown, errors = both.measurements(effects), both.errors(effects)
    assert (both.standing, both.operating) == (4 + 3, gauges.operating + 3)
    assert [one.name for one in both.added] == both.sensors[both.standing :]
    seen = np.zeros_like(shown, dtype=bool)
    for one in (gauges, modes):
        columns = [both.sensors.index(name) for name in one.sensors]
        first = 0 if one is gauges else gauges.operating
        tests = [both.operating + both.tests.index(test) for test in one.tests]
        rows = [*range(first, first + one.operating), *tests]
        here = np.ix_(rows, columns)
        np.testing.assert_array_equal(shown[here], one.measurements(effects))
        own = one.errors(effects)
        np.testing.assert_array_equal(errors.noise[here], own.noise)
        np.testing.assert_array_equal(errors.gain[here], own.gain)
        assert [both.unit(k) for k in columns] == [one.unit(k) for k in range(len(columns))]
        seen[here] = True
    assert not shown[~seen].any()
    assert (errors.noise[~seen] == SILENT).all()
    assert not errors.shared[:, ~seen].any()
    assert np.square(errors.shared).sum() == pytest.approx(
        np.square(gauges.errors(effects).shared).sum()
    )


def test_what_shows_without_a_test_is_of_its_own_site(
    both: SiteWithModes, gauges: MeasurementModel
) -> None:
    apart = np.arange(float(both.operating))
    weights, words = both.without_test(both.sensors.index(gauges.added[0].name), apart)
    assert np.flatnonzero(weights).tolist() == [0, gauges.operating - 1]
    assert words.startswith("from ")
    weights, words = both.without_test(len(both.sensors) - 1, apart)
    assert np.flatnonzero(weights).tolist() == [both.operating - 1]
    assert words.startswith("in mode m2")


def test_derivatives_are_those_of_the_measurements(both: SiteWithModes, model: Model) -> None:
    one = explanation("softer", model, [read_effect(SOFTER, "softer")])
    (slope,) = both.derivatives(one, [0.0])
    step = 0.1
    ahead, behind = (both.measurements(one.at([sign * step])) for sign in (1.0, -1.0))
    np.testing.assert_allclose(slope, (ahead - behind) / (2 * step), rtol=1e-2, atol=1e-6)
