"""Files come whole or not at all."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import rga
from rga.errors import InputError
from rga.files import as_file, as_path, made_directory, write_table, write_whole
from rga.records import Record


def test_where_one_cannot_be_written_all_stay_as_they_were(tmp_path: Path) -> None:
    kept, taken = tmp_path / "kept.txt", tmp_path / "taken.txt"
    kept.write_bytes(b"before")
    taken.mkdir()
    with pytest.raises(InputError, match="it is a directory") as told:
        write_whole({kept: b"after", taken: b"after"})
    assert str(taken) in str(told.value)
    assert kept.read_bytes() == b"before"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["kept.txt", "taken.txt"]
    with pytest.raises(InputError, match="cannot be written"):
        write_whole({kept / "a.txt": b"after"})


def test_directories_are_made_where_they_are_missing(tmp_path: Path) -> None:
    write_whole({tmp_path / "new" / "deeper" / "a.txt": b"after"})
    assert (tmp_path / "new" / "deeper" / "a.txt").read_bytes() == b"after"


def test_no_draft_stays_where_one_could_not_be_begun(tmp_path: Path) -> None:
    """A name that is too long has no draft to take away; those of the others go all the same."""
    long = tmp_path / ("x" * 300)
    with pytest.raises(InputError, match="too long"):
        write_whole({tmp_path / "new" / "a": b"1", long: b"2", tmp_path / "b": b"3"})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("given", [None, 3, b"out", ["out"]])
def test_what_is_no_path_is_refused_wherever_one_is_given(given: Any) -> None:
    record = Record(np.arange(2.0), 0.0, "seconds", ("A",), np.zeros((2, 1)))
    takers: list[Callable[[], object]] = [
        lambda: as_path(given, "output"),
        lambda: made_directory(given),
        lambda: record.write(given),
        lambda: rga.diagnose_many(given, "out"),
        lambda: rga.diagnose_many({}, given),
        lambda: rga.load_criteria(given),
        lambda: rga.load_findings(given),
        lambda: rga.LiveTwin(given),
        lambda: rga.Twin.open(given),
        lambda: rga.Worker([given]),
        lambda: rga.ModelBuilder("truss").write(given),
    ]
    for taker in takers:
        with pytest.raises(InputError, match="is no path"):
            taker()


@dataclass
class Named:
    """A path of another library."""

    name: str

    def __fspath__(self) -> str:
        return self.name


@pytest.mark.parametrize("given", ["a/b.csv", Path("a/b.csv"), Named("a/b.csv")])
def test_whatever_stands_for_a_path_is_one(given: Any) -> None:
    assert as_path(given, "output") == as_file(given) == Path("a/b.csv")


def test_a_file_does_not_end_like_a_directory(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="names a directory"):
        write_table(pl.DataFrame({"a": [1.0]}), f"{tmp_path}/new/a.csv/")
    assert list(tmp_path.iterdir()) == []
    assert made_directory(f"{tmp_path}/new/").is_dir()
