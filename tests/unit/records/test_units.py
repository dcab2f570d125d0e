"""Units as people write them, in the units of a model."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model
from rga.model.units import UNITS
from rga.records import RecordMapping, load_record
from rga.records.mapping import Channel
from rga.records.units import DIMENSIONS, conversion, name_and_unit, unit_of


@pytest.mark.parametrize(
    "alike",
    [
        ["µm/m", "μm/m", "um/m", "µε", "με", "ue", "microstrain", "MicroStrain", "µstrain", "ppm"],
        ["°C", "degC", "Deg C", "oC", "C", "deg C", "[°C]", "(°C)", "℃", "Celsius", "Cel"],
        ["kN/m²", "kN/m2", "kN/m^2", "kPa", "kPA"],
        ["N/mm²", "MPa", "N/mm2"],
        ["mm", "Millimeter", "[mm]"],
        ["N", "Newtons", "newton"],
        ["m/s^2", "m/s²", "m/s2"],
        ["°F", "degF", "Fahrenheit"],
        ["kN·m", "kNm", "kN m", "kN*m"],
        ["s", "sec", "Sekunden"],
        ["%", "percent"],
    ],
)
def test_ways_of_writing_one_unit(alike: list[str]) -> None:
    assert len({unit_of(text) for text in alike}) == 1
    assert unit_of(alike[0]) is not None


@pytest.mark.parametrize("text", ["kImp", "furlong", "MN/N", "x", "mV/V/m", "Deg"])
def test_what_is_no_unit_is_none(text: str) -> None:
    found = unit_of(text)
    assert found is None or text == "Deg"


def test_capitals_tell_units_apart() -> None:
    milli, mega = unit_of("mN"), unit_of("MN")
    assert milli is not None
    assert mega is not None
    assert mega.size / milli.size == pytest.approx(1e9)


def test_every_unit_of_a_model_is_known_in_its_dimension() -> None:
    for kind, units in UNITS.items():
        for text, per_si in units.items():
            found = unit_of(text)
            assert found is not None
            assert found.dimension == DIMENSIONS[kind][0]
            assert found.size * per_si == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize(
    ("unit", "name", "value", "expected"),
    [
        ("°F", "temperature", 68.0, 20.0),
        ("K", "temperature", 293.15, 20.0),
        ("kN", "load", 1.5, 1500.0),
        ("cm", "D1", 1.0, 10.0),
        ("mm/m", "S1", 0.25, 250.0),
        ("‰", "S1", 0.25, 250.0),
        ("in", "D1", 1.0, 25.4),
    ],
)
def test_values_are_converted(
    unit: str, name: str, value: float, expected: float, two_bars: dict[str, Any]
) -> None:
    factor, offset = conversion(unit, name, Model.model_validate(two_bars), "r.csv")
    assert value * factor + offset == pytest.approx(expected)


@pytest.mark.parametrize(
    ("header", "row", "said"),
    [
        (
            "time;D1;S1 [kN]",
            "0;1;2",
            r"'kN' of 'S1' is not one of a strain sensor.*column 'S1 \[kN",
        ),
        ("time;D1 [elle];S1", "0;1;2", "'elle' of 'D1' is unknown"),
        ("time;D1;S1;load [kg]", "0;1;2;3", "'kg' of 'load' is not one of that context"),
    ],
)
def test_a_unit_of_something_else_is_one_error_with_its_column(
    header: str, row: str, said: str, tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    (tmp_path / "r.csv").write_text(f"{header}\n{row}\n", encoding="utf-8")
    with pytest.raises(InputError, match=said):
        load_record(tmp_path / "r.csv", Model.model_validate(two_bars))


def test_a_unit_that_is_stated_goes_before_that_of_the_file(
    tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    (tmp_path / "import.toml").write_text('[channels]\nD1 = { unit = "m" }\n', encoding="utf-8")
    content = "time;D1 [elle];S1;load\ns;;µm/m;\n0;1;2;3\n"
    (tmp_path / "r.csv").write_text(content, encoding="utf-8")
    record = load_record(tmp_path / "r.csv", Model.model_validate(two_bars))
    np.testing.assert_allclose(record.readings, [[1000, 2]])
    assert "no unit is stated for load (N): the model's is taken" in record.notes


def test_brackets_hold_a_unit_only_where_it_is_one() -> None:
    assert name_and_unit("Excitation (Trigger)") == ("Excitation (Trigger)", None)
    assert name_and_unit("temp(1)") == ("temp(1)", None)
    assert name_and_unit("d5 (mm)") == ("d5", "mm")
    assert name_and_unit("T [weird]") == ("T", "weird")
    assert name_and_unit("Temp, °C (LGR S/N: 12)") == ("Temp", "°C")


@pytest.mark.parametrize("nothing", ["-", "", "n/a", "none", "[-]"])
def test_a_dash_in_the_line_of_units_states_none(
    nothing: str, tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    path = tmp_path / "r.csv"
    path.write_text(f"time;D1;S1\ns;mm;{nothing}\n0;1;100\n1;1;200\n", encoding="utf-8")
    record = load_record(path, Model.model_validate(two_bars))
    assert record.readings[:, 1].tolist() == [100, 200]
    assert "no unit is stated for S1 (microstrain): the model's is taken" in record.notes
    path.write_text("time;D1;S1\ns;mm;m/m\n0;1;1e-4\n1;1;2e-4\n", encoding="utf-8")
    record = load_record(path, Model.model_validate(two_bars))
    np.testing.assert_allclose(record.readings[:, 1], [100, 200])


def test_a_line_of_dashes_is_no_row_of_missing_values(
    tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    path = tmp_path / "r.csv"
    path.write_text("time;D1;S1\n-;-;-\n0;1;100\n1;-;200\n", encoding="utf-8")
    record = load_record(path, Model.model_validate(two_bars))
    np.testing.assert_array_equal(record.readings, [[1, 100], [np.nan, 200]])


@pytest.mark.parametrize(
    ("header", "units", "said"),
    [
        ("D1 [mm];S1 [µm/m]", "mm;mm/m", r"'S1' says 'µm/m', the line of units says 'mm/m'"),
        ("D1 [mm];S1", "cm;µm/m", r"'D1' says 'mm', the line of units says 'cm'"),
        ("D1 [mm];S1 [µm/m]", "mm;um/m", None),
        ("D1 [mm];S1 [µm/m]", "-;-", None),
    ],
)
def test_units_that_contradict_each_other_are_refused(
    header: str, units: str, said: str | None, tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    model = Model.model_validate(two_bars)
    path = tmp_path / "r.csv"
    path.write_text(f"time;{header}\ns;{units}\n0;1;100\n1;2;200\n", encoding="utf-8")
    if said is None:
        assert load_record(path, model).readings.tolist() == [[1, 100], [2, 200]]
        return
    with pytest.raises(InputError, match=said):
        load_record(path, model)
    stated = {"D1": Channel(unit="mm"), "S1": Channel(unit="mm/m")}
    record = load_record(path, model, RecordMapping(channels=stated))
    np.testing.assert_allclose(record.readings, [[1, 100_000], [2, 200_000]])


def test_a_unit_in_the_name_holds_above_a_dash(tmp_path: Path, two_bars: dict[str, Any]) -> None:
    path = tmp_path / "r.csv"
    path.write_text("time;D1 [cm];S1\ns;-;µm/m\n0;1;100\n1;2;200\n", encoding="utf-8")
    record = load_record(path, Model.model_validate(two_bars))
    np.testing.assert_allclose(record.readings, [[10, 100], [20, 200]])
