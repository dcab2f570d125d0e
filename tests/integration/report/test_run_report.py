"""The report of a run: all that the twin lived through, whatever that was."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.drawing.time_axis import spaced, thinned, time_axis
from rga.findings import schema as contract
from rga.findings.arrays import DiagnosisArrays
from rga.findings.schema import Cause, Findings, Unexplained
from rga.model import Model, read_model
from rga.quantities import number
from rga.records import Record
from rga.report.figures.of_run.contexts_over_time import out_of_range
from rga.report.figures.of_run.gap_map import MOST_CELLS, stretches
from rga.report.figures.of_run.run_gap import MOST_PHASES, phases, smoothed, standardised
from rga.report.pages.run_page import lived, run_page
from rga.report.pages.write import write_report, write_run_report
from rga.twin.history import Event, History, Version
from rga_bench.synthetic import draw_case

HOSTILE = "<script>alert('x')</script> $\\frac{a_b}$ & \"q\""
SPRING = {"kind": "support_spring", "support": "rocker", "dof": "ux", "stiffness": 2.4e7}
#: what a full report says somewhere
SAID = """120 rows | the gap left its band | w1, w4, w7 | 8.31 → 1.13 | version 2 | 130 [121, 138]
in force | 90 % interval | people on 1 row | What happened | The closing diagnosis
Provenance | grew to 2400 | 1 alarm | 2024-03-03 12:00:00 | beyond the model as given"""
WARNED = ["a warning of the diagnosis"]
FIGURES = {"Gap over time", "The structure and the gap", "Gap of", "Contexts", "Stored simulations"}


@pytest.fixture(scope="module")
def model() -> Model:
    """A footbridge with some of its displacements, tilts and gauges."""
    given = read_model(draw_case(1, bridge="footbridge", kind="null", rows=4).model, "case")
    return given.model_copy(update={"sensors": dict(list(given.sensors.items())[::3])})


def made_history(
    model: Model, rows: int = 120, start: str | float = "2024-03-01T00:00:00"
) -> History:
    """A run with an alarm half way, a new version soon after, and nothing but noise otherwise."""
    random = np.random.default_rng(0)
    sensors, contexts = tuple(model.sensors), tuple(name for name in model.context if name != "air")
    noise = np.full(len(sensors), 0.1)
    residuals = 0.1 * random.standard_normal((rows, len(sensors)))
    off, mended = rows // 2, rows // 2 + rows // 10
    residuals[off:mended, :3] += 0.9
    simulated = random.standard_normal(residuals.shape)
    time = 3600.0 * np.arange(rows)
    form: Any = "iso" if isinstance(start, str) else "seconds"
    air = 20.0 * np.sin(time / 1e5)
    record = Record(time, start, form, sensors, simulated + residuals, {"air": air})
    middle = np.array([np.mean(model.context[name].range) for name in contexts])
    inferred = middle + 0.01 * random.standard_normal((rows, len(contexts)))
    inferred[-1, 0] = 99.0

    gain: Any = (129.7, (121.0, 138.0))

    def event(kind: Any, row: int, words: str, **more: Any) -> Event:
        return Event(kind, row, record.time_label(3600.0 * row), words, **more)

    return History(
        model,
        record,
        "C",
        rows // 5,
        contexts,
        inferred,
        np.full(inferred.shape, 0.05),
        simulated,
        residuals**2,
        noise,
        (
            event("calibration", rows // 5, "calibrated"),
            event("novel context", rows // 4, "a crowd as never before"),
            event("alarm", off, "the gap left its band", sensors=sensors[:3]),
            event("version", mended, "a spring at the rocker", gap_before=8.31, gap_after=1.13),
        ),
        (
            Version(1, 0, record.time_label(0.0), (), None, None, False),
            Version(2, mended, event("version", mended, "").time, ("a spring",), *gain, True),
        ),
        ((0, 2000, 0), (rows // 4, 2400, 400)),
    )  # fmt: skip


def test_gaps_in_words_are_those_of_the_events(model: Model) -> None:
    history = made_history(model)
    calibrated = float(np.median(standardised(history)[: history.calibration_rows].mean(axis=1)))
    said = lived(history)
    assert f"The gap was {number(calibrated)} on the rows of the calibration" in said
    assert "at the end" not in said
    late = replace(history.events[-1], row=len(history.record) - 1)
    said = lived(replace(history, events=(*history.events[:-1], late)))
    assert "on the last rows as they came in, 1.13 after the version at the end;" in said


def test_what_people_asked_for_stands_in_a_table_of_its_own(model: Model) -> None:
    history = made_history(model)
    words = [f"Ada asked to note: noted, {number}" for number in range(30)]
    more = [Event("command", 60, history.events[2].time, one) for one in words]
    page = run_page(replace(history, events=(*history.events, *more)), closing(history))
    assert [one["words"] for one in page["asked"]] == words
    assert page["events"] == run_page(history, closing(history))["events"]
    assert run_page(history, closing(history))["asked"] == []


def closing(history: History, **changes: Any) -> Findings:
    """A diagnosis of the run that named a spring."""
    record = history.record
    noise = np.broadcast_to(history.noise, record.readings.shape)
    content: dict[str, Any] = {
        "verdict": "named",
        "gap": contract.Gap(
            before=8.0,
            after=1.1,
            held_out=contract.HeldOut(before=8.2, after=1.2, gain=7.0, gain_ci90=(6.0, 8.0)),
            by_sensor={name: contract.SensorGap(before=8.0, after=1.1) for name in record.sensors},
        ),
        "causes": [Cause(effect=SPRING, status="named", log_odds=90, d_prime=12, d_perp=8)],
        "unexplained": Unexplained(share=0.02, looks_like=""),
        "seed": 1,
        "model_sha256": "a" * 64,
        "record_sha256": "b" * 64,
    }
    findings = Findings(**(content | changes))
    findings._account = DiagnosisArrays(
        history.model,
        history.model,
        record,
        np.arange(len(record)) % 5 == 4,
        np.zeros(len(record.sensors), dtype=bool),
        np.nan_to_num(history.simulated),
        np.nan_to_num(history.simulated),
        history.noise,
        noise,
    )
    return findings


class Reader(HTMLParser):
    """Tags and text of a page, what its figures show, and what is fetched from elsewhere."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.figures: list[str] = []
        self.fetched: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        for name, value in attrs:
            if tag == "svg" and name == "aria-label":
                self.figures.append(str(value))
            if name in ("src", "href", "xlink:href") and not str(value).startswith(
                ("#", "data:text/csv")
            ):
                self.fetched.append(str(value))

    def handle_data(self, data: str) -> None:
        self.text += data

    def figures_of_the_run(self) -> set[str]:
        return {begin for begin in FIGURES if any(said.startswith(begin) for said in self.figures)}


