"""Signatures: what trial values change, on which channels, and sums with a residual."""

from dataclasses import replace

import numpy as np
import pytest

from known_problem import candidate, candidates, change_of
from rga.diagnosis.data.tare import Tare
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.signatures import Block, chunks, signature, signatures


def test_a_signature_is_the_change_at_its_trial(nothing_off: Problem) -> None:
    data, about = nothing_off.data, nothing_off.data.about(nothing_off.simulator)
    bias = candidate(nothing_off, "sensor_bias", sensor="D2")
    found = signature(data, about, 3, bias, (0.1,))
    assert found is not None
    assert found.number == 3
    assert found.channels is not None
    assert found.channels.tolist() == [1]
    assert found.values == pytest.approx(change_of(nothing_off, bias, 0.1)[:, [1]].T)
    sunk = candidate(nothing_off, "support_settlement", support="east", dof="uz")
    found = signature(data, about, 0, sunk, (0.1,))
    assert found is not None
    assert found.channels is None
    assert found.values == pytest.approx(change_of(nothing_off, sunk, 0.1).T, abs=1e-9)


def test_a_late_effect_takes_its_share_of_the_rows(nothing_off: Problem) -> None:
    data, about = nothing_off.data, nothing_off.data.about(nothing_off.simulator)
    bias = candidate(nothing_off, "sensor_bias", sensor="D2")
    late = signature(data, about, 0, bias.beginning(float(data.time[70])), (0.1,))
    always = signature(data, about, 0, bias, (0.1,))
    assert late is not None
    assert always is not None
    assert not late.values[:, :70].any()
    np.testing.assert_array_equal(late.values[:, 70:], always.values[:, 70:])


def test_what_a_zero_takes_off_is_the_mean_of_its_rows(nothing_off: Problem) -> None:
    data = nothing_off.data
    sensors = len(data.sensors)
    contexts = {name: column[:4] for name, column in data.belief.table.items()}
    tare = Tare(contexts, np.full((4, sensors), 0.25), np.full(sensors, 4), 4)
    zeroed = replace(data, tare=tare)
    sunk = candidate(nothing_off, "support_settlement", support="east", dof="uz")
    about = zeroed.about(nothing_off.simulator)
    always = signature(zeroed, about, 0, sunk, (0.1,))
    late = signature(zeroed, about, 0, sunk.beginning(float(data.time[70])), (0.1,))
    assert always is not None
    assert late is not None
    # A settlement is the same in all rows: the zero takes it off whole, and keeps a later one.
    np.testing.assert_allclose(always.values, 0.0, atol=1e-9)
    np.testing.assert_allclose(always.zero, change_of(nothing_off, sunk, 0.1)[0], atol=1e-9)
    assert not late.zero.any()
    np.testing.assert_allclose(
        late.values[:, 70:], change_of(nothing_off, sunk, 0.1)[70:].T, atol=1e-9
    )


def test_blocks_hold_every_trial_once_and_sum_as_the_signatures_do(nothing_off: Problem) -> None:
    data, about = nothing_off.data, nothing_off.data.about(nothing_off.simulator)
    several = candidates(nothing_off, "sensor_bias", "member_stiffness", "support_settlement")
    alone = list(signatures(data, about, several))
    assert {one.number for one in alone} == set(range(len(several)))
    weighted = np.random.default_rng(0).standard_normal(nothing_off.simulated.T.shape)
    blocks = list(chunks(iter(alone)))
    assert {len(block.values[0]) for block in blocks} >= {1, len(data.sensors)}
    sums = {
        (number, z): total
        for block in blocks
        for (number, _, z), total in zip(
            block.members, block.along(weighted).sum(1).tolist(), strict=True
        )
    }
    assert len(sums) == len(alone)
    for one in alone:
        on = weighted if one.channels is None else weighted[one.channels]
        assert sums[one.number, one.z] == pytest.approx(float((one.values * on).sum()), abs=1e-9)
    kept = Block.of(alone[:3]).kept(np.array([True, False, True]))
    assert [number for number, _, _ in kept.members] == [alone[0].number, alone[2].number]
