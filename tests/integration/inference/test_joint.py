"""Contexts and unknowns together: what is hidden in the structure is found, and nothing else."""

import json
from pathlib import Path

import numpy as np
import pytest

from plane_models import drawn, measured, noise_of
from rga.arrays import FloatArray
from rga.errors import InputError
from rga.inference import Rows, Unknowns, infer_jointly
from rga.inference.joint.structural_parameters import GROUP
from rga.inference.map.identifiability import BLIND, unseen_share
from rga.inference.map.posterior_mode import posterior_mode
from rga.inference.map.standard_units import standard
from rga.model import Model, read_model, write_model
from rga.simulation import Simulator
from rga_bench.synthetic.bridges.case_study import case_study_bridge


def error(model: Model, found: FloatArray, truth: FloatArray) -> float:
    _, scale = standard(np.array([one.range for one in model.context.values()]))
    return float((((found - truth) / scale) ** 2).mean())


def test_unknowns_and_contexts_are_found_without_a_label(model: Model, other: Model) -> None:
    contexts, unknowns = drawn(model, 60, 1), Unknowns(model)
    readings, noise = measured(other, contexts, 2), noise_of(model)
    found = infer_jointly(unknowns, readings, noise, drawn(model, 300, 3))
    names = [part.name for part in unknowns.parts]
    chord = found.values[names.index("stiffness of bottom chord")]
    assert -0.2 < 10**chord - 1 < -0.08
    twin = Simulator(model)
    alone = posterior_mode(
        lambda c: twin.predict(dict(zip(model.context, c.T, strict=True))),
        lambda c: twin.jacobian(dict(zip(model.context, c.T, strict=True))),
        readings,
        np.diag(noise**2),
        np.array([one.range for one in model.context.values()]),
        np.tile(unknowns_middle(model), (len(readings), 1)),
    )
    assert error(model, found.rows.contexts, contexts) < 0.5 * error(model, alone.value, contexts)
    left = readings - found.twin.simulate(found.rows.contexts)
    assert np.sqrt((left**2).mean()) < 0.03


def unknowns_middle(model: Model) -> FloatArray:
    return np.mean([one.range for one in model.context.values()], axis=1)


def test_where_nothing_is_hidden_nothing_is_found(model: Model) -> None:
    unknowns = Unknowns(model)
    pins = unknowns.centre.copy()
    pins[["bending" in part.name for part in unknowns.parts]] = -2.0
    contexts = drawn(model, 60, 4)
    found = infer_jointly(
        unknowns, measured(unknowns.at(pins), contexts, 5), noise_of(model), drawn(model, 300, 6)
    )
    stiffness = [part.name.startswith("stiffness") for part in unknowns.parts]
    assert np.abs(found.values[stiffness]).max() < 0.06
    assert np.abs(found.gains - 1.0).max() < 0.02
    assert np.sqrt(found.variance.mean()) < 0.023


def test_load_tests_make_it_surer_and_are_the_only_labels(model: Model, other: Model) -> None:
    contexts, unknowns = drawn(model, 40, 7), Unknowns(model)
    readings, noise, source = measured(other, contexts, 8), noise_of(model), drawn(model, 300, 9)
    labelled = drawn(model, 20, 10)
    tests = Rows(labelled, measured(other, labelled, 11))
    without = infer_jointly(unknowns, readings, noise, source)
    beside = infer_jointly(unknowns, readings, noise, source, load_tests=tests)
    assert np.trace(beside.uncertainty) < np.trace(without.uncertainty)
    again = infer_jointly(unknowns, readings, noise, source)
    np.testing.assert_array_equal(without.values, again.values)


def test_missing_readings_are_left_out(model: Model, other: Model) -> None:
    contexts, unknowns = drawn(model, 40, 12), Unknowns(model)
    readings = measured(other, contexts, 13)
    readings[::3, 4] = np.nan
    found = infer_jointly(unknowns, readings, noise_of(model), drawn(model, 300, 14))
    assert np.isfinite(found.values).all()
    assert error(model, found.rows.contexts, contexts) < 0.2


