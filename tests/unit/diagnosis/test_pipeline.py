"""The order of the steps: a record in, findings out, and nothing found where nothing is hidden."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from rga.arrays import FloatArray
from rga.diagnosis.pipeline import diagnose
from rga.findings import Findings
from rga.model import Model
from rga.records import Record

Said = list[tuple[str, float]]


@pytest.fixture(scope="module")
def diagnosed(
    model: Model, measured_record: Callable[..., Record]
) -> tuple[Findings, Findings, Said]:
    """Findings of a record with an offset, of its null twin, and the progress of the first."""
    said: Said = []
    off = {"kind": "sensor_bias", "sensor": "D2", "offset": 0.5}
    return (
        diagnose(model, measured_record(model, off), progress=lambda *one: said.append(one)),
        diagnose(model, measured_record(model)),
        said,
    )


def test_what_is_hidden_is_named(diagnosed: tuple[Findings, Findings, Said]) -> None:
    found, _, _ = diagnosed
    (cause,) = found.causes
    assert found.verdict == "named"
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("sensor_bias", "D2")
    low, high = cause.effect["offset"]["ci90"]
    assert low < 0.5 < high
    assert found.gap.after == pytest.approx(1.0, abs=0.1)
    assert found.gap.held_out.gain_ci90[0] > 0
    assert list(found.account.extended.effects)[-1] == "sensor bias D2"


def test_where_nothing_is_hidden_nothing_is_found(
    diagnosed: tuple[Findings, Findings, Said],
) -> None:
    _, null, _ = diagnosed
    assert (null.verdict, null.causes, null.warnings) == ("nothing_wrong", [], [])
    assert null.gap.held_out.gain == 0.0


@pytest.mark.thorough
def test_the_scatter_is_that_of_rows_in_which_nothing_acts(
    model: Model, measured_record: Callable[..., Record]
) -> None:
    """What acts later does not raise it; too few of these rows say nothing."""
    sound = measured_record(model)
    half = len(sound.time) // 2
    moved = sound.readings.copy()
    moved[half:] *= np.random.default_rng(3).normal(1.0, 0.05, moved.shape[1])
    off = replace(sound, readings=moved)

    def levels(record: Record, calm: Record | None) -> FloatArray:
        found = diagnose(model, record, calm=calm).account.found
        assert found is not None
        return found.problem.levels

    calm = off.rows(slice(0, half))
    free, beside = levels(off, None), levels(off, calm)
    np.testing.assert_array_equal(beside, levels(sound, calm))
    assert free[1] > 1.5 * beside[1]
    np.testing.assert_array_equal(levels(off, off.rows(slice(0, 5))), free)
    unread = replace(calm, readings=np.zeros_like(calm.readings))
    np.testing.assert_array_equal(levels(off, unread), free)


def test_progress_is_said_in_stages(diagnosed: tuple[Findings, Findings, Said]) -> None:
    *_, said = diagnosed
    assert {"screening", "comparing explanations"} <= {stage for stage, _ in said}
    assert all(0 <= done <= 1 for _, done in said)
