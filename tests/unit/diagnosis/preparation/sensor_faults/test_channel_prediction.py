"""What channels show by themselves: beyond the loads, and beyond what other channels predict."""

import numpy as np
import pytest

from rga.diagnosis.preparation.sensor_faults.channel_prediction import (
    beyond_others,
    own_parts,
    robust_deviation,
    robust_fit,
    root_mean_square,
    slow_part,
    trimmed_size,
)
from rga.model import Model

ROWS = 200
SENSORS = ("D1", "D2", "D3", "DX", "S L0-L1", "S L2-L3")


@pytest.fixture
def draw() -> np.random.Generator:
    return np.random.default_rng(5)


def test_a_fit_leaves_far_readings_out(draw: np.random.Generator) -> None:
    basis = draw.standard_normal((ROWS, 2))
    column = 2.0 + basis @ [1.0, -3.0] + 0.01 * draw.standard_normal(ROWS)
    column[::20] += 50.0
    np.testing.assert_allclose(robust_fit(column, basis), 2 + basis @ [1.0, -3.0], atol=0.02)


def test_a_deviation_by_the_median(draw: np.random.Generator) -> None:
    values = 7.0 + 3.0 * draw.standard_normal(20_000)
    values[:500] = 1e9
    assert robust_deviation(values) == pytest.approx(3.0, rel=0.05)
    assert robust_deviation(np.zeros(0)) == 0.0


def test_sizes_without_missing_and_largest_readings() -> None:
    columns = np.zeros((400, 2))
    columns[:300, 0], columns[:, 1] = 2.0, 1.0
    columns[0, 1] = 1e6
    assert root_mean_square(columns)[0] == pytest.approx(2.0)
    assert trimmed_size(columns)[1] == pytest.approx(1.0)
    assert slow_part(np.arange(16.0)[:, None])[:, 0].tolist() == [3.5, 11.5]


def test_what_channels_have_in_common_they_predict_of_each_other(
    draw: np.random.Generator,
) -> None:
    common = draw.standard_normal(ROWS)
    own = 0.05 * draw.standard_normal((ROWS, 6))
    left = np.outer(common, [1.0, 2.0, -1.0, 0.5, 1.0, 1.5]) + own
    left[:, 4] += 3.0 * np.sign(draw.standard_normal(ROWS))
    rest = root_mean_square(beyond_others(left, np.ones(left.shape, dtype=bool)))
    size = root_mean_square(left)
    assert rest[4] > 0.8 * 3.0
    assert (np.delete(rest / size, 4) < 0.4).all()


def test_a_channel_of_its_own_ways_is_large_among_sound_ones(
    model: Model, draw: np.random.Generator
) -> None:
    basis = draw.standard_normal((ROWS, 2))
    simulated = basis @ draw.standard_normal((2, 6))
    noise = np.array([model.sensors[name].noise for name in SENSORS], dtype=float)
    readings = simulated + noise * draw.standard_normal(simulated.shape)
    observed = np.ones(readings.shape, dtype=bool)
    sound = own_parts(model, SENSORS, readings, observed, basis, simulated)
    assert (sound.size < 1.5).all()
    assert sound.usual == pytest.approx(noise, rel=0.2)
    readings[:, 1] += 6 * noise[1] * np.sign(draw.standard_normal(ROWS))
    broken = own_parts(model, SENSORS, readings, observed, basis, simulated)
    assert np.argmax(broken.size) == 1
    assert broken.size[1] > 2.5 > np.delete(broken.size, 1).max()
    # A part that changes slowly is seen in its means.
    readings[:, 1] = simulated[:, 1] + noise[1] * np.sin(0.02 * np.arange(ROWS)) * 4
    slow = own_parts(model, SENSORS, readings, observed, basis, simulated)
    assert np.argmax(slow.size) == 1


@pytest.mark.parametrize("seen", [slice(0, 50), slice(150, 200), slice(0, None, 4)])
def test_a_channel_that_lacks_readings_is_judged_by_those_it_has(
    seen: slice, draw: np.random.Generator
) -> None:
    common = draw.standard_normal(ROWS)
    left = np.outer(common, [1.0, 2.0, -1.0, 0.5, 1.0, 1.5])
    left += 0.05 * draw.standard_normal(left.shape)
    observed = np.ones(left.shape, dtype=bool)
    whole = root_mean_square(beyond_others(left, observed)[seen])
    observed[:, 1] = False
    observed[seen, 1] = True
    rest = beyond_others(np.where(observed, left, 0.0), observed)
    assert (rest[~observed] == 0.0).all()
    assert root_mean_square(rest)[1] < 1.5 * whole[1]


def test_rows_in_which_most_channels_are_silent_judge_none(draw: np.random.Generator) -> None:
    left = np.outer(draw.standard_normal(ROWS), [1.0, 2.0, -1.0, 0.5, 1.0, 1.5])
    observed = np.ones(left.shape, dtype=bool)
    observed[60:, 1:] = False
    rest = beyond_others(np.where(observed, left, 0.0), observed)
    assert (rest[60:] == 0.0).all()
    assert rest[:60, 0].any()
