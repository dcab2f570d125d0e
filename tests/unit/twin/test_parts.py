"""The parts of the twin: messages, the exchange, T2, what gap to expect."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import read_model
from rga.records import Record
from rga.twin.calibration.channel_noise import noise_of
from rga.twin.calibration.expectation import against_expected, scatter_share
from rga.twin.digital_twin import DigitalTwin
from rga.twin.hardware.interface import Packet, Station
from rga.twin.hardware.recorded import Recorded
from rga.twin.messages.queries import Q1, Q2, Q3, Q5, R1, R5, Box, read_message, sha256
from rga.twin.novelty import novel, spacing
from rga.twin.rows.recent import KEPT, RecentRows, Stretch
from rga.twin.settings import Settings
from rga.twin.state import TwinState, follow
from rga.twin.sync.window_rule import WindowRule
from rga.twin.versions import first_row_under


def record(model: dict[str, Any], rows: int = 5, **more: Any) -> Record:
    sensors = tuple(model["sensors"])
    readings = np.zeros((rows, len(sensors)))
    return Record(600.0 * np.arange(rows), 0.0, "seconds", sensors, readings, **more)


def station(model: dict[str, Any], **more: Any) -> Station:
    return Recorded(record(model, **more), read_model(model, "test")).station


def first_question(place: Station, **more: Any) -> Q1:
    return Q1(row=0, channels=place.channels, measured=place.measured, **more)


@pytest.mark.parametrize(
    ("onsets", "first"), [([], None), ([None], None), ([1200.0], 2), ([1200.0, 2500.0, None], 5)]
)
def test_a_version_stands_from_the_last_of_its_causes_on(
    onsets: list[float | None], first: int | None
) -> None:
    effects = {f"cause {number}": {"onset": onset} for number, onset in enumerate(onsets)}
    assert first_row_under(effects, 10, lambda row: 600.0 * row) == first


def test_messages_come_back_from_the_log() -> None:
    query = Q2(row=3, version=1, box=Box(low=(0.0, 1.0), high=(2.0, 3.0)), wanted=5)
    body = query.model_dump(mode="json")
    kind, row = body.pop("kind"), body.pop("row")
    assert read_message(kind, row, body) == query


@pytest.mark.parametrize(
    "wrong",
    [
        {"box": {"low": [1.0], "high": [0.0]}},
        {"box": {"low": [0.0], "high": [float("nan")]}},
        {"box": {"low": [0.0], "high": [1.0, 2.0]}},
        {"version": 0},
        {"wanted": -1},
        {"colour": "red"},
    ],
)
def test_messages_are_validated(wrong: dict[str, Any]) -> None:
    body = {"version": 1, "box": {"low": [0.0], "high": [1.0]}, "wanted": 5}
    assert isinstance(read_message("Q2", 0, body), Q2)
    with pytest.raises(ValidationError):
        read_message("Q2", 0, body | wrong)


def test_a_question_asks_one_change_only(small_bridge: dict[str, Any]) -> None:
    with pytest.raises(ValidationError, match="one at a time"):
        first_question(station(small_bridge), effects={}, restore=1)


def test_the_twin_says_what_it_can_represent(small_bridge: dict[str, Any]) -> None:
    place = station(small_bridge, contexts={"temperature": np.zeros(5)})
    twin = DigitalTwin(read_model(small_bridge, "test"), place)
    answer = twin.answer(first_question(place))
    assert isinstance(answer, R1)
    assert answer.adequate
    assert (answer.version, answer.latent) == (1, ("west load", "east load"))
    # An answer alone changes nothing.
    assert twin.state == TwinState()
    twin.accept(answer)
    assert twin.state.version == 1


def test_a_model_that_cannot_represent_the_contexts_is_refused(
    small_bridge: dict[str, Any],
) -> None:
    """Two latent loads on a bridge whose only sensor hangs on an unloaded bar."""
    sensor = {"S": {"kind": "strain", "member": "L2-U2", "unit": "microstrain", "noise": 1.0}}
    blind = {**small_bridge, "sensors": sensor}
    place = station(blind, contexts={"temperature": np.zeros(5)})
    answer = DigitalTwin(read_model(blind, "test"), place).answer(first_question(place))
    assert isinstance(answer, R1)
    assert not answer.adequate
    assert answer.missing == ("a sensor that sees west load or east load",)


def test_an_update_that_does_not_fit_is_refused(small_bridge: dict[str, Any]) -> None:
    place = station(small_bridge, contexts={"temperature": np.zeros(5)})
    twin = DigitalTwin(read_model(small_bridge, "test"), place)
    twin.accept(twin.answer(first_question(place)))
    for effect in ({"kind": "sensor_bias", "sensor": "D9", "offset": 1.0}, {"kind": "magic"}):
        answer = twin.answer(first_question(place, effects={"wrong": effect}))
        assert isinstance(answer, R1)
        assert not answer.adequate
        twin.accept(answer)
    assert twin.state.version == 1


def test_versions_come_and_go_by_responses(small_bridge: dict[str, Any]) -> None:
    place = station(small_bridge, contexts={"temperature": np.zeros(5)})
    twin = DigitalTwin(read_model(small_bridge, "test"), place)
    bias = {"bias": {"kind": "sensor_bias", "sensor": "D1", "offset": 1.0}}
    for change in ({}, {"effects": bias}, {"restore": 1}):
        twin.accept(twin.answer(first_question(place, **change)))
    assert twin.state.version == 1
    assert twin.state.versions == {1: {}, 2: bias}
    assert list(twin.model(2).effects)[-1] == "bias"
    answer = twin.answer(first_question(place, restore=7))
    assert isinstance(answer, R1)
    assert answer.missing == ("there is no version 7",)


def test_a_context_brings_what_the_model_simulates(small_bridge: dict[str, Any]) -> None:
    place = station(small_bridge, contexts={"temperature": np.zeros(5)})
    twin = DigitalTwin(read_model(small_bridge, "test"), place)
    twin.accept(twin.answer(first_question(place)))
    contexts = np.array([[20.0, 50.0, 10.0], [20.0, 0.0, 0.0]])
    query = Q5(
        row=1, version=1, first=0, rows=2, sha256=sha256(contexts), time=np.array([0.0, 600.0]),
        contexts=contexts, time_before=np.zeros(0), contexts_before=np.zeros((0, 3)),
    )  # fmt: skip
    answer = twin.answer(query)
    assert isinstance(answer, R5)
    table = dict(zip(small_bridge["context"], contexts.T, strict=True))
    expected = twin.simulation().simulator.predict(table)
    np.testing.assert_allclose(answer.simulated, expected, rtol=1e-12)
    twin.accept(answer)
    assert twin.state.row == 1
    assert twin.state.context == {"temperature": 20.0, "west load": 0.0, "east load": 0.0}
    assert twin.state.simulated["D1"] == pytest.approx(expected[1, 0])


def test_simulations_are_relative_to_the_unloaded_rows(small_bridge: dict[str, Any]) -> None:
    """Where the logger took the lead-in off every channel, the twin does the same."""
    warm = {"temperature": np.full(5, 25.0)}
    plain, zeroed = (
        DigitalTwin(
            read_model(small_bridge, "test"), station(small_bridge, contexts=warm, zero=zero)
        )
        for zero in (None, (0.0, 1200.0))
    )
    box = Box(low=(25.0, 0.0, 0.0), high=(25.0, 100.0, 100.0))
    query = Q3(row=0, version=1, box=box, clock=0.0, rows=4, origin="design", seed=1)
    drawn = []
    for twin in (plain, zeroed):
        twin.accept(twin.answer(first_question(twin.station)))
        drawn.append(twin.answer(query))
    rest = plain.simulation().simulator.predict(
        {"temperature": 25.0, "west load": 50.0, "east load": 50.0}
    )
    # The unloaded contexts are not known: latent ones are taken in the middle of their range.
    np.testing.assert_allclose(drawn[1].readings, drawn[0].readings - rest, atol=1e-9)


def test_the_zero_of_the_model_is_that_of_the_station(small_bridge: dict[str, Any]) -> None:
    """A logger that zeroed its channels itself, as the model says, is one that the record tells."""
    warm = {"temperature": np.full(5, 25.0)}
    zeroed = station(small_bridge, contexts=warm, zero=(0.0, 1200.0))
    stated = {n: {**one, "zero": [0.0, 1200.0]} for n, one in small_bridge["sensors"].items()}
    same = {**small_bridge, "sensors": stated}
    assert station(same, contexts=warm).to_json() == zeroed.to_json()
    query = first_question(zeroed)
    simulations = []
    for model in (small_bridge, same):
        twin = DigitalTwin(read_model(model, "test"), zeroed)
        twin.accept(twin.answer(query))
        contexts = np.tile([25.0, 50.0, 50.0], (2, 1))
        simulations.append(twin.simulation().readings(np.array([600.0, 2400.0]), contexts))
    np.testing.assert_array_equal(*simulations)
    first = next(iter(stated))
    mixed = {**same, "sensors": {**stated, first: small_bridge["sensors"][first]}}
    with pytest.raises(InputError, match="zeroed over different times"):
        station(mixed, contexts=warm)


def test_follow_ignores_a_refusal() -> None:
    refusal = R1(
        row=0, version=2, effects={}, adequate=False, missing=("x",), latent=(), blind=()
    )  # fmt: skip
    assert follow(TwinState(), refusal, ()) == TwinState()


def test_only_credible_and_distinct_contexts_are_novel() -> None:
    contexts = np.array([[0.5], [2.0], [2.01], [3.0], [9.0]])
    gaps = np.array([[1.0], [1.0], [1.0], [50.0], [np.nan]])
    found = novel(
        gaps,
        contexts,
        bound=np.array([2.2]),
        stored=np.array([[0.4], [0.6]]),
        width=np.ones(1),
        distinct=0.3,
    )
    # Row 0 is known, 2 repeats 1, the gap of 3 is not credible, 4 has none.
    assert found == [1]


def test_spacing_is_that_of_neighbours() -> None:
    grid = np.linspace(0.0, 10.0, 11)[:, None]
    assert spacing(grid, np.array([10.0])) == pytest.approx(0.1)
    assert spacing(grid[:1], np.array([10.0])) == 0.0


def test_heavy_loads_are_no_drift() -> None:
    """A model that is 3 % off everywhere has large gaps under large loads, and is in order."""
    draw = np.random.default_rng(0)
    noise = np.full(20, 0.1)
    quiet, heavy = draw.normal(0, 5, (200, 20)), draw.normal(0, 50, (50, 20))

    def gaps(simulated: np.ndarray) -> np.ndarray:
        off = 0.03 * simulated * draw.choice([-1, 1], simulated.shape)
        return (off + noise * draw.standard_normal(simulated.shape)) ** 2

    share = scatter_share(gaps(quiet), quiet, noise)
    assert share == pytest.approx(0.03, rel=0.25)
    assert against_expected(gaps(heavy), heavy, noise, 0.0) > 50
    assert against_expected(gaps(heavy), heavy, noise, share) < 1.6
    moved = (np.sqrt(gaps(quiet)) + 10 * noise) ** 2
    assert against_expected(moved, quiet, noise, share) > 5


def test_noise_is_estimated_where_it_is_not_stated() -> None:
    draw = np.random.default_rng(1)
    slow = np.sin(np.arange(4000) / 300)[:, None] * [10.0, 10.0]
    readings = slow + draw.normal(0, [0.2, 0.2], (4000, 2))
    readings[7, 1] = np.nan
    both = np.array([False, False])
    np.testing.assert_allclose(noise_of([0.5, None], readings, both), [0.5, 0.2], rtol=0.05)
    stuck = np.array([False, True])
    np.testing.assert_array_equal(noise_of([0.5, 0.1], readings, stuck), [0.5, np.nan])


def test_missing_contexts_are_carried_on_from_packet_to_packet() -> None:
    nan = np.nan
    measured = np.array([[nan, 1.0], [5.0, nan], [nan, 3.0], [nan, nan], [6.0, nan]])
    told = [[nan, 1], [5, 1], [5, 3], [5, 3], [6, 3]]
    for cuts in ([], [1], [2, 3], [1, 2, 3, 4]):
        ledger = RecentRows(1, 2, 2, nothing_stored)
        for first, end in pairwise([0, *cuts, 5]):
            time = np.arange(float(first), end)
            ledger.append(Packet(first, time, np.zeros((end - first, 1)), measured[first:end]))
        np.testing.assert_array_equal(ledger.rows(0, 5).told, told)
        np.testing.assert_array_equal(ledger.rows(0, 5).measured, measured)


def nothing_stored(first: int, end: int) -> Stretch:
    raise AssertionError(f"rows {first} to {end} are in memory")


@pytest.mark.parametrize("packet", [7, 600, 5000])
def test_rows_are_the_same_in_memory_and_where_they_are_stored(packet: int) -> None:
    count = 5000
    draw = np.random.default_rng(1)
    whole = Stretch.empty(count, 3, 1, 2)
    whole.time[:], whole.readings[:] = np.arange(count), draw.random((count, 3))
    whole.measured[:] = whole.told[:] = draw.random((count, 1))
    asked: list[tuple[int, int]] = []

    def stored(first: int, end: int) -> Stretch:
        asked.append((first, end))
        return whole[first:end]

    ledger = RecentRows(3, 1, 2, stored)
    for first in range(0, count, packet):
        part = whole[first : first + packet]
        ledger.append(Packet(first, part.time, part.readings, part.measured))
        part.contexts[:], part.spread[:], part.simulated[:] = first, 0.1, 0.5
        ledger.followed(first, part.contexts, part.spread, part.simulated)
    assert not asked
    for first, end in ((0, count), (10, 20), (count - KEPT, count), (100, count - 5), (3, 3)):
        rows, expected = ledger.rows(first, end), whole[first:end]
        for name in vars(expected):
            np.testing.assert_array_equal(getattr(rows, name), getattr(expected, name), name)
    np.testing.assert_array_equal(ledger.gaps(100, 1000), (whole.readings[100:1000] - 0.5) ** 2)
    whole.simulated[4000:] = 0.25
    ledger.followed(
        4000, *(getattr(whole, one)[4000:] for one in ("contexts", "spread", "simulated"))
    )
    np.testing.assert_array_equal(ledger.rows(3990, count).simulated, whole.simulated[3990:])
    again = RecentRows(3, 1, 2, stored)
    again.take_up(count, count)
    np.testing.assert_array_equal(again.residuals(0, count), ledger.residuals(0, count))
    assert (0, count) not in asked


def test_the_window_survives_a_restart() -> None:
    residuals = np.random.default_rng(2).random((300, 3))
    residuals[200:, 1] -= 6

    def read(first: int, end: int) -> FloatArray:
        return residuals[first:end]

    channels, settings = ("D1", "D2", "D3"), Settings(window=50)
    whole = WindowRule(channels, settings)
    whole.begin_again(0, 50, read)
    split = WindowRule(channels, settings)
    split.begin_again(0, 50, read)
    assert split.alarm(50, 202, read) is None
    resumed = WindowRule(channels, settings)
    resumed.restore(split.to_bytes())
    found = resumed.alarm(202, 300, read)
    assert found is not None
    assert found == whole.alarm(50, 300, read)
    assert (found.row, found.since, found.sensors) == (204, 199, ("D2",))
    assert resumed.to_bytes() == whole.to_bytes()
