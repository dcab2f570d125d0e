"""Files one after the other, files side by side, folders, and data frames."""

from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from rga.errors import InputError
from rga.model import Model, load_model, write_model
from rga.records import Record, RecordMapping, load_record
from rga.records.mapping import TimeColumns


@pytest.fixture
def model(two_bars: dict[str, Any]) -> Model:
    return Model.model_validate(two_bars)


def write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    return path


def rows(start: datetime, count: int, step: float, *columns: Any) -> str:
    lines = []
    for k in range(count):
        cells = (f"{column(k)}" for column in columns)
        lines.append(f"{start + timedelta(seconds=k * step)},{','.join(cells)}\n")
    return "".join(lines)


def month(folder: Path, name: str, start: datetime, count: int = 4, unit: str = "mm") -> Path:
    content = rows(start, count, 600, lambda k: k, lambda k: 2 * k)
    return write(folder / name, f"time,D1 [{unit}],S1\n{content}")


JANUARY, FEBRUARY = datetime(2024, 1, 31, 23, 30), datetime(2024, 2, 1, 0, 10)


def test_two_months_are_one_record_in_the_order_of_time(tmp_path: Path, model: Model) -> None:
    files = [
        month(tmp_path, "b.csv", FEBRUARY, unit="cm"),
        str(month(tmp_path, "a.csv", JANUARY)),
    ]
    record = load_record(files, model)
    assert record.start == "2024-01-31 23:30:00"
    assert record.time.tolist() == [0, 600, 1200, 1800, 2400, 3000, 3600, 4200]
    assert record.readings[:, 0].tolist() == [0, 1, 2, 3, 0, 10, 20, 30]
    assert record.notes[0] == "2 files follow each other in time"
    alone = [load_record(one, model).sha256 for one in files]
    assert len({record.sha256, *alone}) == 3


def test_a_row_that_both_files_have_is_taken_once(tmp_path: Path, model: Model) -> None:
    first = write(tmp_path / "a.csv", "time,D1,S1\n2024-01-01T00:00,1,2\n2024-01-01T01:00,3,4\n")
    second = write(tmp_path / "b.csv", "time,D1,S1\n2024-01-01T01:00,3,4\n2024-01-01T02:00,5,6\n")
    record = load_record([first, second], model)
    assert record.time.tolist() == [0, 3600, 7200]
    assert any("taken once" in note for note in record.notes)
    write(second, "time,D1,S1\n2024-01-01T01:00,3,9\n2024-01-01T02:00,5,6\n")
    with pytest.raises(InputError, match=r"b\.csv begins 0 s before .*a\.csv ends"):
        load_record([first, second], model)


@pytest.mark.parametrize(
    ("first", "second", "steps"),
    [
        (["01:00", "01:30", "02:00", "02:30"], ["02:00", "02:30", "03:00", "03:30"], [30] * 7),
        (["01:00", "01:30"], ["02:00", "02:30", "03:00", "03:30"], [30, 90, 30, 30, 30]),
        (["01:00", "01:30", "02:00", "02:30"], ["03:00", "03:30"], [30, 30, 30, 90, 30]),
    ],
)
def test_files_that_part_the_hour_that_comes_twice(
    first: list[str], second: list[str], steps: list[int], tmp_path: Path, model: Model
) -> None:
    files = [
        write(tmp_path / name, "time,D1,S1\n" + "".join(f"2024-10-27 {at},1,2\n" for at in night))
        for name, night in (("a.csv", first), ("b.csv", second))
    ]
    record = load_record(files, model, RecordMapping(time=TimeColumns(zone="Europe/Berlin")))
    assert (np.diff(record.time) / 60).tolist() == steps
    assert any("comes twice" in note for note in record.notes)


def test_files_that_do_not_follow_each_other_are_refused(tmp_path: Path, model: Model) -> None:
    seconds = [write(tmp_path / f"{k}.csv", "time,D1,S1\n0,1,2\n9,1,2\n") for k in range(2)]
    with pytest.raises(InputError, match="begins 9 s before"):
        load_record(seconds, model)
    stamped = month(tmp_path, "a.csv", JANUARY)
    with pytest.raises(
        InputError, match=r"are seconds, those of .* are time stamps without a zone"
    ):
        load_record([seconds[0], stamped], model)


def test_a_channel_that_one_file_lacks_is_missing_there(tmp_path: Path, model: Model) -> None:
    first = write(tmp_path / "a.csv", "time,D1,S1\n0,1,2\n1,1,2\n")
    second = write(tmp_path / "b.csv", "time,D1\n2,5\n3,5\n")
    record = load_record([first, second], model)
    np.testing.assert_array_equal(record.readings[:, 1], [2, 2, np.nan, np.nan])
    assert record.warnings == [f"S1 is missing in {second}"]


