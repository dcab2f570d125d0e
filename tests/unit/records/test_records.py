"""Records: what is read, in which units, and the lead-in that is found."""

from datetime import datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rga.errors import InputError
from rga.model import Model, load_model, write_model
from rga.records import Record, RecordMapping, load_contexts, load_record
from rga.records.lead_in import find_lead_in
from rga.records.read import read_table

SHARED = Path(__file__).parents[4] / "shared" / "measured"


@pytest.fixture
def model(two_bars: dict[str, Any]) -> Model:
    return Model.model_validate(two_bars)


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def test_columns_by_name_with_missing_values(tmp_path: Path, model: Model) -> None:
    path = write(
        tmp_path / "r.csv", "time,S1,temperature,D1\n5,1,20,\n6,,21,2.5\n8,3,nan,3.5\n\n\n"
    )
    record = load_record(path, model)
    assert record.sensors == ("D1", "S1")
    assert record.time.tolist() == [0, 1, 3]
    np.testing.assert_array_equal(record.readings, [[np.nan, 1], [2.5, np.nan], [3.5, 3]])
    np.testing.assert_array_equal(record.contexts["temperature"], [20, 21, np.nan])
    assert "load" not in record.contexts
    assert record.time_format == "seconds"
    assert record.origin == 5
    assert record.time_label(3.0) == 8.0
    assert record.warnings == ["temperature is missing in 1 of 3 rows"]


def test_iso_times_with_zone(tmp_path: Path, model: Model) -> None:
    rows = "2022-03-27T01:59:59.5+01:00,1,2\n2022-03-27T03:00:00+02:00,1,2\n"
    record = load_record(write(tmp_path / "r.csv", "time,D1,S1\n" + rows), model)
    assert record.time.tolist() == [0, 0.5]
    assert record.time_format == "iso"
    assert record.start == "2022-03-27T01:59:59.5+01:00"
    assert record.time_label(0.75) == "2022-03-27T02:00:00.250+01:00"


@pytest.mark.parametrize("stamped", [True, False])
def test_parquet_holds_what_the_csv_holds(tmp_path: Path, model: Model, stamped: bool) -> None:
    first = datetime(2024, 2, 29, 23, 59, 59)
    seconds = [0.0, 0.25, 2.0]
    time = [first + timedelta(seconds=s) for s in seconds] if stamped else seconds
    frame = pl.DataFrame({"time": time, "D1": [1.0, None, 3.0], "S1": [1, 2, 3]})
    frame.write_parquet(tmp_path / "r.parquet")
    frame.write_csv(tmp_path / "r.csv")
    parquet, text = (load_record(tmp_path / f"r.{kind}", model) for kind in ("parquet", "csv"))
    np.testing.assert_array_equal(parquet.time, text.time)
    np.testing.assert_array_equal(parquet.readings, text.readings)
    assert parquet.time_format == text.time_format
    assert parquet.time_label(2.0) == text.time_label(2.0)
    assert parquet.sha256 != text.sha256


def test_context_outside_its_range_is_a_warning(tmp_path: Path, model: Model) -> None:
    path = write(tmp_path / "r.csv", "time,D1,S1,temperature\n0,1,1,-25\n1,1,1,10\n2,1,1,40\n")
    assert load_record(path, model).warnings == [
        "temperature lies outside its range -20..40 degC in 1 of 3 rows (it runs from -25 to 40)"
    ]


def test_mapping_gives_names_units_signs_and_time(tmp_path: Path, model: Model) -> None:
    write(
        tmp_path / "import.toml",
        """
        delimiter = ";"
        header = "{channel} [{unit}]"
        zero = [0.0, 0.5]
        [time]
        columns = ["Date", "Clock"]
        format = "%d.%m.%Y %H:%M:%S"
        sampling_rate_hz = 2
        [channels]
        D1 = { column = "deflection", unit = "cm", sign = -1 }
        [unused]
        x = "a spare input"
        """,
    )
    path = write(
        tmp_path / "r.csv",
        "Date;Clock;deflection;S1 [m/m];load [kN];x\n"
        "01.02.2024;10:00:00;1.0;1e-6;50;0\n"
        "01.02.2024;10:00:00;1.2;3e-6;60;0\n"
        "01.02.2024;10:00:01;2.1;9e-6;70;0\n",
    )
    record = load_record(path, model)
    assert record.time.tolist() == [0, 0.5, 1]
    assert record.start == "2024-02-01T10:00:00"
    np.testing.assert_allclose(record.readings, [[1, -1], [-1, 1], [-10, 7]], atol=1e-9)
    np.testing.assert_allclose(record.contexts["load"], [5e4, 6e4, 7e4])
    assert record.unused == {"x": "a spare input"}
    assert record.zero == (0.0, 0.5)


