"""Numbers, names and files of options as they are typed."""

from pathlib import Path
from typing import Any

import pytest
import typer

from rga.cli.options import decimal, file_to_write, once, settings, whole
from rga.errors import InputError
from rga.experiments.truck import read_truck

NO_NUMBERS = ["1_0", "٣", "１", "", "x", "1_0.5"]


@pytest.mark.parametrize("text", NO_NUMBERS)
def test_digits_of_others_are_no_numbers(text: str) -> None:
    for reader in (whole(), decimal()):
        with pytest.raises(typer.BadParameter, match="is no"):
            reader(text)
    for name in ("snow", "time"):
        with pytest.raises(InputError, match="sets no number"):
            settings([f"{name}={text}"], "--contexts")
    with pytest.raises(InputError, match="is no truck"):
        read_truck(f"60,{text}@3.5")


def test_bounds_of_numbers() -> None:
    assert [whole(0, 3)(given) for given in ("0", "+3", 2)] == [0, 3, 2]
    assert [decimal(0.0)(given) for given in ("0", "2.5e-1", 3.0)] == [0.0, 0.25, 3.0]
    assert whole()("-5") == -5
    for reader, text in ((whole(0), "-1"), (whole(0, 3), "4"), (decimal(0.0), "-0.1")):
        with pytest.raises(typer.BadParameter, match="than"):
            reader(text)
    for text in ("1.5", "1" * 5000):
        with pytest.raises(typer.BadParameter, match="is no whole number"):
            whole()(text)
    with pytest.raises(typer.BadParameter, match="less"):
        decimal(0.0)("nan")


@pytest.mark.parametrize("texts", [["snow=2,snow=3"], ["snow=2", "snow = 2"], ["a=1", "b=1,a=1"]])
def test_a_name_is_set_once(texts: list[str]) -> None:
    with pytest.raises(InputError, match="is set twice"):
        settings(texts, "--contexts")


def test_several_names_are_set_in_one_or_several_options() -> None:
    expected = {"snow": 2.0, "air": -1e-3, "time": 1772323200.0}
    assert settings(["snow=2, air=-1e-3", "time=2026-03-01"], "--contexts") == expected
    assert once(["snow=2", "air=-1e-3", "time=2026-03-01"], "--set") == expected
    assert settings(None, "--contexts") == {}


def test_a_file_to_write_is_no_directory() -> None:
    assert file_to_write("o/d.parquet") == Path("o/d.parquet")
    for given in ("o/d.parquet/", "/"):
        with pytest.raises(typer.BadParameter, match="names a directory"):
            file_to_write(given)


def test_commands_say_so(rga: Any, model_file: Path, tmp_path: Path) -> None:
    target = tmp_path / "new" / "rows.parquet"
    for arguments, words in (
        (("-n", "1_0", "-o", target), "is no whole number"),
        (("-n", "٣", "-o", target), "is no whole number"),
        (("-n", "3", "-o", f"{target}/"), "names a directory"),
        (("-n", "3", "-o", target, "--seed", "-1"), "is less than 0"),
        (("-n", "3", "-o", target, "--seed", "9" * 20), "is no seed"),
    ):
        said = rga("dataset", model_file, *arguments)
        assert said.code == 2
        # Words are broken where a line ends, which hangs on how long the path is.
        assert words in " ".join(said.err.replace("│", " ").split())
    assert not target.parent.exists()
    assert rga("dataset", model_file, "-n", "3", "-o", target).code == 0
    twice = rga("results", model_file, "--contexts", "load=1,load=2", "-o", tmp_path / "r.csv")
    assert (twice.code, twice.err.count("\n")) == (2, 1)
    assert "'load' is set twice" in twice.err
