"""What infers contexts in a run: the joint posterior, networks, and the choice between them."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import rga
from rga.errors import InputError
from rga.inference import TrainingSettings
from rga.model import Model, read_effect, read_model
from rga.records import Record
from rga.twin import Settings
from rga.twin.calibration.blocks import BLOCK
from rga.twin.calibration.choice import choose
from rga.twin.calibration.expectation import usual_bound
from rga.twin.calibration.joint_posterior import JointEstimator, changes, why_not
from rga.twin.calibration.learning import learn, read, written
from rga.twin.calibration.lesson import Lesson
from rga.twin.calibration.networks import NetworkEstimator
from rga.twin.hardware.recorded import Recorded
from rga.twin.messages.queries import Q3, R4, Box, sha256
from rga.twin.simulation_model import SimulationModel

Stream = Callable[..., Path]
LATENT = ("west load", "east load")
TRAINING = TrainingSettings(
    steps=60, fine_steps=20, reduced_steps=60, width=24, features=8, reduced_width=24
)


class Drawn(NamedTuple):
    """A model and a record of it."""

    model: Model
    record: Record

    def lesson(self, rows: slice = slice(0, 40), model: Model | None = None) -> Lesson:
        """What an estimator learns from."""
        given = model or self.model
        station = Recorded(self.record, given).station
        simulation = SimulationModel(given, station)
        low, high = np.array([one.range for one in given.context.values()]).T.tolist()
        query = Q3(
            row=0, version=1, box=Box(low=tuple(low), high=tuple(high)), clock=0.0, rows=256,
            origin="design", seed=0,
        )  # fmt: skip
        drawn = simulation.draw(query)
        real, contexts = self.record.readings[rows], self.contexts[rows][:, :1]
        data = R4(
            row=0,
            simulation=simulation,
            contexts=drawn.contexts,
            readings=drawn.readings,
            falling=drawn.falling,
            real=real,
            real_contexts=contexts,
            simulated_rows=256,
            measured_rows=len(real),
            sha256=sha256(real),
        )
        noise = np.array([sensor.noise for sensor in given.sensors.values()], dtype=float)
        return Lesson(data, LATENT, noise, 0.0, 0, TRAINING, lambda done: None)

    @property
    def contexts(self) -> Any:
        """As they were measured, latent ones in the middle, float[rows, contexts]."""
        middle = np.array([np.mean(one.range) for one in self.model.context.values()])
        table = np.tile(middle, (len(self.record), 1))
        table[:, 0] = self.record.contexts["temperature"]
        return table

    def infer(self, estimator: Any, first: int, end: int) -> Any:
        laws = [self.model.context[name] for name in LATENT]
        seen = slice(0, end)
        return estimator.infer(
            first, self.record.readings[seen], self.contexts[seen], self.record.time[seen], laws
        )


@pytest.fixture(scope="module")
def drawn(small_stream: Stream) -> Drawn:
    """A heavy load comes in rows 60 to 89, 10 to 38 kN otherwise; nothing else changes."""
    folder = small_stream(sinks=False)
    model = rga.load_model(folder / "model.json")
    assert list(model.context) == ["temperature", *LATENT]
    return Drawn(model, rga.load_record(folder / "record.csv", model))


@pytest.fixture(scope="module")
def learned(drawn: Drawn) -> JointEstimator:
    return JointEstimator.learn(drawn.lesson())


@pytest.mark.parametrize("inference", ["joint", "networks", "amortised"])
@pytest.mark.parametrize("missing", [pytest.param(0.0, marks=pytest.mark.thorough), 0.1])
def test_packets_of_any_size_give_the_same_bits(
    drawn: Drawn, inference: Any, missing: float
) -> None:
    gone = np.random.default_rng(0).random(drawn.record.readings.shape) < missing
    gaps = replace(drawn.record, readings=np.where(gone, np.nan, drawn.record.readings))
    drawn = Drawn(drawn.model, gaps)
    whole = drawn.infer(learn(inference, drawn.lesson()), 0, 75)
    estimator = learn(inference, drawn.lesson())
    for size in (1, 7, 40):
        parts = [
            drawn.infer(estimator, first, min(first + size, 75)) for first in range(0, 75, size)
        ]
        for one, of_whole in zip(zip(*parts, strict=True), whole, strict=True):
            np.testing.assert_array_equal(np.concatenate(one), of_whole)


@pytest.mark.parametrize("inference", ["joint", "networks", "amortised"])
def test_what_is_stored_infers_the_same(drawn: Drawn, inference: Any) -> None:
    estimator = learn(inference, drawn.lesson())
    station = Recorded(drawn.record, drawn.model).station
    simulation = SimulationModel(drawn.model, station, estimator.correction)
    again = read(written(estimator), simulation)
    assert again.correction == estimator.correction
    for one, other in zip(drawn.infer(again, 30, 50), drawn.infer(estimator, 30, 50), strict=True):
        np.testing.assert_array_equal(one, other)
    assert written(again) == written(estimator)


@pytest.mark.parametrize("content", [b"", b"joint\nPK", b"joint\n\x80\x04N.", b"tree\n{}"])
def test_bytes_that_hold_no_estimator_are_refused(drawn: Drawn, content: bytes) -> None:
    station = Recorded(drawn.record, drawn.model).station
    with pytest.raises(InputError, match="these bytes hold no"):
        read(content, SimulationModel(drawn.model, station))


def test_the_twin_is_corrected_as_the_joint_posterior_has_it(
    drawn: Drawn, learned: JointEstimator
) -> None:
    station = Recorded(drawn.record, drawn.model).station
    simulation = SimulationModel(drawn.model, station, learned.correction)
    contexts, found = drawn.contexts[:5], learned.found
    expected = found.twin.simulate(contexts)
    np.testing.assert_allclose(
        simulation.readings(drawn.record.time[:5], contexts), expected, rtol=1e-10, atol=1e-12
    )
    bare = SimulationModel(drawn.model, station).readings(drawn.record.time[:5], contexts)
    assert np.abs(bare - expected).max() > 1e-4


def test_a_load_beyond_its_range_is_found_there(drawn: Drawn, learned: JointEstimator) -> None:
    """What no row explains inside the ranges is looked for outside; the rest stays inside."""
    low, _ = drawn.model.context["west load"].range
    narrow = drawn.model.context["west load"].model_copy(update={"range": (low, 60.0)})
    model = drawn.model.model_copy(update={"context": {**drawn.model.context, "west load": narrow}})
    estimator = JointEstimator.learn(Drawn(model, drawn.record).lesson(model=model))
    value, _ = drawn.infer(estimator, 0, 90)
    expected, _ = drawn.infer(learned, 0, 90)
    assert value[60:, 0].min() > 60.0
    assert np.abs(value[60:, 0] / expected[60:, 0] - 1).max() < 0.1
    assert value[:60, 0].max() <= 60.0


def test_a_channel_that_breaks_does_not_move_the_contexts(
    drawn: Drawn, learned: JointEstimator
) -> None:
    value, spread = drawn.infer(learned, 40, 60)
    broken = drawn.record.readings.copy()
    broken[45:, 2] += 30.0
    off = replace(drawn.record, readings=broken)
    again = JointEstimator.learn(drawn.lesson())
    moved, _ = Drawn(drawn.model, off).infer(again, 40, 60)
    assert (moved != value).any()
    assert (np.abs(moved - value) < 2 * spread).all()


def test_auto_takes_the_joint_posterior_and_says_why(drawn: Drawn) -> None:
    chosen = choose(drawn.lesson())
    assert chosen.inference == "joint"
    assert "predicts half of the channels" in chosen.words
    assert "8 rows held out" in chosen.words
    assert chosen.begun is not None
    assert 0.5 < chosen.optimism < 2.0


def _line(model: Model) -> Model:
    line = model.context["west load"].model_copy(update={"law": "linear"})
    return model.model_copy(update={"context": {**model.context, "west load": line}})


@pytest.mark.parametrize(
    ("change", "rows", "reason"),
    [
        (lambda model: model, 19, "19 rows are too few"),
        (_line, 40, "'west load' moves along a line"),
        (
            lambda model: model.with_sensors(dict(list(model.sensors.items())[:3])),
            40,
            "3 channels do not outnumber 2 contexts by far",
        ),
    ],
)
def test_where_the_joint_posterior_cannot_be_had_networks_are_taken(
    drawn: Drawn, change: Callable[[Model], Model], rows: int, reason: str
) -> None:
    model = change(drawn.model)
    record = replace(
        drawn.record,
        sensors=tuple(model.sensors),
        readings=drawn.record.readings[:, : len(model.sensors)],
    )
    lesson = Drawn(model, record).lesson(slice(0, rows))
    told = why_not(lesson)
    assert told is not None
    assert reason in told
    found = choose(lesson)
    assert found.inference == "networks"
    assert reason in found.words


def test_an_inference_that_cannot_be_had_is_refused(small_stream: Stream, tmp_path: Path) -> None:
    folder = small_stream(drifts=False, sinks=False)
    content = json.loads((folder / "model.json").read_text(encoding="utf-8"))
    content["context"]["west load"] |= {"law": "linear", "rate": [0.0, 1.0]}
    model = read_model(content, "small bridge")
    wanted = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    settings = Settings.model_validate({**wanted, "inference": "joint"})
    record = rga.load_record(folder / "record.csv", model)
    with pytest.raises(InputError, match="take 'auto' or 'networks'"):
        rga.run(model, record, tmp_path, settings=settings)


def test_what_has_changed_is_said(drawn: Drawn, learned: JointEstimator) -> None:
    """A gauge whose zero moves by far, and the null twin, where nothing does."""
    assert changes(None, learned.found) == ()
    later = drawn.lesson(slice(40, 60))
    assert changes(learned.found, learned.refined(later).found) == ()
    moved = later.data.real.copy()
    moved[:, 6] += 30.0
    data = later.data.model_copy(update={"real": moved})
    name = list(drawn.model.sensors)[6]
    told = changes(learned.found, learned.refined(replace(later, data=data)).found)
    assert any(one.startswith(f"zero of {name} +") for one in told)


def test_a_gap_is_usual_only_as_far_as_the_calibration_has_it() -> None:
    draw = np.random.default_rng(0)
    calm = 1.0 + 0.1 * draw.standard_normal(160)
    # Stretches vary less the longer they are.
    assert 1.0 < usual_bound(calm, 60, 0.99, 0) < usual_bound(calm, 10, 0.99, 0) < 1.2
    assert usual_bound(np.full(160, np.nan), 10, 0.99, 0) == float("inf")
    # Rows that are alike come together.
    slow = 1.0 + 0.3 * np.sin(np.arange(160) / 25)
    assert usual_bound(slow, 30, 0.99, 0) > 1.2


def test_rows_without_readings_change_nothing(drawn: Drawn, learned: JointEstimator) -> None:
    outage = drawn.lesson(slice(40, 60))
    data = outage.data.model_copy(update={"real": np.full_like(outage.data.real, np.nan)})
    assert learned.refined(replace(outage, data=data)) is learned


@pytest.mark.parametrize("silent", [slice(None), slice(4, None, 5)])
def test_networks_learn_where_no_row_can_judge_them(drawn: Drawn, silent: slice) -> None:
    """Rows without readings, all of them or the very ones that might have been held out."""
    lesson = drawn.lesson(slice(0, 20))
    real = lesson.data.real.copy()
    real[silent] = np.nan
    rows = replace(lesson, data=lesson.data.model_copy(update={"real": real}))
    learned = NetworkEstimator.learn(rows)
    for one in (learned, learned.refined(rows)):
        value, spread = drawn.infer(one, 0, 20)
        assert np.isfinite(value).all()
        assert np.isfinite(spread).all()


def test_a_silent_channel_hides_no_change(small_stream: Stream, learned: JointEstimator) -> None:
    """A bearing is 2 mm lower from row 105 on, and one gauge has gone silent since."""
    folder = small_stream(drifts=False)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model)
    silent = record.readings.copy()
    silent[105:, 5] = np.nan
    later = Drawn(model, replace(record, readings=silent)).lesson(slice(105, 140))
    refined = learned.refined(later)
    (first, *_) = changes(learned.found, refined.found)
    assert first.startswith("settlement of east -2 mm")
    # What was found of the gauge is kept for its return.
    name = list(model.sensors)[5]
    assert refined.correction.gains[name] == pytest.approx(learned.correction.gains[name], rel=1e-3)


@pytest.mark.parametrize("when", [slice(0, 32), slice(32, 40)])
def test_a_choice_stands_channels_that_say_nothing(drawn: Drawn, when: slice) -> None:
    """A gauge that is silent in some rows, and one in units of its own."""
    lesson = drawn.lesson()
    real = lesson.data.real.copy()
    real[when, 4] = np.nan
    real[:, 6] = 1e7
    chosen = choose(replace(lesson, data=lesson.data.model_copy(update={"real": real})))
    assert chosen.inference == "joint"
    assert np.isfinite(chosen.optimism)
    learn("joint", lesson, begun=chosen.begun)


def test_a_choice_without_rows_to_hold_out_is_finite(drawn: Drawn) -> None:
    lesson = drawn.lesson(slice(0, 24))
    real = lesson.data.real.copy()
    real[np.arange(24) // 4 % 5 == 4] = np.nan
    chosen = choose(replace(lesson, data=lesson.data.model_copy(update={"real": real})))
    assert np.isfinite(chosen.optimism)


def test_a_version_that_remembers_stands_on_the_structure_as_found(
    drawn: Drawn, learned: JointEstimator
) -> None:
    drift = {"kind": "sensor_drift", "sensor": list(drawn.model.sensors)[4], "rate": 3.0}
    model = drawn.model.extended({"drift": read_effect(drift, "drift")})
    lesson = drawn.lesson(model=model)
    assert "remembers" in str(why_not(lesson, learned.found))
    estimator = learn("joint", lesson, earlier=learned.found)
    assert estimator.kind == "amortised"
    assert estimator.correction == learned.correction
    assert estimator.refined(lesson).correction == learned.correction


def test_a_zero_of_the_logger_is_that_of_the_model_as_given(
    drawn: Drawn, learned: JointEstimator
) -> None:
    """Whatever a calibration corrects, the zero that it has put back stays."""
    station = replace(
        Recorded(drawn.record, drawn.model).station,
        zero={"time": np.zeros(3), "temperature": np.full(3, 12.0)},
    )
    given = SimulationModel(drawn.model, station)
    corrected = SimulationModel(drawn.model, station, learned.correction)
    clock, contexts = np.zeros(1), drawn.contexts[:1]
    np.testing.assert_array_equal(given.zero(clock, contexts), corrected.zero(clock, contexts))
    again = read(written(learned), corrected)
    assert again.correction == read(written(learned), given).correction


def test_a_model_that_cannot_be_calibrated_says_so_each_time(
    small_stream: Stream, tmp_path: Path
) -> None:
    stream = small_stream(drifts=False, sinks=False)
    content = json.loads((stream / "model.json").read_text(encoding="utf-8"))
    for sensor in content["sensors"].values():
        sensor["noise"] = 1e9
    model = read_model(content, "a model whose sensors see nothing")
    record = rga.load_record(stream / "record.csv", model)
    for _ in range(2):
        with pytest.raises(InputError, match="cannot represent what a calibration needs"):
            rga.run(model, record, tmp_path)


@pytest.mark.parametrize("law", ["smooth", pytest.param("constant", marks=pytest.mark.thorough)])
def test_few_rows_before_a_packet_tell_of_contexts_that_change_slowly(
    law: str, small_stream: Stream, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All of the past would be more with every row."""
    monkeypatch.setattr("rga.twin.calibration.followed_rows.LEAD", BLOCK)
    folder = small_stream(drifts=False, sinks=False)
    content = json.loads((folder / "model.json").read_text("utf-8"))
    content["context"]["west load"]["law"] = law
    seen, infer = [], JointEstimator.infer

    def watched(self: JointEstimator, first: int, readings: Any, *rest: Any) -> Any:
        seen.append(len(readings))
        return infer(self, first, readings, *rest)

    monkeypatch.setattr(JointEstimator, "infer", watched)
    kept = json.loads((folder / "settings.json").read_text("utf-8"))
    settings = Settings.model_validate(kept | {"inference": "joint", "level": "A"})
    rga.run(read_model(content, "slow"), folder / "record.csv", tmp_path, settings=settings)
    assert max(seen) <= 3 * BLOCK
