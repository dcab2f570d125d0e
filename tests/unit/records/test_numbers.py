"""Signs in numbers: thousands in groups of three and nothing else, the true minus."""

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

from rga.errors import InputError
from rga.records import RecordMapping
from rga.records.numbers import Notation, notation_of, numbers_of
from rga.records.read import read_table
from rga.records.table import Table


def table(folder: Path, rows: list[str], **stated: Any) -> Table:
    names = ";".join(f"c{number}" for number in range(rows[0].count(";") + 1))
    (folder / "r.csv").write_text("\n".join([names, *rows]) + "\n", encoding="utf-8")
    return read_table(folder / "r.csv", RecordMapping(**stated))


def test_a_point_that_parts_no_groups_is_none_of_thousands(tmp_path: Path) -> None:
    found = table(tmp_path, ["0;1.234,5;1.100,5;12,5", "1;1.234,5;1.100,5;12.5"])
    assert found.numbers("c1").tolist() == [1234.5, 1234.5]
    with pytest.raises(InputError, match=r"'12\.5' is no number .*line 3, column 'c3'"):
        found.numbers("c3")


def test_a_comma_late_in_a_file_of_points_is_no_sign_of_thousands(tmp_path: Path) -> None:
    rows = [f"{k};1,234.5;12.5" for k in range(2100)]
    found = table(tmp_path, [*rows, "2100;1,2;3,5"])
    for column, cell in (("c1", "1,2"), ("c2", "3,5")):
        with pytest.raises(InputError, match=rf"'{cell}' is no number .*line 2102"):
            found.numbers(column)
    whole = table(tmp_path, [*rows, "2100;-1,234,567.25;12"])
    assert whole.numbers("c1")[[0, -1]].tolist() == [1234.5, -1234567.25]


@pytest.mark.parametrize("cell", ["12.5", "1.23", "1.2345", "0.500", ".500", "1.234.5", "1234.567"])
@pytest.mark.parametrize("decimal", [",", None])
def test_a_stated_sign_of_thousands_parts_groups_only(
    cell: str, decimal: str | None, tmp_path: Path
) -> None:
    found = table(tmp_path, ["0;1.234", f"1;{cell}"], decimal=decimal, thousands=".")
    with pytest.raises(InputError, match="parts groups of three digits"):
        found.numbers("c1")
    grouped = table(tmp_path, ["0;1.234", "1;-12.345.678"], decimal=decimal, thousands=".")
    assert grouped.numbers("c1").tolist() == [1234, -12345678]


def test_the_sign_of_subtraction_is_that_of_a_negative_number(tmp_path: Path) -> None:
    found = table(tmp_path, ["0;\u22125", "1;\u22121,5", "2;2,5"])
    assert found.numbers("c1").tolist() == [-5, -1.5, 2.5]
    assert notation_of(["\u22121.234,5"], None, None) == Notation(",", ".")


@pytest.mark.parametrize("word", ["n/a", "N/A"])
def test_not_available_is_missing(word: str, tmp_path: Path) -> None:
    found = table(tmp_path, ["0;1", f"1;{word}", "2;3"])
    np.testing.assert_array_equal(found.numbers("c1"), [1, np.nan, 3])


def test_many_numbers_with_thousands_are_read_as_each_alone() -> None:
    values = np.random.default_rng(3).uniform(-1e7, 1e7, 2000).round(2)
    cells = [f"{value:,.2f}" for value in values]
    read, bad = numbers_of(pl.Series(cells), Notation(".", ","))
    assert not bad.any()
    np.testing.assert_array_equal(read, values)