@pytest.mark.parametrize("happened", [True, False])
def test_what_has_happened_since_is_found(model: Model, other: Model, happened: bool) -> None:
    """A support settles and a sensor lies; or nothing happens, and nothing is found."""
    unknowns, noise, source = Unknowns(model), noise_of(model), drawn(model, 300, 19)
    first = infer_jointly(unknowns, measured(other, drawn(model, 80, 20), 21), noise, source)
    settled, liar = [part.name for part in unknowns.parts].index("settlement of east"), 7
    values = first.values.copy()
    values[settled] = -0.004 * happened
    contexts = drawn(model, 30, 22)
    recent = measured(other, contexts, 23)
    table = dict(zip(model.context, contexts.T, strict=True))
    at = Simulator(unknowns.at(values)).predict(table)
    before = Simulator(unknowns.at(first.values)).predict(table)
    recent += happened * (at - before)
    recent[:, liar] += 0.5 * happened
    found = infer_jointly(unknowns, recent, noise, source, prior=first)
    moved = found.values[settled] - first.values[settled]
    assert moved == pytest.approx(-0.004 * happened, abs=3e-4)
    offset = found.offsets - first.offsets
    assert offset[liar] == pytest.approx(0.5 * happened, abs=0.02)
    assert np.abs(np.delete(offset, liar)).max() < 0.02
    assert error(model, found.rows.contexts, contexts) < 0.1
    if happened:
        alone = infer_jointly(unknowns, recent, noise, source, start=first)
        assert error(model, found.rows.contexts, contexts) < error(
            model, alone.rows.contexts, contexts
        )


def test_a_crowd_beyond_its_range_makes_no_structure_softer(model: Model, other: Model) -> None:
    """Rows that lay at the end of the range would have to be explained by the structure."""
    unknowns, noise, source = Unknowns(model), noise_of(model), drawn(model, 300, 29)
    ordinary = drawn(model, 80, 30)
    readings = measured(other, ordinary, 31)
    first = infer_jointly(unknowns, readings, noise, source)
    crowded = drawn(model, 50, 32)
    crowded[:, 0] = np.linspace(4.2, 5.5, 50)
    later = infer_jointly(unknowns, measured(other, crowded, 33), noise, source, prior=first)
    before, after = (one.infer(readings).value[:, 0] for one in (first, later))
    assert np.median(after / before) == pytest.approx(1.0, abs=0.02)
    found = later.infer(measured(other, crowded, 33))
    assert np.median(found.value[:, 0] / before.mean()) > 4.0 / before.mean()
    off = measured(other, crowded, 33) - later.twin.simulate(found.value)
    assert np.sqrt((off**2).mean()) < 0.03


def test_derivatives_are_those_of_the_readings(model: Model) -> None:
    contexts, unknowns = drawn(model, 6, 15), Unknowns(model)
    values = unknowns.centre + 0.3 * unknowns.spread
    here, by_contexts, by_unknowns = unknowns.linearise(contexts, values)
    table = dict(zip(model.context, contexts.T, strict=True))
    np.testing.assert_allclose(here, Simulator(unknowns.at(values)).predict(table), atol=1e-9)
    for number in range(len(values)):
        step = 1e-4 * unknowns.spread[number] * (np.arange(len(values)) == number)
        ahead, behind = (unknowns.linearise(contexts, values + way * step)[0] for way in (1, -1))
        slope = (ahead - behind) / (2.0 * step[number])
        np.testing.assert_allclose(
            by_unknowns[:, :, number], slope, atol=1e-5 + 1e-4 * np.abs(slope).max()
        )
    assert by_contexts.shape == (*here.shape, 4)