def read(history: History, directory: Path, **changes: Any) -> tuple[Reader, str]:
    path = write_run_report(history, closing(history, **changes), directory / "report.html")
    html = path.read_text(encoding="utf-8")
    reader = Reader()
    reader.feed(html)
    reader.text = reader.text.replace("\u00a0", " ")
    return reader, html


@pytest.fixture(scope="module")
def full(model: Model, tmp_path_factory: pytest.TempPathFactory) -> tuple[Reader, str, Path]:
    """The report of a run, and its folder."""
    folder = tmp_path_factory.mktemp("full")
    return *read(made_history(model), folder, warnings=WARNED), folder


def test_report_says_all_and_fetches_nothing(full: tuple[Reader, str, Path]) -> None:
    reader, html, folder = full
    assert not reader.fetched
    assert "script" not in reader.tags
    assert reader.figures_of_the_run() == FIGURES
    for words in re.split(r" \| |\n", SAID):
        assert words in reader.text
    assert WARNED[0] in reader.text
    assert any("alarm at 2024-03-03T12:00:00" in said for said in reader.figures)
    # Lanes of the figure name what happened; contexts that were measured are not drawn.
    for lane in ("alarm", "new version", "novel context", "rows of the calibration"):
        assert f">{lane}<" in html
    assert "air [" not in reader.text
    assert [path.name for path in folder.iterdir()] == ["report.html"]


