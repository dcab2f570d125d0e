"""Natural frequencies that are watched, window by window, though modes are missing in each."""

from dataclasses import replace

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from independent.modal_bridge import Hidden, measured
from rga.errors import InputError
from rga.model import Model
from rga.model.schema import ContextVariable
from rga.records.modal.record import ModalRecord
from rga.twin.sync.context_courses import ContextCourses, without_courses
from rga.twin.sync.modes import watch_modes

WINDOWS, BASELINE, ONSET = 300, 150, 220


def recorded(
    seed: int, hidden: Hidden, lost: float = 0.3, slope: float = 0.0
) -> tuple[Model, ModalRecord]:
    """A record in which every window lacks a mode, some days warmer than others.

    Args:
        seed: of noise and gaps.
        hidden: what happens to the bridge.
        lost: share of the entries that are missing; in the cold it is twice as large.
        slope: of ln f over the range of the temperature.
    """
    model, record = measured(seed, hidden, windows=WINDOWS)
    generator = np.random.default_rng(seed + 50)
    warmth = 0.5 + 0.5 * np.sin(record.time / 86400.0 * 2.0 * np.pi)
    if slope:
        warmth = np.clip(warmth + 0.1 * np.sin(record.time / 7e4), 0.0, 1.0)
    kept = generator.random(len(record)) >= lost * (1.5 - warmth)
    windows = record.windows
    for one in range(windows.max() + 1):
        own = np.flatnonzero(windows == one)
        if kept[own].sum() == len(model.modes):
            kept[own[generator.integers(len(own))]] = False
    frequency = record.frequency * np.exp(-slope * warmth)
    record = replace(record, frequency=frequency, contexts={"air": 30.0 * warmth - 5.0})
    air = ContextVariable(unit="degC", range=(-20.0, 40.0))
    return model.model_copy(update={"context": {"air": air}}), record.entries(kept)


@pytest.mark.parametrize("seed", [3, 4])
def test_a_change_of_one_part_is_found_though_no_window_has_all_modes(seed: int) -> None:
    quiet = watch_modes(*recorded(seed, Hidden()), BASELINE, seed=1)
    assert not np.isfinite(quiet.left).all(axis=1).any()
    assert quiet.alarm is None
    hidden = Hidden(stiffness={"bottom bracing": 0.95}, onset=ONSET)
    watched = watch_modes(*recorded(seed, hidden), BASELINE, seed=1)
    assert watched.alarm is not None
    assert ONSET - 5 <= watched.alarm.since <= watched.alarm.row <= ONSET + 20
    assert set(watched.alarm.sensors) <= set(watched.modes)
    assert watched.alarm.words.startswith("out of sync: a step since")
    assert "-0." in watched.alarm.words


def test_what_temperature_does_is_no_change() -> None:
    """Frequencies fall by 3 % where it is warm, and modes are lost where it is cold."""
    model, record = recorded(5, Hidden(), slope=0.03)
    watched = watch_modes(model, record, BASELINE)
    assert watched.alarm is None
    assert np.nanstd(watched.left) < 0.003
    blind = watch_modes(model, replace(record, contexts={}), BASELINE)
    assert np.nanstd(blind.left) > 0.005


def test_one_mode_that_shifts_is_named() -> None:
    model, record = recorded(6, Hidden())
    late = (record.windows >= ONSET) & (np.abs(np.log(record.frequency / modal(model, 2))) < 0.02)
    record = replace(record, frequency=np.where(late, 0.985, 1.0) * record.frequency)
    watched = watch_modes(model, record, BASELINE)
    assert watched.alarm is not None
    assert watched.alarm.sensors == ("m2",)
    assert "m2 -1.5 %" in watched.alarm.words


def modal(model: Model, number: int) -> float:
    return model.modes[f"m{number}"].near


def test_the_order_of_entries_and_their_signs_say_nothing() -> None:
    model, record = recorded(7, Hidden())
    watched = watch_modes(model, record, BASELINE)
    order = np.random.default_rng(0).permutation(len(record))
    turned = record.entries(order)
    turned = replace(turned, shapes=-turned.shapes)
    again = watch_modes(model, turned, BASELINE)
    np.testing.assert_allclose(again.left, watched.left, atol=1e-12)


def test_windows_that_cannot_be_judged_are_told() -> None:
    model, record = recorded(8, Hidden())
    warm = np.where(record.windows >= 280, 60.0, record.contexts["air"])
    bare = np.where((record.windows < 10)[:, None], np.nan, record.shapes)
    other = replace(record, contexts={"air": warm}, shapes=bare)
    watched = watch_modes(model, other, BASELINE)
    assert np.isnan(watched.left[280:]).all()
    assert any("not judged by the watch" in one and "air" in one for one in watched.warnings)
    assert any("another pairing" in one for one in watched.warnings)
    assert not any("watch" in one for one in watch_modes(model, record, BASELINE).warnings)


def test_a_mode_that_is_never_there_is_told_and_the_others_are_watched() -> None:
    model, record = recorded(9, Hidden(stiffness={"bottom bracing": 0.95}, onset=ONSET))
    lost = np.abs(np.log(record.frequency / modal(model, 1))) < 0.05
    watched = watch_modes(model, record.entries(~lost), BASELINE)
    assert list(watched.unwatched) == ["m1"]
    assert any("mode m1 is not watched" in one for one in watched.warnings)
    assert watched.alarm is not None


def test_too_short_a_baseline_is_refused() -> None:
    model, record = recorded(10, Hidden())
    for baseline in (0, WINDOWS, 10_000):
        with pytest.raises(InputError, match="are to say what is usual"):
            watch_modes(model, record, baseline)
    with pytest.raises(InputError, match="readings of a mode beside 1 context, and"):
        watch_modes(model, record, 40)


def test_what_is_left_has_one_variance_in_the_baseline_and_behind() -> None:
    generator = np.random.default_rng(0)
    before, behind = [], []
    for _ in range(400):
        contexts = {"air": generator.uniform(0.0, 10.0, 60)}
        courses = ContextCourses.of({"air": contexts["air"][:40]}, 120)
        assert courses.fitted == 3
        columns = courses.columns(contexts, 60)
        left = without_courses(columns, generator.standard_normal((60, 1)), 40)
        before.append(np.nanmean(left[:40] ** 2))
        behind.append(np.nanmean(left[40:] ** 2))
    assert abs(np.mean(before) - 1.0) < 0.05
    assert abs(np.mean(behind) - 1.0) < 0.06


def test_any_number_of_threads_gives_the_same_bits() -> None:
    model, record = recorded(11, Hidden(stiffness={"bottom bracing": 0.95}, onset=ONSET))
    found = []
    for threads in (1, 2):
        with threadpool_limits(threads):
            found.append(watch_modes(model, record, BASELINE))
    assert found[0].left.tobytes() == found[1].left.tobytes()
    assert found[0].alarm is not None
    assert found[0].alarm == found[1].alarm
