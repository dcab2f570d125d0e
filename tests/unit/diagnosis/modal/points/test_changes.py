"""Sensors at points that read otherwise from some window on, and such that only scatter."""

from collections.abc import Callable

import numpy as np
import pytest

from rga.diagnosis.modal.points.changes import point_changes

WINDOWS, MODES, POINTS = 40, 3, 8


def entries(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Shapes of all modes in all windows, of any scale and sign, their windows and modes."""
    draw = np.random.default_rng(seed)
    predicted = draw.choice([-1.0, 1.0], (MODES, POINTS)) * draw.uniform(0.5, 1.5, (MODES, POINTS))
    windows, modes = np.repeat(np.arange(WINDOWS), MODES), np.tile(np.arange(MODES), WINDOWS)
    noise = 1.0 + 0.03 * draw.normal(size=(len(windows), POINTS))
    shapes = predicted[modes] * noise * draw.normal(size=len(windows))[:, None]
    return shapes, windows, modes, np.tile(predicted, (WINDOWS, 1, 1))


@pytest.mark.parametrize("seed", range(20))
def test_of_sound_sensors_nothing_is_said(seed: int) -> None:
    assert point_changes(*entries(seed)) == []


def still_points(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The same at points that hardly move, which read noise; the first mode is often lacking."""
    _, windows, modes, predicted = entries(seed)
    draw = np.random.default_rng(seed + 100)
    predicted[:, 0, 3:] *= 0.03
    predicted[:, 1:, 5] *= 0.03
    shapes = predicted[windows, modes] + 0.03 * draw.normal(size=(len(windows), POINTS))
    found = (modes > 0) | (draw.random(len(windows)) < np.where(windows < 20, 0.9, 0.3))
    return shapes[found], windows[found], modes[found], predicted


def one_mode_of_another_shape(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The same where the model is wrong of one mode, which is found in late windows alone."""
    shapes, windows, modes, predicted = entries(seed)
    found = (modes > 0) | (windows >= 20)
    draw = np.random.default_rng(seed + 200)
    predicted[:, 0] = draw.normal(size=POINTS)
    return shapes[found], windows[found], modes[found], predicted


@pytest.mark.parametrize("make", [still_points, one_mode_of_another_shape])
@pytest.mark.parametrize("seed", range(20))
def test_points_that_hardly_move_and_a_wrong_mode_are_no_change(
    make: Callable[[int], tuple[np.ndarray, ...]], seed: int
) -> None:
    shapes, windows, modes, predicted = make(seed)
    assert point_changes(shapes, windows, modes, predicted) == []


@pytest.mark.parametrize("times", [0.0, 0.5, -1.0])
@pytest.mark.parametrize("seed", range(5))
def test_a_sensor_that_reads_otherwise_is_found_with_its_window(seed: int, times: float) -> None:
    shapes, windows, modes, predicted = entries(seed)
    shapes[windows >= 25, 4] *= times
    (found,) = point_changes(shapes, windows, modes, predicted)
    assert (found.point, found.window) == (4, 25)
    assert found.times == pytest.approx(times, abs=0.2)


def test_what_a_structure_is_predicted_to_do_is_no_change() -> None:
    shapes, windows, modes, predicted = entries(0)
    shapes[windows >= 25, 4] *= 0.5
    predicted[25:, :, 4] *= 0.5
    assert point_changes(shapes, windows, modes, predicted) == []


def test_what_all_points_do_is_the_structure_s_doing() -> None:
    shapes, windows, modes, predicted = entries(0)
    shapes[windows >= 25] *= np.linspace(0.2, 3.0, POINTS)
    assert point_changes(shapes, windows, modes, predicted) == []


def test_few_windows_say_nothing() -> None:
    shapes, windows, modes, predicted = entries(0)
    shapes[windows >= 4, 4] = 0.0
    few = windows < 9
    assert point_changes(shapes[few], windows[few], modes[few], predicted[:9]) == []
