"""Records that were zeroed over some rows: what begins later, and the noise of the zero."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from findings_invariants import check_invariants
from rga import Findings, Simulator, diagnose, load_model, load_record
from rga.diagnosis.data.held_out import held_out_rows
from rga.diagnosis.data.observations import Data
from rga.diagnosis.preparation.prepare import prepare
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses
from rga.diagnosis.search.late_shares import OneBeginning
from rga.diagnosis.search.linearised import pose
from rga.diagnosis.search.screening import RankedSignatures
from rga.diagnosis.search.signatures import Block, signature
from rga.model import read_effect, read_model
from rga.records import Record, RecordMapping
from rga.records.zero import rows_within
from rga_bench.synthetic import Case, Conditions, draw_case

ROWS, LATE = 120, 72
#: first row of the zero and the row after its last: at the beginning, of two rows, in mid-record
LEAD_IN, SHORT, MIDDLE = (0, 12), (5, 7), (40, 48)
Span = tuple[int, int]
Zeroed = Callable[[Case, Span | None], Findings]
pytestmark = pytest.mark.filterwarnings("error::RuntimeWarning")


def thorough(value: Any) -> Any:
    """A value of a parameter that the thorough run looks at as well."""
    return pytest.param(value, marks=pytest.mark.thorough)


def drawn(seed: int, kind: str = "null") -> Case:
    return draw_case(
        seed,
        bridge="footbridge",
        kind=kind,
        reality="truss",
        rows=ROWS,
        conditions=Conditions(scatter=0.01),
        aims=(20.0, 40.0),
    )


def added(case: Case, name: str, size: float, row: int = LATE) -> Case:
    """The case with a column that reads more from a row on."""
    column = case.channels[name].copy()
    column[row:] += size
    return replace(case, channels={**case.channels, name: column})


def hidden(case: Case, effect: dict[str, Any]) -> Case:
    """The case with what an effect changes in a simulation added to its readings."""
    model = read_model(case.model, "footbridge")
    table = {"time": case.time, **{name: case.channels[name] for name in model.context}}
    other = model.extended({"hidden": read_effect(effect, "hidden")})
    change = Simulator(other).predict(table) - Simulator(model).predict(table)
    of_sensors = dict(zip(model.sensors, change.T, strict=True))
    return replace(case, channels={n: c + of_sensors.get(n, 0.0) for n, c in case.channels.items()})


def loaded(case: Case) -> Case:
    """The case with a dead load from a row on."""
    load = {"kind": "dead_load", "group": "deck chord", "force_per_length": 1500.0}
    return hidden(case, {**load, "onset": case.time[LATE]})


def record_of(case: Case, span: Span | None, folder: Path) -> tuple[Any, Record]:
    case.write(folder)
    model = load_model(folder / "model.json")
    elapsed = case.time - case.time[0]
    zero = None if span is None else (float(elapsed[span[0]]), float(elapsed[span[1] - 1]))
    return model, load_record(folder / "record.csv", model, RecordMapping(zero=zero))


@pytest.fixture(scope="module")
def zeroed(tmp_path_factory: pytest.TempPathFactory) -> Zeroed:
    """Diagnoses a case whose channels were set to zero over a span of rows."""

    def diagnosis(case: Case, span: Span | None) -> Findings:
        findings = diagnose(*record_of(case, span, tmp_path_factory.mktemp("case")))
        check_invariants(findings)
        return findings

    return diagnosis


def by_its_logger(case: Case, *spans: Span) -> Case:
    """The case as a logger zeroed it, channel by channel over one span or another.

    The model says which.
    """
    sensors, channels = {}, dict(case.channels)
    for number, (name, sensor) in enumerate(case.model["sensors"].items()):
        first, end = spans[number % len(spans)]
        channels[name] = channels[name] - np.nanmean(channels[name][first:end])
        zero = [float(case.time[first]), float(case.time[end - 1])]
        sensors[name] = {**sensor, "zero": zero}
    return replace(case, model={**case.model, "sensors": sensors}, channels=channels)


# --- What begins after the zero -------------------------------------------------------------------


@pytest.fixture(scope="module")
def healthy() -> Case:
    return drawn(1)


@pytest.mark.parametrize("span", [None, LEAD_IN, thorough(SHORT), MIDDLE])
def test_nothing_late_names_nothing(healthy: Case, span: Span | None, zeroed: Zeroed) -> None:
    findings = zeroed(healthy, span)
    assert findings.causes == []
    assert findings.verdict == "nothing_wrong"


@pytest.mark.parametrize("span", [thorough(SHORT), MIDDLE])
def test_a_late_offset_of_a_gauge(healthy: Case, span: Span, zeroed: Zeroed) -> None:
    (cause,) = zeroed(added(healthy, "g_deck2", 15.0), span).causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("sensor_bias", "g_deck2")
    assert cause.effect["offset"]["value"] == pytest.approx(15.0, abs=1.0)
    assert cause.onset == healthy.time[LATE]


@pytest.mark.parametrize("span", [thorough(None), LEAD_IN])
def test_a_jump_of_a_gauge_is_no_loss_of_a_member(
    healthy: Case, span: Span | None, zeroed: Zeroed
) -> None:
    (cause,) = zeroed(added(healthy, "g_deck4", 150.0), span).causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("sensor_bias", "g_deck4")
    assert cause.effect["offset"]["value"] == pytest.approx(150.0, abs=3.0)


def test_zeros_that_the_model_states(healthy: Case, zeroed: Zeroed) -> None:
    spans = LEAD_IN, MIDDLE
    assert zeroed(by_its_logger(healthy, *spans), None).verdict == "nothing_wrong"
    (cause,) = zeroed(by_its_logger(added(healthy, "g_deck2", 15.0), *spans), None).causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("sensor_bias", "g_deck2")
    assert cause.effect["offset"]["value"] == pytest.approx(15.0, abs=1.0)
    (cause,) = zeroed(by_its_logger(loaded(healthy), *spans), None).causes
    assert cause.effect["kind"] in ("dead_load", "context_bias", "unmodelled_load")
    assert cause.onset == healthy.time[LATE]


def test_what_begins_among_held_out_rows_is_no_gap(healthy: Case, zeroed: Zeroed) -> None:
    """In which of these rows it began no fitted row tells, and none of them is held against it."""
    held_out = held_out_rows(ROWS)
    begun = next(row for row in range(LATE, ROWS) if held_out[row] and not held_out[row - 1])
    findings = zeroed(added(healthy, "g_deck2", 60.0, begun), None)
    (cause,) = findings.causes
    assert cause.onset > healthy.time[begun]
    assert cause.onset_ci90[0] <= healthy.time[begun] <= cause.onset_ci90[1]
    assert findings.gap.held_out.after < 1.5


def test_a_late_settlement(zeroed: Zeroed) -> None:
    case = drawn(1, "support_settlement")
    (cause,) = zeroed(case, SHORT).causes
    assert cause.effect["kind"] == "support_settlement"
    assert {name: cause.effect[name] for name in case.truth["place"]} == case.truth["place"]
    assert cause.onset == case.truth["onset"]


@pytest.mark.parametrize("span", [LEAD_IN, thorough(MIDDLE)])
def test_a_late_dead_load(healthy: Case, span: Span, zeroed: Zeroed) -> None:
    (cause,) = zeroed(loaded(healthy), span).causes
    # More people all the time are the same.
    named = [cause.effect, *cause.rivals]
    assert ("dead_load", "deck chord") in [(one["kind"], one.get("group")) for one in named]
    assert {one["kind"] for one in named} <= {"dead_load", "context_bias", "unmodelled_load"}
    assert cause.onset == healthy.time[LATE]


@pytest.mark.parametrize("span", [thorough(LEAD_IN), SHORT])
def test_a_late_bias_of_a_context(healthy: Case, span: Span, zeroed: Zeroed) -> None:
    (cause,) = zeroed(added(healthy, "air", 6.0), span).causes
    assert (cause.effect["kind"], cause.effect["context"]) == ("context_bias", "air")
    assert cause.effect["offset"]["value"] == pytest.approx(6.0, abs=0.5)


# --- The noise of the zero ------------------------------------------------------------------------


@pytest.mark.parametrize("seed", [2, thorough(3), thorough(5)])
def test_a_zero_of_two_rows_is_no_cause(seed: int, zeroed: Zeroed) -> None:
    findings = zeroed(drawn(seed), (0, 2))
    assert findings.causes == []
    assert findings.verdict == "nothing_wrong"


def test_the_zero_is_taken_over_all_rows_of_its_interval(healthy: Case, tmp_path: Path) -> None:
    channel = healthy.channels["w3"].copy()
    channel[2:5] = np.nan
    model, record = record_of(
        replace(healthy, channels={**healthy.channels, "w3": channel}), LEAD_IN, tmp_path
    )
    assert rows_within(record.time, record.zero).tolist() == list(range(12))
    data = prepare(model, record, lambda done: None).data
    counts = dict(zip(data.sensors, data.tare.counts[data.columns], strict=True))
    assert (counts["w2"], counts["w3"]) == (12, 9)
    # The mean of a channel is that of the rows in which it has a reading.
    simulated = Simulator(model).predict(data.belief.table)[:, data.columns]
    seen = np.isfinite(record.readings[:12, record.sensors.index("w3")])
    number = data.sensors.index("w3")
    expected = simulated[:, number] - simulated[:12, number][seen].mean()
    np.testing.assert_allclose(data.predict(Simulator(model))[:, number], expected, atol=1e-9)


def test_what_the_zero_is_off_is_what_its_rows_are(healthy: Case, tmp_path: Path) -> None:
    """Over 400 records of pure noise, the means that are taken off scatter as the budget says."""
    model, record = record_of(healthy, SHORT, tmp_path)
    data = prepare(model, record, lambda done: None).data
    problem = pose(Simulator(model), data)
    sigma, phi = problem.noise.sigma, problem.noise.phi
    draw = np.random.default_rng(0)
    first = draw.standard_normal((400, len(sigma))) * sigma
    then = phi * first + np.sqrt(1 - phi**2) * sigma * draw.standard_normal(first.shape)
    spread = ((first + then) / 2).std(0)
    # Noise of contexts adds to it.
    assert (np.sqrt(problem.zero_variance) > 0.85 * spread).all()
    untared = pose(
        Simulator(model), prepare(*record_of(healthy, None, tmp_path), lambda done: None).data
    )
    assert not untared.zero_variance.any()


# --- Signatures -----------------------------------------------------------------------------------


def chosen(data: Data, model: Any, kind: str, **place: Any) -> Hypothesis:
    every = hypotheses(model, data.sensors, ["air", "people"])
    return next(
        one for one in every if one.name == kind and {**one.place, **place} == dict(one.place)
    )


KINDS: list[tuple[str, dict[str, Any]]] = [
    ("sensor_bias", {"sensor": "g_deck4"}),
    ("support_settlement", {"support": "rocker", "dof": "uz"}),
    ("dead_load", {"group": "deck chord"}),
    ("context_bias", {"context": "air"}),
    ("sensor_gain", {"sensor": "w3"}),
]


@pytest.mark.parametrize("span", [None, LEAD_IN, MIDDLE])
@pytest.mark.parametrize(("kind", "place"), KINDS)
def test_a_late_signature_is_what_the_simulation_changes(
    span: Span | None, kind: str, place: dict[str, Any], healthy: Case, tmp_path: Path
) -> None:
    """Whether the effect begins before, within or after the zero, at once or growing."""
    model, record = record_of(healthy, span, tmp_path)
    data = prepare(model, record, lambda done: None).data
    base = Simulator(model)
    before = data.predict(base)
    one = chosen(data, model, kind, **place)
    z = tuple(prior.trials[0] for prior in one.priors.values())
    for row in (4, 43, 80):
        for profile in ("step", "ramp"):
            late = one.beginning(float(data.time[row]), profile)
            found = signature(data, data.about(base), 0, late, z)
            assert found is not None
            exact = data.predict(base.extended({"late": late.effect(z)})) - before
            numbers = slice(None) if found.channels is None else found.channels
            scale = np.abs(exact).max()
            assert scale > 0
            np.testing.assert_allclose(found.values.T, exact[:, numbers], atol=1e-6 * scale)


@pytest.mark.parametrize("span", [None, LEAD_IN, SHORT])
@pytest.mark.parametrize(("kind", "place"), KINDS[:4])
def test_the_size_of_a_late_beginning(
    span: Span | None, kind: str, place: dict[str, Any], healthy: Case, tmp_path: Path
) -> None:
    """What screening takes from the rows of one signature is near its size under the covariance."""
    model, record = record_of(healthy, span, tmp_path)
    data = prepare(model, record, lambda done: None).data
    base = Simulator(model)
    problem = pose(base, data)
    one = chosen(data, model, kind, **place)
    z = tuple(prior.trials[0] for prior in one.priors.values())
    always = signature(data, data.about(base), 0, one, z)
    assert always is not None
    judged = RankedSignatures.of(Block.of([always]), problem.covariance)
    weighted = problem.covariance.inverse_times(problem.residual(problem.simulated))
    along = np.stack([judged.block.along(weighted), judged.block.zero_along(weighted)])
    for row in (30, 60, 90):
        weight = OneBeginning((np.arange(ROWS) >= row).astype(float))
        (sums,), (sizes,) = judged.begun(along, weight, np.zeros(1))
        late = signature(data, data.about(base), 0, one.beginning(float(data.time[row])), z)
        assert late is not None
        block = Block.of([late])
        exact = problem.covariance.squares(problem.covariance.reduce(block.values, block.channels))
        assert sums[0] == pytest.approx(block.along(weighted).sum(), rel=1e-3, abs=1e-3)
        assert 0.4 < sizes[0] / exact[0] < 2.5


# --- Zeros that nobody declared -------------------------------------------------------------------

OWN, ANEW = "start from zeros of their own", "all channels read zero again from"
AGAIN = 45


def sensors_of(case: Case) -> dict[str, float]:
    return {name: sensor["noise"] for name, sensor in case.model["sensors"].items()}


def from_anywhere(case: Case) -> Case:
    """The case as a logger without a tare shows it: every channel from a value of its own."""
    draw = np.random.default_rng(1)
    start = {name: 300 * noise * draw.standard_normal() for name, noise in sensors_of(case).items()}
    return replace(case, channels={n: c + start.get(n, 0.0) for n, c in case.channels.items()})


def zeroed_again(case: Case) -> Case:
    """The case as a logger shows it that is zeroed anew on one row."""
    channels = {name: column.copy() for name, column in case.channels.items()}
    for name in sensors_of(case):
        channels[name][AGAIN:] -= channels[name][AGAIN]
    return replace(case, channels=channels)


def warnings_of(case: Case, folder: Path) -> list[str]:
    """What is said of the zeros of a record that declares none."""
    model, record = record_of(case, None, folder)
    return prepare(model, record, lambda done: None).warnings


@pytest.mark.parametrize("spoilt", [from_anywhere, zeroed_again])
def test_undeclared_zeros_are_reported_and_name_nothing(
    spoilt: Callable[[Case], Case], healthy: Case, zeroed: Zeroed
) -> None:
    word = OWN if spoilt is from_anywhere else ANEW
    findings = zeroed(spoilt(healthy), None)
    assert (findings.causes, findings.verdict) == ([], "nothing_wrong")
    assert sum(word in warning for warning in findings.warnings) == 1
    (cause,) = zeroed(spoilt(added(healthy, "g_deck2", 15.0)), None).causes
    assert (cause.effect["kind"], cause.effect["sensor"]) == ("sensor_bias", "g_deck2")


@pytest.mark.parametrize(
    "effect",
    [
        {"kind": "support_settlement", "support": "rocker", "dof": "uz", "displacement": -0.02},
        {"kind": "dead_load", "group": "deck chord", "force_per_length": 3000.0},
        {"kind": "context_bias", "context": "air", "offset": 15.0},
        {"kind": "sensor_bias", "sensor": "w3", "offset": 30.0},
    ],
)
def test_offsets_that_one_cause_makes_are_no_zeros(
    effect: dict[str, Any], healthy: Case, tmp_path: Path
) -> None:
    assert warnings_of(hidden(healthy, effect), tmp_path) == []
    assert warnings_of(hidden(healthy, {**effect, "onset": healthy.time[LATE]}), tmp_path) == []


def test_few_channels_that_are_off_are_no_zeros_of_all(healthy: Case, tmp_path: Path) -> None:
    assert warnings_of(healthy, tmp_path) == []
    few = dict.fromkeys(list(sensors_of(healthy))[:5], 30.0)
    apart = {n: c + few.get(n, 0.0) for n, c in healthy.channels.items()}
    assert warnings_of(replace(healthy, channels=apart), tmp_path) == []