@pytest.mark.parametrize("moved", [0.5, 0.0])
def test_the_model_with_its_unknowns_is_a_model_file(
    model: Model, tmp_path: Path, moved: float
) -> None:
    unknowns = Unknowns(model)
    extended = unknowns.at(unknowns.centre + moved * unknowns.spread)
    write_model(extended, tmp_path / "model.json")
    again = read_model(json.loads((tmp_path / "model.json").read_text()), "again")
    table = dict(zip(model.context, drawn(model, 5, 16).T, strict=True))
    np.testing.assert_array_equal(
        Simulator(again).predict(table), Simulator(extended).predict(table)
    )


def test_a_context_that_no_sensor_sees_is_reported(model: Model) -> None:
    contexts, noise = drawn(model, 50, 17), noise_of(model)
    seen = unseen_share(Simulator(model), contexts, noise)
    assert seen[0] < 0.1
    deaf = unseen_share(Simulator(model), contexts, 1e6 * noise)
    assert (deaf > BLIND).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"readings": np.zeros((3, 2))}, "readings have the shape"),
        ({"readings": np.full((3, 24), np.nan)}, "no row to infer from"),
        ({"readings": np.full((3, 24), "loud")}, "readings are no numbers"),
        ({"readings": [[1.0, 2.0], [3.0]]}, "readings are no numbers"),
        ({"readings": np.full((3, 24), 1j)}, "readings are no numbers"),
        ({"readings": np.full((3, 24), -999.0)}, "'U0 z' reads -999, and the model simulates"),
        ({"noise": np.zeros(24)}, "noise of the sensors"),
        ({"noise": np.full(24, np.inf)}, "noise of the sensors"),
        ({"noise": 0.3}, "noise of the sensors"),
        ({"prior": "yesterday's"}, "earlier result is not of this model"),
        ({"source": np.full((3, 4), np.inf)}, "source are not all finite"),
        ({"load_tests": Rows(np.zeros((2, 4)), np.zeros((3, 24)))}, "3 rows of readings and 2"),
    ],
)
def test_bad_input_gets_one_clear_error(
    model: Model, change: dict[str, object], message: str
) -> None:
    assert len(model.sensors) == 24
    given = {
        "readings": np.zeros((3, 24)),
        "noise": noise_of(model),
        "source": drawn(model, 5, 18),
        **change,
    }
    with pytest.raises(InputError, match=message):
        infer_jointly(Unknowns(model), **given)  # type: ignore[arg-type]


def test_a_model_without_contexts_or_with_its_unknowns_is_refused(model: Model) -> None:
    silent = model.model_copy(update={"context": {}, "effects": {}})
    with pytest.raises(InputError, match="no context to infer"):
        infer_jointly(Unknowns(silent), np.zeros((3, 24)), noise_of(model), np.zeros((3, 0)))
    unknowns = Unknowns(model)
    with pytest.raises(InputError, match="holds unknowns already"):
        Unknowns(unknowns.at(unknowns.centre))


def test_intervals_of_other_rows_hold_their_contexts(model: Model, other: Model) -> None:
    noise, source = noise_of(model), drawn(model, 300, 27)
    given = measured(other, drawn(model, 80, 28), 29).tolist()
    found = infer_jointly(Unknowns(model), given, noise, source)
    contexts = drawn(model, 60, 30)
    readings = measured(other, contexts, 31)
    readings[0] = np.nan
    mode = found.infer(readings)
    held = np.abs(mode.value - contexts) <= 1.645 * mode.spread
    assert held[1:].mean() > 0.8
    _, scale = standard(np.array([one.range for one in model.context.values()]))
    assert (mode.spread[1:].mean(axis=0) < 0.5 * scale).any()
    # A row without readings is as unsure as before.
    np.testing.assert_allclose(mode.spread[0], scale, rtol=0.2)
    with pytest.raises(InputError, match="readings have the shape"):
        found.infer(readings[:, :3])