def test_a_sensor_without_data_is_declared_with_its_reason(tmp_path: Path, model: Model) -> None:
    path = write(tmp_path / "r.csv", "time,D1\n0,1\n1,2\n")
    record = load_record(path, model, RecordMapping(unused={"S1": "gauge removed"}))
    assert record.sensors == ("D1",)
    assert record.unused == {"S1": "gauge removed"}


def test_mapping_is_looked_up_beside_the_record_then_beside_the_model(
    tmp_path: Path, model: Model
) -> None:
    for folder, sign in (("model", 1), ("record", -1), ("given", -1)):
        (tmp_path / folder).mkdir()
        unit = "cm" if folder == "given" else "mm"
        text = f'[channels]\nD1 = {{ sign = {sign}, unit = "{unit}" }}\n'
        write(tmp_path / folder / "import.toml", text)
    (tmp_path / "elsewhere").mkdir()
    write_model(model, tmp_path / "model" / "m.json")
    read = load_model(tmp_path / "model" / "m.json")

    def first(folder: str, mapping: Path | None = None) -> float:
        path = write(tmp_path / folder / "r.csv", "time,D1,S1\n0,1,2\n")
        return float(load_record(path, read, mapping).readings[0, 0])

    assert first("elsewhere") == 1
    assert first("record") == -1
    assert first("record", tmp_path / "given" / "import.toml") == -10


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_the_mapping_of_a_logger_is_not_for_what_rga_wrote(
    tmp_path: Path, model: Model, suffix: str
) -> None:
    text = '[time]\ncolumns = ["Date"]\n[channels]\nD1 = { unit = "cm" }\nS1 = { unit = "m/m" }\n'
    mapping = write(tmp_path / "import.toml", text)
    logger = load_record(write(tmp_path / "logger.csv", "Date,D1,S1\n0,1,2e-6\n1,3,4e-6\n"), model)
    written = tmp_path / f"written.{suffix}"
    logger.write(written)
    np.testing.assert_allclose(logger.readings, [[10, 2], [30, 4]])
    np.testing.assert_array_equal(load_record(written, model).readings, logger.readings)
    with pytest.raises(InputError, match="no time column 'Date'"):
        load_record(written, model, mapping)
    with pytest.raises(InputError, match="no time column 'Date'"):
        load_record(write(tmp_path / "other.csv", "time,D1,X\n0,1,2\n"), model)


@pytest.mark.parametrize(
    "chosen",
    [np.array([3]), np.array([True]), slice(None, None, -1), np.array([1, 0]), slice(0, 3, 0)],
)
def test_rows_that_are_none_or_out_of_order(chosen: Any) -> None:
    record = Record(np.arange(3.0), 0.0, "seconds", ("A",), np.zeros((3, 1)))
    with pytest.raises(InputError, match=r"no such rows|do not rise"):
        record.rows(chosen)


def test_rows_and_channels_keep_what_belongs_together() -> None:
    readings = np.arange(6.0).reshape(3, 2)
    record = Record(
        np.arange(3.0), 0.0, "seconds", ("A", "B"), readings, contexts={"t": np.arange(3.0)}
    )
    part = record.rows(record.time > 0).channels(["B"])
    assert len(part) == 2
    assert part.sensors == ("B",)
    np.testing.assert_array_equal(part.readings, [[3], [5]])
    np.testing.assert_array_equal(part.contexts["t"], [1, 2])
    with pytest.raises(KeyError):
        record.channels(["C"])


@given(st.lists(st.floats(-1e30, 1e30) | st.just(float("nan")), min_size=2, max_size=20))
def test_numbers_survive_the_file(values: list[float]) -> None:
    with TemporaryDirectory() as folder:
        cells = ["" if np.isnan(value) else repr(value) for value in values]
        rows = "".join(f"{row},{cell}\n" for row, cell in enumerate(cells))
        table = read_table(write(Path(folder) / "r.csv", "time,x\n" + rows))
        np.testing.assert_array_equal(table.numbers("x"), values)