def test_the_diagnosis_is_reported_as_without_a_run(
    model: Model, full: tuple[Reader, str, Path], tmp_path: Path
) -> None:
    findings = closing(made_history(model), warnings=WARNED)
    alone = write_report(findings, tmp_path / "alone.html").read_text(encoding="utf-8")
    _, html, _ = full
    start = "<section>\n<h2>Causes</h2>"
    assert alone[alone.index(start) :] == html[html.index(start) :]
    assert "The run" not in alone


def test_report_is_the_same_twice(
    model: Model, full: tuple[Reader, str, Path], tmp_path: Path
) -> None:
    assert read(made_history(model), tmp_path, warnings=WARNED)[1] == full[1]


def test_hostile_names_stay_text(model: Model, tmp_path: Path) -> None:
    sensors = {f"{HOSTILE}{n}": sensor for n, sensor in enumerate(model.sensors.values())}
    sensors["\ud800 名 \n$x^{"] = next(iter(model.sensors.values()))
    context = {HOSTILE: model.context["people"], "air": model.context["air"]}
    hostile = model.model_copy(update={"sensors": sensors, "context": context, "name": HOSTILE})
    history = made_history(hostile)
    events = tuple(replace(one, words=HOSTILE, sensors=(HOSTILE,)) for one in history.events)
    versions = tuple(replace(one, causes=(HOSTILE,)) for one in history.versions)
    history.record.warnings.append(HOSTILE)
    reader, html = read(replace(history, events=events, versions=versions), tmp_path)
    assert "script" not in reader.tags
    assert "<script" not in html
    assert reader.text.count(HOSTILE) > len(events) + len(versions)


@pytest.mark.parametrize(
    ("rows", "start"),
    [
        (1, "2024-03-01T00:00:00+01:00"),
        pytest.param(2, 0.0, marks=pytest.mark.thorough),
        (9000, "2024-03-01"),
    ],
)
def test_any_number_of_rows(model: Model, tmp_path: Path, rows: int, start: str | float) -> None:
    reader, html = read(made_history(model, rows, start), tmp_path)
    assert reader.figures_of_the_run() == FIGURES
    assert len(html) < 2_000_000


def test_a_record_without_rows(model: Model, tmp_path: Path) -> None:
    history = made_history(model)
    nothing = np.zeros((0, len(history.record.sensors)))
    empty = replace(
        history,
        record=history.record.rows(slice(0)),
        calibration_rows=0,
        inferred=np.zeros((0, len(history.contexts))),
        spread=np.zeros((0, len(history.contexts))),
        simulated=nothing,
        gaps=nothing,
        events=(),
        growth=(),
    )
    reader, _ = read(empty, tmp_path)
    assert not reader.figures_of_the_run()
    assert "Nothing happened to the twin" in reader.text


def test_a_quiet_run(model: Model, tmp_path: Path) -> None:
    history = made_history(model)
    none = np.zeros((len(history.record), 0))
    quiet = replace(
        history, level="A", contexts=(), inferred=none, spread=none, events=(),
        versions=history.versions[:1], growth=(),
    )  # fmt: skip
    reader, html = read(quiet, tmp_path)
    assert "It saw no alarm." in reader.text
    assert "Nothing happened to the twin." in reader.text
    assert "in force" not in reader.text
    assert ">alarm<" not in html
    assert reader.figures_of_the_run() == {"Gap over time", "The structure and the gap", "Gap of"}