def test_a_folder_says_by_its_mapping_what_its_files_are(tmp_path: Path, model: Model) -> None:
    month(tmp_path, "log-1.csv", JANUARY)
    month(tmp_path, "log-2.csv", FEBRUARY)
    with pytest.raises(InputError, match=r"folder holds log-1\.csv, log-2\.csv"):
        load_record(tmp_path, model)
    write(tmp_path / "import.toml", 'files = ["log-*.csv"]\n')
    of_folder, of_mapping = (
        load_record(one, model) for one in (tmp_path, tmp_path / "import.toml")
    )
    assert len(of_folder) == len(of_mapping) == 8
    assert len(load_record(tmp_path / "log-1.csv", model)) == 4
    assert len(load_record(tmp_path / "log-*.csv", model)) == 8
    write(tmp_path / "import.toml", 'files = ["no-*.csv"]\n')
    with pytest.raises(InputError, match="no file has a name like this"):
        load_record(tmp_path, model)


def test_the_mapping_of_a_folder_may_stand_beside_the_model(tmp_path: Path, model: Model) -> None:
    month(tmp_path / "data", "a.csv", JANUARY)
    write_model(model, tmp_path / "model.json")
    write(tmp_path / "import.toml", 'files = ["data/a.csv"]\n')
    assert len(load_record(tmp_path / "data", load_model(tmp_path / "model.json"))) == 4


BESIDE = """
files = ["main.csv"]
[[beside]]
files = ["weather.csv"]
{how}
[beside.channels]
temperature = {{ column = "Air [°C]" }}
[beside.unused]
wind = "no channel of the model"
"""


def side_by_side(folder: Path, model: Model, how: str, step: float, shift: float = 0) -> Record:
    month(folder, "main.csv", JANUARY, 7)
    start = JANUARY + timedelta(seconds=shift)
    content = rows(start, int(3600 / step) + 1, step, lambda k: 10 + k * step / 600, lambda k: "x")
    write(folder / "weather.csv", f"Timestamp,Air [°C],wind\n{content}")
    write(folder / "import.toml", BESIDE.format(how=how))
    return load_record(folder, model)


def test_the_nearest_row_of_another_logger(tmp_path: Path, model: Model) -> None:
    record = side_by_side(tmp_path, model, "", 600, shift=100)
    np.testing.assert_allclose(record.contexts["temperature"], np.arange(10, 17))
    assert record.unused == {"wind": "no channel of the model"}
    assert record.notes[-1] == (
        "weather.csv is matched by the row nearest in time, in 7 of 7 rows, at most 100 s away"
    )
    far = side_by_side(tmp_path, model, "tolerance_s = 50", 1800)
    expected = [10, np.nan, np.nan, 13, np.nan, np.nan, 16]
    np.testing.assert_array_equal(far.contexts["temperature"], expected)
    with pytest.raises(InputError, match=r"no row of .*weather.csv lies near"):
        side_by_side(tmp_path, model, "", 600, shift=1e6)


def test_values_between_the_rows_of_a_slower_logger(tmp_path: Path, model: Model) -> None:
    record = side_by_side(tmp_path, model, 'match = "interpolate"', 1800)
    np.testing.assert_allclose(record.contexts["temperature"], np.arange(10, 17))
    late = side_by_side(tmp_path, model, 'match = "interpolate"\nshift_s = -300', 1800, shift=300)
    np.testing.assert_allclose(late.contexts["temperature"], np.arange(10, 17))


def test_means_of_a_faster_logger_about_each_row(tmp_path: Path, model: Model) -> None:
    record = side_by_side(tmp_path, model, 'match = "mean"', 60)
    found = record.contexts["temperature"]
    np.testing.assert_allclose(found[1:-1], np.arange(11, 16), atol=1e-9)
    assert np.isnan(found[[0, -1]]).all()  # half of these windows lies outside the file
    assert record.notes[-1] == (
        "weather.csv is taken as means over 600 s about each row, of 11 readings each"
    )


def test_means_on_the_rows_of_a_slower_logger(tmp_path: Path, model: Model) -> None:
    record = side_by_side(tmp_path, model, 'match = "mean"', 1200)
    assert record.time.tolist() == [0, 1200]
    np.testing.assert_allclose(record.contexts["temperature"], [12, 14])
    np.testing.assert_allclose(record.readings, [[2, 4], [4, 8]])
    assert "the record has 2 rows of weather.csv, with means over 1200 s" in record.notes[-1]