def crossing(seed: int, rows: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    """Time and readings of a load that arrives at 20 s of 40 s, with noise of 0.3 % of it."""
    generator = np.random.default_rng(seed)
    time = np.linspace(0, 40, rows)
    load = np.clip((time - 20) / 3, 0, 1) * (time < 37)
    gains = generator.uniform(50, 200, 8) * generator.choice([-1, 1], 8)
    noise = 0.003 * np.abs(gains) * generator.standard_normal((rows, 8))
    return time, load[:, None] * gains + noise + generator.uniform(-50, 50, 8)


@pytest.mark.parametrize("seed", range(5))
def test_lead_in_ends_before_the_load_arrives(seed: int) -> None:
    first, last = find_lead_in(*crossing(seed), "r")
    assert first == 0
    assert 15 < last < 20.3


def test_lead_in_is_not_confused_by_a_spiking_channel() -> None:
    time, readings = crossing(1)
    plain = find_lead_in(time, readings, "r")
    hit = np.random.default_rng(0).random(len(time)) < 0.02
    readings[:, 3] = np.where(hit, -2e4, 1.8e4)
    readings[:400, 3] = -2e4
    assert find_lead_in(time, readings, "r")[1] == pytest.approx(plain[1], abs=1.0)


def test_lead_in_ends_where_a_channel_creeps() -> None:
    time, readings = crossing(2)
    activity = np.ptp(readings[:, 5])
    readings[:, 5] += 0.01 * activity * np.clip(time - 10, 0, None)
    assert find_lead_in(time, readings, "r")[1] < 12.5


def test_no_lead_in_where_nothing_is_quieter_than_the_rest() -> None:
    time, readings = crossing(3)
    restless = np.sin(time)[:, None] * np.ptp(readings, axis=0) + readings
    with pytest.raises(InputError, match="no unloaded lead-in"):
        find_lead_in(time, restless, "r")
    with pytest.raises(InputError, match="no unloaded lead-in"):
        find_lead_in(time[:1500], readings[:1500], "r")
    with pytest.raises(InputError, match="too few"):
        find_lead_in(time[:20], readings[:20], "r")


def test_the_measured_crossing_is_read_as_its_description_says() -> None:
    path = SHARED / "rdso45m" / "record_40kmh.txt"
    example = Path(__file__).parents[3] / "examples" / "rdso45m"
    if not path.exists():
        pytest.skip("the measured record is not part of this project")
    if not (example / "model.json").exists():
        pytest.skip("the model of the example is not there yet")
    record = load_record(path, load_model(example / "model.json"))
    assert len(record) == 9180
    assert record.sensors == ("d5", "d6", *(f"S{number}" for number in range(21, 37)))
    assert record.start == "2022-05-30T12:53:45.557000"
    assert record.time[-1] == pytest.approx(36.718)
    assert set(record.unused) == {"d7", "S37", "S38", "S39", "S40"}
    assert record.zero is not None
    assert 10 < record.zero[1] < 17
    under_load = record.rows((record.time > 23) & (record.time < 26))
    mean = dict(zip(record.sensors, under_load.readings.mean(axis=0), strict=True))
    assert -25 < mean["d5"] < -22  # down
    assert mean["S22"] > 90  # bottom chord in tension
    assert mean["S21"] < -190  # end raker in compression


@pytest.mark.parametrize("case", range(1, 8))
def test_practice_records_are_read(case: int) -> None:
    folder = SHARED / "practice" / f"{case:02d}"
    if not folder.exists():
        pytest.skip("the practice cases are not part of this project")
    model = load_model(folder / "model.json")
    record = load_record(folder / "record.csv", model)
    assert record.sensors == tuple(model.sensors)
    assert set(record.contexts) == {"temperature", "crowd", "cart_position", "cart_weight"}
    assert np.isfinite(record.readings).mean() > 0.9


def test_contexts_pass_over_sensors_and_keep_time(tmp_path: Path, model: Model) -> None:
    path = write(tmp_path / "c.csv", "time,temperature,D1\n1970-01-02,5,9\n1970-01-03,6,9\n")
    contexts = load_contexts(path, model)
    assert contexts.frame.columns == ["time", "temperature"]
    assert contexts.values["time"].tolist() == [86400, 2 * 86400]
    units = write(tmp_path / "k.csv", "temperature;load\n°F;kN\n50;1,5\n68;2,5\n")
    read = load_contexts(units, model).values
    np.testing.assert_allclose(read["temperature"], [10, 20])
    np.testing.assert_allclose(read["load"], [1500, 2500])
    with pytest.raises(InputError, match="no value"):
        load_contexts(write(tmp_path / "e.csv", "temperature,load\n5,1\n,2\n"), model)
    with pytest.raises(InputError, match="no context variable 'wind'"):
        load_contexts(write(tmp_path / "u.csv", "wind\n5\n"), model)