def test_columns_without_values(model: Model, tmp_path: Path) -> None:
    history = made_history(model)
    gaps, inferred, spread = history.gaps.copy(), history.inferred.copy(), history.spread.copy()
    gaps[:, :2] = np.nan
    inferred[:, 0], spread[:, 1] = np.nan, np.nan
    reader, _ = read(replace(history, gaps=gaps, inferred=inferred, spread=spread), tmp_path)
    assert reader.figures_of_the_run() == FIGURES
    drawn = next(said for said in reader.figures if said.startswith("Contexts"))
    assert history.contexts[0] not in drawn
    assert history.contexts[1] in drawn
    nowhere = replace(history, gaps=np.full_like(gaps, np.nan))
    reader, _ = read(nowhere, tmp_path)
    assert reader.figures_of_the_run() == {"Contexts", "Stored simulations"}
    assert any(said.startswith("Events of the run") for said in reader.figures)


def test_sensors_without_noise_are_passed_over(model: Model) -> None:
    history = made_history(model)
    history.noise[:2] = 0.0, np.nan
    gaps = standardised(history)
    assert np.isnan(gaps[:, :2]).all()
    assert np.isfinite(gaps[:, 2:]).all()


def test_many_events_stand_on_few_lines(model: Model, tmp_path: Path) -> None:
    history = made_history(model, 2000)
    novel = tuple(replace(history.events[1], row=row, words=f"crowd {row}") for row in range(1500))
    reader, html = read(replace(history, events=(*history.events[2:], *novel)), tmp_path)
    assert "1500 novel contexts; the first: crowd 0" in reader.text
    assert "crowd 1" not in reader.text
    assert len(html) < 2_000_000


def test_phases_follow_the_events(model: Model) -> None:
    history = made_history(model)
    found = phases(history)
    assert [phase.title.split(" 2024")[0] for phase in found] == [
        "After calibration", "At the alarm of", "With version 2 from", "At the end",
    ]  # fmt: skip
    gaps = [np.nanmean(standardised(history)[phase.first : phase.last]) for phase in found]
    assert gaps[1] > 5 * max(gaps[0], gaps[2], gaps[3])
    alarm = history.events[2]
    many = replace(history, events=tuple(replace(alarm, row=row) for row in range(30, 110, 4)))
    assert len(phases(many)) == MOST_PHASES


def test_smoothing_stops_where_the_twin_changed(model: Model) -> None:
    history = made_history(model)
    mended = history.events[3].row
    by_row = np.where(np.arange(120) < mended, 10.0, 1.0)
    by_row[5] = np.nan
    np.testing.assert_allclose(smoothed(history, by_row)[[5, mended - 1, mended]], [10, 10, 1])


def test_the_map_keeps_means_and_holes(model: Model) -> None:
    history = made_history(model, 3000)
    gaps = standardised(history)
    gaps[:, 4] = np.nan
    edges, cells = stretches(gaps, time_axis(history.record))
    assert cells.size <= MOST_CELLS
    assert len(edges) == len(cells) + 1
    assert np.isnan(cells[:, 4]).all()
    np.testing.assert_allclose(cells[:, 0].mean(), gaps[:, 0].mean(), rtol=1e-9)


def test_thinning_keeps_peaks_and_spacing_keeps_the_ends() -> None:
    values = np.zeros(5000)
    values[[1234, 4321]] = 7.0, -7.0
    values[:100] = np.nan
    rows = thinned(values, 200)
    assert {1234, 4321} <= set(rows)
    assert len(rows) <= 200
    np.testing.assert_array_equal(spaced(5000, 3)[[0, -1]], [0, 4999])


def test_a_context_leaves_its_range_by_more_than_its_interval(model: Model) -> None:
    history = made_history(model)
    low, high = history.model.context[history.contexts[0]].range
    history.inferred[:, 0] = (low + high) / 2
    history.spread[:, 0] = 0.1 * (high - low)
    history.inferred[3, 0] = high + 0.1 * (high - low)
    history.inferred[5, 0] = low - 0.2 * (high - low)
    assert np.flatnonzero(out_of_range(history, 0)).tolist() == [5]
