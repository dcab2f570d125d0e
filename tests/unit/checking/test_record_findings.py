"""Every check of a record: a case in which it speaks, and its twin in which it is silent."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rga.checking import CheckResult, check
from rga.model import Model, read_model
from rga.records import Record

Making = Callable[..., Record]
Change = Callable[[Record], Record]


def readings(record: Record, sensor: str, change: Callable[[Any], Any]) -> Record:
    """The record with a changed channel."""
    values = record.readings.copy()
    number = record.sensors.index(sensor)
    values[:, number] = change(values[:, number])
    return replace(record, readings=values)


def context(record: Record, name: str, change: Callable[[Any], Any]) -> Record:
    """The record with a changed context."""
    return replace(record, contexts={**record.contexts, name: change(record.contexts[name].copy())})


def at(rows: Any, value: float) -> Callable[[Any], Any]:
    def change(column: Any) -> Any:
        column[rows] = value
        return column

    return change


def later(record: Record, row: int, by: float) -> Record:
    """The record with a gap."""
    return replace(record, time=record.time + by * (np.arange(len(record)) >= row))


def every(change: Callable[[Any], Any], *sensors: str) -> Change:
    def changed(record: Record) -> Record:
        for name in sensors or record.sensors:
            record = readings(record, name, change)
        return record

    return changed


OFFSETS = np.array([9.0, -5.0, 8.0, 300.0, -200.0, 250.0])
#: case -> change, severity, parts of the finding
SAID: dict[str, tuple[Change, str, list[str]]] = {
    "a gap": (lambda r: later(r, 100, 9000.0), "note", ["1 gap", "9600 s", "row 100"]),
    "a large gap": (lambda r: later(r, 100, 1e6), "warning", ["1 gap", "row 100"]),
    "steps that vary": (
        lambda r: replace(r, time=r.time + 250.0 * (np.arange(len(r)) % 2)),
        "note",
        ["of the steps differ from"],
    ),
    "too short": (lambda r: r.rows(slice(0, 8)), "error", ["8 rows"]),
    "few rows": (lambda r: r.rows(slice(0, 40)), "note", ["40 rows"]),
    "some missing": (
        lambda r: readings(r, "S", at(slice(0, 200, 10), np.nan)),
        "note",
        ["sensor 'S'", "10% of 'S'"],
    ),
    "many missing": (
        lambda r: readings(r, "S", at(slice(0, 200, 2), np.nan)),
        "warning",
        ["sensor 'S'", "50% of 'S'"],
    ),
    "a context missing": (
        lambda r: context(r, "wind", at(slice(0, 200, 2), np.nan)),
        "warning",
        ["context 'wind'", "left aside"],
    ),
    "a channel that ends": (
        lambda r: readings(r, "V", at(slice(150, None), np.nan)),
        "warning",
        ["have no reading from some row on", "V"],
    ),
    "rows again": (
        lambda r: replace(
            r,
            readings=np.concatenate([r.readings[:100], r.readings[50:80], r.readings[130:]]),
        ),
        "warning",
        ["30 rows", "to the last digit"],
    ),
    "a code": (
        lambda r: readings(r, "T", at([3, 50, 51], -9999.0)),
        "warning",
        ["-9999 stands in 3 rows of T", "leave these cells empty"],
    ),
    "a code of a context": (
        lambda r: context(r, "air", at([3, 50, 51], 9999.0)),
        "warning",
        ["9999 stands in 3 rows of air"],
    ),
    "stuck": (
        lambda r: readings(r, "S", at(slice(20, None), 12.5)),
        "warning",
        ["sensor 'S'", "repeat the one before exactly"],
    ),
    "stuck at the end": (
        lambda r: readings(r, "S", at(slice(130, None), 12.5)),
        "warning",
        ["sensor 'S'", "stands still from row 131"],
    ),
    "a context outside": (
        lambda r: context(r, "wind", at(slice(20, 25), 14.0)),
        "warning",
        ["context 'wind'", "outside its range 0 to 10 kN", "5 of 200 rows, row 21, 12000 s"],
    ),
    "a context outside throughout": (
        lambda r: context(r, "air", lambda column: column + 273.15),
        "warning",
        ["air lies outside its range -20..40 in every row"],
    ),
    "a context that stands still": (
        lambda r: context(r, "wind", at(slice(None), 3.0)),
        "warning",
        ["wind has one value"],
    ),
    "a context at its limit": (
        lambda r: context(r, "wind", at(slice(60, 66), 9.0)),
        "warning",
        ["stands at exactly 9"],
    ),
    "a unit of all strains": (
        every(lambda column: column / 1e6, "S", "T", "rod"),
        "warning",
        ["channels in microstrain", "times as large"],
    ),
    "a unit of one channel": (
        lambda r: readings(r, "U", lambda column: column / 1000),
        "warning",
        ["channel 'U'", "0.001 times as large"],
    ),
    "a sign of one channel": (
        lambda r: readings(r, "V", np.negative),
        "warning",
        ["channel 'V'", "against the simulation", "sign = -1"],
    ),
    "a sign of all": (every(np.negative, "S", "T", "rod"), "warning", ["go against"]),
    "readings of something else": (
        lambda r: readings(r, "W", lambda column: 1e5 * np.sin(np.arange(len(column)) ** 2)),
        "warning",
        ["channel 'W'", "the model over all ranges"],
    ),
    "zeros of their own": (
        lambda r: replace(r, readings=r.readings + OFFSETS),
        "warning",
        ["are off by constants", "start from zeros of their own"],
    ),
    "zeros of the first rows": (
        lambda r: replace(r, readings=r.readings - r.readings[:10].mean(axis=0)),
        "warning",
        ["read zero on average from 0 s to 5400 s", "zero = [0, 5400]"],
    ),
    "zeroed anew": (
        lambda r: replace(
            r,
            readings=r.readings
            - np.where(np.arange(200)[:, None] >= 90, r.readings[90:95].mean(axis=0), 0.0),
        ),
        "warning",
        ["read zero again from 54000 s"],
    ),
    "started anew": (
        lambda r: replace(
            r,
            readings=r.readings + np.where(np.arange(200)[:, None] >= 90, OFFSETS, 0.0),
        ),
        "warning",
        ["6 of 6 channels jump together at 54000 s"],
    ),
    "a channel that is left out": (
        lambda r: replace(r.channels("UVST"), unused={"W": "broken since May"}),
        "note",
        ["sensors 'W', 'rod'", "broken since May"],
    ),
    "a context that is not measured": (
        lambda r: replace(r, contexts={n: c for n, c in r.contexts.items() if n != "wind"}),
        "note",
        ["context 'wind'", "inferred"],
    ),
    "what the reader said": (
        lambda r: replace(r, warnings=["the file ends in the middle of a line"]),
        "warning",
        ["the file ends in the middle of a line"],
    ),
}


@pytest.mark.parametrize("case", SAID)
def test_a_finding(case: str, model: Model, measured: Making) -> None:
    change, severity, expected = SAID[case]
    found = check(model, change(measured()))
    said = [one for one in found.findings if all(part in str(one) for part in expected)]
    assert said, str(found)
    assert said[0].severity == severity
    assert said[0].where
    assert said[0].remedy


#: near a finding, and none
SILENT: dict[str, Change] = {
    "nothing": lambda r: r,
    "a few missing": lambda r: readings(r, "S", at(slice(0, 200, 40), np.nan)),
    "a row left out": lambda r: later(r, 100, 600.0),
    "a coarse channel": lambda r: readings(r, "S", lambda column: np.round(column / 5) * 5),
    "a gain": lambda r: readings(r, "S", lambda column: 1.3 * column),
    "a context a noise outside": lambda r: context(r, "wind", at([20], -0.15)),
    "a spike": lambda r: readings(r, "T", at([50], 900.0)),
    "a declared zero": lambda r: replace(
        r, readings=r.readings - r.readings[:10].mean(axis=0), zero=(0.0, 5400.0)
    ),
    "its own warning of a range": lambda r: replace(
        r, warnings=["wind lies outside its range 0..10 kN in 1 of 200 rows (it runs from -1 to 2)"]
    ),
}


@pytest.mark.parametrize("case", SILENT)
def test_no_finding(case: str, model: Model, measured: Making) -> None:
    checked = check(model, SILENT[case](measured()))
    assert str(replace(checked, record=None)) == "Nothing looks wrong."


@pytest.mark.parametrize(("start", "said"), [("2024-05-01", True), ("2024-05-01T00:00Z", False)])
def test_a_time_without_a_zone(start: str, said: bool, model: Model, measured: Making) -> None:
    found = check(model, measured(start=start))
    assert any("no time zone" in one.what for one in found.findings) == said
    assert found.ok


def test_codes_for_missing_values_are_no_zeros(model: Model, measured: Making) -> None:
    started_anew = SAID["started anew"][0]
    coded = every(at(slice(20, 200, 40), -9999.0), "U")
    for change, about_zeros in ((started_anew, True), (lambda r: coded(started_anew(r)), False)):
        found = check(model, change(measured())).findings
        assert any(one.where == "zeros of the record" for one in found) == about_zeros
    assert any("-9999" in one.what for one in found)


def test_latent_contexts_hide_no_unit(model: Model, measured: Making) -> None:
    record = measured()
    record = replace(record, contexts={n: c for n, c in record.contexts.items() if n != "wind"})
    assert [one.severity for one in check(model, record).findings] == ["note"]
    wrong = every(lambda column: column * 1e3, "S", "T", "rod")(record)
    assert any("microstrain" in one.what for one in check(model, wrong).findings)


def test_a_record_that_cannot_be_read_comes_beside_the_model(
    portal: dict[str, Any], tmp_path: Any
) -> None:
    portal["materials"]["steel"]["E"] = 210
    (tmp_path / "record.csv").write_text("time,U\n0,1\n0,2\n", encoding="utf-8")
    found: CheckResult = check(read_model(portal, "portal"), tmp_path / "record.csv")
    assert not found.ok
    assert "record.csv" in found.findings[0].where
    assert any("E is 210 Pa" in one.what for one in found.findings)
