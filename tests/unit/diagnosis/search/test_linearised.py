"""A record about a simulation: what is known of contexts beforehand, and units of what breaks."""

from dataclasses import replace

import numpy as np
import pytest

from rga import Simulator
from rga.diagnosis.preparation.prepare import prepare
from rga.diagnosis.preparation.sensor_faults.channel_prediction import own_parts
from rga.diagnosis.residuals.lack_of_fit import misfits
from rga.diagnosis.search.linearised import Problem, load_basis, pose
from rga_bench.faults.base import Base, Sound, load


@pytest.fixture(scope="module")
def sound() -> Sound:
    return load(Base("drawn-0", 100), 5)


def posed(sound: Sound, readings: np.ndarray | None = None) -> Problem:
    record = sound.record if readings is None else replace(sound.record, readings=readings)
    data = prepare(sound.model, record, lambda done: None).data
    return pose(Simulator(sound.model), data)


def test_contexts_are_as_uncertain_where_readings_are_missing(sound: Sound) -> None:
    """A gap in one channel takes nothing from how well the contexts are calibrated."""
    whole = np.where(np.isnan(sound.record.readings), 0.0, sound.record.readings)
    gap = sound.record.readings.copy()
    gap[20:45, 3] = np.nan
    effects = [posed(sound, readings).scatter.family for readings in (whole, gap)]
    assert (effects[0] < 0).any()
    assert len(effects[0]) == len(effects[1])


def test_a_group_that_reads_too_much_is_a_misfit_and_a_sound_one_is_none(sound: Sound) -> None:
    problem = posed(sound)
    strains = [n for n in problem.data.sensors if sound.model.sensors[n].kind == "strain"]
    groups = {"strains": strains}
    assert misfits(problem, problem.simulated, groups) == []
    columns = [problem.data.sensors.index(name) for name in strains]
    readings = problem.data.readings.copy()
    readings[:, columns] *= 1.3
    data = replace(problem.data, readings=readings)
    found = misfits(replace(problem, data=data), problem.simulated, groups)
    (group,) = [one for one in found if one.group == "strains"]
    assert group.percent == pytest.approx(30, abs=6)
    assert "+3" in group.words or "+2" in group.words


def test_what_one_channel_shows_alone_is_its_own_part(sound: Sound) -> None:
    problem = posed(sound)
    data, basis = problem.data, load_basis(problem.simulator, problem.data)
    rng = np.random.default_rng(3)
    rows, number = len(data.time), 4
    swing = rng.standard_normal(rows)
    noise = problem.noise.sigma

    def sizes(readings: np.ndarray) -> np.ndarray:
        parts = own_parts(
            sound.model, data.sensors, readings, data.observed, basis, problem.simulated
        )
        return parts.size

    assert (sizes(data.readings) < 2).all()
    alone = data.readings.copy()
    alone[:, number] += 8 * noise[number] * swing
    size = sizes(alone)
    assert size[number] > 3
    assert (np.delete(size, number) < 2).all()
    # What all channels do together is no fault of any.
    together = data.readings + 5 * noise * swing[:, None]
    assert (sizes(together) < 2).all()