def test_intervals_hold_contexts_of_structures_as_the_priors_say(model: Model) -> None:
    unknowns, noise, source = Unknowns(model), noise_of(model), drawn(model, 300, 27)
    held = []
    for seed in range(5):
        away = np.random.default_rng(seed).standard_normal(len(unknowns.centre))
        values = unknowns.centre + unknowns.spread * away
        built = unknowns.at(np.clip(values, unknowns.low, unknowns.high))
        rows = measured(built, drawn(model, 80, 40 + seed), 50 + seed)
        contexts = drawn(model, 60, 60 + seed)
        found = infer_jointly(unknowns, rows, noise, source)
        mode = found.infer(measured(built, contexts, 70 + seed))
        held.append(np.abs(mode.value - contexts) <= 1.645 * mode.spread)
    assert 0.85 < np.mean(held) < 0.97


def test_days_without_crowds_leave_the_structure_as_it_is(model: Model) -> None:
    """Contexts that fill a small part of their ranges are no sign of a stiffer structure."""
    low, high = np.array([one.range for one in model.context.values()]).T
    contexts = low + (high - low) * (0.1 + 0.2 * (drawn(model, 160, 80) - low) / (high - low))
    unknowns = Unknowns(model)
    readings = measured(model, contexts, 81)
    found = infer_jointly(unknowns, readings, noise_of(model), drawn(model, 300, 82))
    stiffness = [k for k, part in enumerate(unknowns.parts) if part.name.startswith("stiffness")]
    # How stiff all of it is, and how large all loads are, no row tells apart: the prior does.
    assert np.abs(10.0 ** found.values[stiffness] - 1.0).max() < 2 * GROUP
    crowd = found.rows.contexts[:, 0] / contexts[:, 0]
    assert np.median(crowd) == pytest.approx(1.0, abs=2 * GROUP)


def test_a_dead_sensor_says_nothing_and_no_row_is_an_answer(model: Model) -> None:
    rows, source = measured(model, drawn(model, 60, 93), 94), drawn(model, 300, 95)
    rows[:, 4] = np.nan
    found = infer_jointly(Unknowns(model), rows, noise_of(model), source)
    assert found.gains[4] == pytest.approx(1.0, abs=1e-6)
    assert found.infer(np.zeros((0, 24))).value.shape == (0, 4)


def test_a_group_in_the_middle_of_a_bridge_is_one_unknown() -> None:
    """The bridge of the case study: trusses on both sides, cross beams between them."""
    unknowns = Unknowns(read_model(case_study_bridge().model, "case study"))
    assert len(set(unknowns.names)) == len(unknowns.names)
    assert unknowns.names.count("stiffness of cross beams") == 1


def test_an_earlier_result_is_taken_in_one_way(model: Model) -> None:
    given = np.zeros((3, 24)), noise_of(model), drawn(model, 40, 24)
    unknowns = Unknowns(model)
    first = infer_jointly(unknowns, measured(model, drawn(model, 20, 25), 26), *given[1:])
    with pytest.raises(InputError, match="both the start and the prior"):
        infer_jointly(unknowns, *given, start=first, prior=first)


@pytest.mark.parametrize(
    "fault",
    [
        pytest.param("three times as much", marks=pytest.mark.thorough),
        "other sign",
        pytest.param("off later on", marks=pytest.mark.thorough),
        "noise",
    ],
)
def test_a_broken_sensor_spoils_nothing(model: Model, other: Model, fault: str) -> None:
    contexts, noise, source = drawn(model, 60, 96), noise_of(model), drawn(model, 300, 97)
    rows = measured(other, contexts, 98)
    sensor = int(np.argsort(rows.std(axis=0))[-2])
    broken = {
        "three times as much": 3.0 * rows[:, sensor],
        "other sign": -rows[:, sensor],
        "off later on": rows[:, sensor] + np.repeat([0.0, 100.0 * noise[sensor]], 30),
        "noise": rows[:, sensor] + 2.0 * np.random.default_rng(99).standard_normal(60),
    }[fault]
    spoilt = rows.copy()
    spoilt[:, sensor] = broken
    with_it, sound = (
        infer_jointly(Unknowns(model), one, noise, source).rows.contexts for one in (spoilt, rows)
    )
    assert error(model, with_it, contexts) < 1.5 * error(model, sound, contexts)
