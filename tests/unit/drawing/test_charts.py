"""Plots and tables of records, findings, plans and runs."""

from typing import Any, Literal

import matplotlib
import numpy as np
import polars as pl
import pytest
from matplotlib.figure import Figure

from made_findings import cause, findings
from rga.drawing.charts import plot_pairs
from rga.errors import InputError
from rga.findings import Findings
from rga.model import Model, read_model
from rga.planning.result import Plan
from rga.records import Record
from rga.twin.history import Event, History
from rga.twin.outcome import Outcome

matplotlib.use("Agg")


def record(start: str | float = 0.0, rows: int = 5) -> Record:
    readings = np.column_stack([np.arange(rows, dtype=float), np.full(rows, np.nan)])
    clock: Literal["iso", "seconds"] = "iso" if isinstance(start, str) else "seconds"
    air = {"<air>": np.linspace(-5.0, 20.0, rows)}
    return Record(1800.0 * np.arange(rows, dtype=float), start, clock, ("D1", "S1"), readings, air)


def a_plan() -> Plan:
    test = {"words": "a truck at midspan", "position": 3.0, "contexts": {}, "against": {},
            "cost": 1.0, "tells": []}  # fmt: skip
    simulated = {"draws": 10, "won": 1.0, "clearly": 0.9}
    separation = {"one": "sinks: 1 mm", "other": "slips", "d_perp": 4.0, "expected": 0.9,
                  "d_perp_at_best": 6.0, "separated": True, "simulated": simulated}  # fmt: skip
    return Plan.model_validate(
        {"sentence": "Test <it>.", "tests": [test], "separations": [separation], "budget": {},
         "seed": 0, "model_sha256": "", "findings_sha256": ""}
    )  # fmt: skip


def a_run(of: Record, model: Model) -> Outcome:
    rows = len(of)
    gaps = np.ones((rows, 2))
    gaps[:, 1] = np.nan
    event = Event("alarm", 3, 0.0, "something moved")
    return Outcome(
        findings(),
        History(
            model, of, "B", 2, ("air",), np.full((rows, 1), 3.0), np.ones((rows, 1)),
            np.zeros((rows, 2)), gaps, np.array([0.5, 1.0]), (event,), (), (),
        ),
    )  # fmt: skip


def gapped() -> Findings:
    low = {"kind": "support_settlement", "support": "east", "dof": "uz"}
    low["displacement"] = {"value": -0.002, "ci90": [-0.003, -0.001]}  # type: ignore[assignment]
    made = findings(cause(low, {"kind": "sensor_bias", "sensor": "S1", "bias": 1.0}))
    sensors = {"D1": {"before": 9.0, "after": 1.1}, "S1": {"before": 1.0, "after": 0.0}}
    content = made.model_dump(mode="json")
    content["gap"]["by_sensor"] = sensors
    return Findings.model_validate(content)


class TestTables:
    def test_members_of_a_model(self, two_bars: dict[str, Any]) -> None:
        frame = read_model(two_bars, "two bars").to_frame()
        assert frame.columns[:5] == ["member", "kind", "from", "to", "length"]
        assert frame["member"].to_list() == list(two_bars["members"])
        assert frame["E"].to_list() == [2e11, 2e11]

    def test_a_record_keeps_its_clock(self) -> None:
        dated = record("2024-03-31T00:30:00+05:30").to_frame()
        assert str(dated["time"][1]) == "2024-03-31 01:00:00"
        assert record(60.0).to_frame()["time"].to_list()[:2] == [60.0, 1860.0]
        assert dated.columns == ["time", "D1", "S1", "<air>"]
        assert record(rows=0).to_frame().height == 0
        assert record("2024-03-31", rows=0).to_frame().height == 0

    def test_causes_plans_and_runs(self, two_bars: dict[str, Any]) -> None:
        causes = gapped().to_frame()
        assert causes.row(0)[0] == "support_settlement"
        assert causes["rivals"].to_list() == [1]
        assert findings().to_frame().schema["log_odds"] == pl.Float64
        assert a_plan().to_frame()["words"].to_list() == ["a truck at midspan"]
        run = a_run(record(), read_model(two_bars, "two bars")).to_frame()
        assert run.columns == ["time", "gap", "air"]
        assert run["gap"].to_list() == [4.0] * 5

    def test_in_a_notebook_names_are_escaped(self, two_bars: dict[str, Any]) -> None:
        model = read_model({**two_bars, "name": "<b>&"}, "bars")
        for one in (model, record(), gapped(), a_plan(), a_run(record(), model)):
            html = one._repr_html_()  # type: ignore[attr-defined]
            assert len(html) < 5000
            assert "<air>" not in html
            assert "<it>" not in html
            assert "<b>&<" not in html
        assert "&lt;b&gt;&amp;" in model._repr_html_()


class TestPlots:
    def test_a_record_has_a_strip_a_channel(self) -> None:
        axes = Figure().subplots()
        assert record("2024-03-31").plot(axes) is axes
        names = [text.get_text() for text in axes.get_yticklabels()]
        assert names == ["D1  0 to 4", "S1  no value", "<air>  \N{MINUS SIGN}5 to 20"]
        one = record().plot(Figure().subplots(), ["D1"])
        assert one.get_lines()[0].get_ydata().tolist() == [0, 1, 2, 3, 4]  # type: ignore[union-attr]

    def test_channels_and_rows_must_be_there(self) -> None:
        with pytest.raises(InputError, match=r"no channel 'D9'.*it has D1, S1"):
            record().plot(Figure().subplots(), ["D9"])
        with pytest.raises(InputError, match="nothing to draw"):
            record(rows=0).plot(Figure().subplots())

    def test_findings_plans_and_runs_have_plots(self, two_bars: dict[str, Any]) -> None:
        axes = gapped().plot(Figure().subplots())
        assert [text.get_text() for text in axes.get_yticklabels()] == ["D1", "S1"]
        assert axes.get_lines()[0].get_xdata().tolist() == [9.0, 1.0]  # type: ignore[union-attr]
        names = a_plan().plot(Figure().subplots()).get_yticklabels()
        assert [text.get_text() for text in names] == ["sinks | slips"]
        run = a_run(record(), read_model(two_bars, "two bars")).plot(Figure().subplots())
        assert [line.get_label() for line in run.get_lines()[1:]] == ["alarm"]

    def test_of_many_things_the_first_are_drawn_and_it_is_said(self) -> None:
        names = [f"S{k}" for k in range(100)]
        axes = plot_pairs(names, np.ones(100), np.ones(100), ("one", "two"), "gap",
                          Figure().subplots())  # fmt: skip
        assert axes.get_title(loc="left") == "the first 60 of 100"