def test_the_noise_that_a_model_states_is_not_that_of_a_mean(
    tmp_path: Path, two_bars: dict[str, Any]
) -> None:
    two_bars["context"]["temperature"]["noise"] = 0.5
    stated = Model.model_validate(two_bars)
    said = "the noise that the model states of 'temperature' is that of one reading"
    mean, nearest = (
        side_by_side(tmp_path, stated, f'match = "{how}"', 60) for how in ("mean", "nearest")
    )
    assert said in mean.notes[-1]
    assert said not in " ".join(nearest.notes)


def test_a_channel_has_one_source_and_all_are_somewhere(tmp_path: Path, model: Model) -> None:
    month(tmp_path, "main.csv", JANUARY)
    month(tmp_path, "other.csv", JANUARY)
    write(tmp_path / "import.toml", '[[beside]]\nfiles = ["other.csv"]\n')
    with pytest.raises(InputError, match="both give 'D1'"):
        load_record(tmp_path / "main.csv", model)
    write(tmp_path / "main.csv", f"time,D1\n{rows(JANUARY, 4, 600, lambda k: k)}")
    write(tmp_path / "other.csv", f"time,load\n{rows(JANUARY, 4, 600, lambda k: k)}")
    with pytest.raises(InputError, match="no column for the sensors 'S1'"):
        load_record(tmp_path / "main.csv", model)
    write(tmp_path / "import.toml", '[[beside]]\nmatch = "mean"\n')
    with pytest.raises(InputError, match="files of the other logger"):
        load_record(tmp_path / "main.csv", model)


def test_a_data_frame_is_a_record(model: Model) -> None:
    start = datetime(2024, 1, 1)
    frame = pl.DataFrame(
        {"time": [start, start + timedelta(seconds=5)], "D1": [1.0, None], "S1": ["2", "NAN"]}
    )
    for given in (frame, frame.lazy()):
        record = load_record(given, model)
        assert record.start == "2024-01-01T00:00:00"
        assert record.time.tolist() == [0, 5]
        np.testing.assert_array_equal(record.readings, [[1, 2], [np.nan, np.nan]])
    renamed = frame.rename({"D1": "d"})
    mapping = RecordMapping(channels={"D1": {"column": "d", "sign": -1}})
    assert load_record(renamed, model, mapping).readings[0, 0] == -1
    with pytest.raises(InputError, match="no rows in the data frame"):
        load_record(frame.head(0), model)
    assert load_record(frame, model).sha256 != load_record(frame.reverse().with_columns(
        time=frame["time"]), model).sha256  # fmt: skip


def test_a_channel_that_stands_still_is_warned_of(model: Model) -> None:
    count = 60
    frame = pl.DataFrame({"time": np.arange(count), "D1": np.arange(count), "S1": [7.0] * count})
    assert load_record(frame, model).warnings == ["S1 reads 7 in all 60 rows: it never moves"]


def test_zones_that_differ_are_told_with_their_tables(tmp_path: Path, model: Model) -> None:
    month(tmp_path, "main.csv", JANUARY)
    write(tmp_path / "w.csv", "time,temperature\n2024-01-31T23:30+01:00,1\n")
    write(tmp_path / "import.toml", 'files = ["main.csv"]\n[[beside]]\nfiles = ["w.csv"]\n')
    with pytest.raises(InputError, match=r"zone under \[time\] and \[beside.time\] in import.toml"):
        load_record(tmp_path, model)
    with pytest.raises(InputError, match=r"zone under \[time\] in import.toml"):
        load_record([tmp_path / "main.csv", tmp_path / "w.csv"], model, RecordMapping(
            unused={"temperature": "not asked for", "D1": "-", "S1": "-"}))  # fmt: skip


@pytest.mark.parametrize(("value", "warned"), [(-4.1, 1), (-3.9, 0), (103.9, 0), (104.1, 1)])
def test_a_context_leaves_its_range_by_more_than_its_noise(
    value: float, warned: int, two_bars: dict[str, Any]
) -> None:
    two_bars["context"]["load"].update(range=[0, 100], noise=1.0)
    given = {"time": [0, 1], "D1": [1, 2], "S1": [1, 2], "load": [50.0, value]}
    record = load_record(pl.DataFrame(given), Model.model_validate(two_bars))
    assert sum("lies outside its range" in text for text in record.warnings) == warned


def test_without_a_noise_any_value_beyond_the_range_is_told(two_bars: dict[str, Any]) -> None:
    two_bars["context"]["load"].update(range=[0, 100])
    two_bars["context"]["load"].pop("noise", None)
    given = {"time": [0, 1], "D1": [1, 2], "S1": [1, 2], "load": [50.0, -0.1]}
    record = load_record(pl.DataFrame(given), Model.model_validate(two_bars))
    assert any("lies outside its range 0..100" in text for text in record.warnings)
