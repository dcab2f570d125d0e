"""Channels and groups that answer more or less than a model says, beyond noise and scatter."""

from dataclasses import replace

import numpy as np
import pytest

from rga.diagnosis.residuals.lack_of_fit import Misfit, misfits
from rga.diagnosis.search.linearised import Problem

STRAINS = {"strains": ["S L0-L1", "S L2-L3", "S U1-U2", "S U2-U3"]}


def reading(posed: Problem, names: list[str], factor: float) -> Problem:
    """The problem where channels read so many times what is simulated."""
    columns = [posed.data.sensors.index(name) for name in names]
    readings = posed.data.readings.copy()
    readings[:, columns] += (factor - 1) * posed.simulated[:, columns]
    return replace(posed, data=replace(posed.data, readings=readings))


def test_a_sound_record_has_no_misfit(posed: Problem) -> None:
    assert misfits(posed, posed.simulated, STRAINS) == []


@pytest.mark.parametrize("factor", [1.4, 0.6])
def test_a_channel_that_reads_otherwise_is_reported_by_how_much(
    posed: Problem, factor: float
) -> None:
    problem = reading(posed, ["S L0-L1"], factor)
    found = misfits(problem, posed.simulated, {})
    assert found[0].channels == ("S L0-L1",)
    assert found[0].percent == pytest.approx(100 * (factor - 1), abs=2)
    assert np.sign(found[0].deviations) == np.sign(factor - 1)
    assert len(found) == 1


def test_a_group_is_reported_where_each_of_its_channels_is_off_a_little(posed: Problem) -> None:
    problem = reading(posed, STRAINS["strains"], 1.12)
    groups = [one for one in misfits(problem, posed.simulated, STRAINS) if not one.alone]
    (group,) = groups
    assert group.percent == pytest.approx(12, abs=2)
    alone = misfits(problem, posed.simulated, {})
    assert all(abs(group.deviations) > abs(one.deviations) for one in alone)


def test_plausible_scatter_allows_a_channel_some(posed: Problem) -> None:
    assert misfits(reading(posed, ["S L0-L1"], 1.04), posed.simulated, {}) == []


def test_words() -> None:
    one = Misfit("D1", ("D1",), 12.3, 5.04)
    assert one.alone
    assert one.words.startswith("channel D1 reads +12 % against the model, 5.0 times")
    assert Misfit("west", ("D1", "D2"), -8.0, -6.0).words.startswith("group west reads -8 %")
