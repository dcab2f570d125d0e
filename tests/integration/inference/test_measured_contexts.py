"""Contexts that instruments read, beside those that a joint inference finds."""

import numpy as np
import pytest

from plane_models import drawn, measured, noise_of
from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference import MeasuredContexts, Unknowns, infer_jointly
from rga.model import Model


def test_contexts_that_instruments_read_are_taken_as_read(model: Model, other: Model) -> None:
    contexts, noise = drawn(model, 40, 83), noise_of(model)
    contexts[:5, 0] = 5.0  # beyond its range
    rows, source = measured(other, contexts, 84), drawn(model, 300, 85)
    read = np.full_like(contexts, np.nan)
    read[:, 0] = contexts[:, 0] + 0.1 * np.random.default_rng(86).standard_normal(40)
    read[7, 0] = np.nan
    ranges = np.array([one.range for one in model.context.values()])
    instruments = MeasuredContexts.of(read, np.array([0.1, 0.0, 0.0, 0.0]), ranges)
    unknowns = Unknowns(model)
    found = infer_jointly(unknowns, rows, noise, source, measured=instruments)
    assert np.abs(found.rows.contexts[:, 0] - contexts[:, 0]).max() < 0.3
    chord = found.values[[part.name for part in unknowns.parts].index("stiffness of bottom chord")]
    assert 10.0**chord == pytest.approx(0.85, abs=0.03)
    again = found.infer(rows, instruments)
    assert np.abs(again.value[:, 0] - contexts[:, 0]).max() < 0.3
    blind = found.infer(np.full_like(rows, np.nan), instruments)
    known = np.isfinite(read[:, 0])
    np.testing.assert_allclose(blind.value[known, 0], read[known, 0], atol=0.02)
    np.testing.assert_allclose(blind.spread[known, 0], 0.1, rtol=0.05)


@pytest.mark.parametrize(
    ("values", "noise", "problem"),
    [
        (np.zeros((3, 4)), np.ones(4), "20 rows of readings and 3 of measured contexts"),
        (np.zeros((20, 3)), np.ones(4), "measured contexts have the shape"),
        (np.zeros((20, 4)), np.zeros(4), "noise of measured contexts is not known"),
        (np.zeros((20, 4)), np.ones(3), "noise of measured contexts is not known"),
        (np.full((20, 4), -9999.0), np.ones(4), "'crowd' reads -9999, and its range is 0 to 4"),
    ],
)
def test_measured_contexts_of_another_shape_are_refused(
    model: Model, values: FloatArray, noise: FloatArray, problem: str
) -> None:
    rows, source = measured(model, drawn(model, 20, 87), 88), drawn(model, 40, 89)
    with pytest.raises(InputError, match=problem):
        infer_jointly(
            Unknowns(model), rows, noise_of(model), source, measured=MeasuredContexts(values, noise)
        )


def test_one_row_that_instruments_read_is_one_row(model: Model, other: Model) -> None:
    contexts, noise = drawn(model, 60, 90), noise_of(model)
    rows, source, unknowns = measured(other, contexts, 91), drawn(model, 300, 92), Unknowns(model)
    read = np.full_like(contexts, np.nan)
    read[0] = contexts[0]
    once = MeasuredContexts(read, np.full(4, 1e-2))
    without, beside = (
        infer_jointly(unknowns, rows, noise, source, measured=one) for one in (None, once)
    )
    assert np.abs((beside.values - without.values) / unknowns.spread).max() < 1.0
    np.testing.assert_allclose(beside.rows.contexts[0], contexts[0], atol=0.05)
