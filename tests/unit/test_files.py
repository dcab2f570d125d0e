"""Files come whole or not at all."""

from pathlib import Path

import pytest

from rga.errors import InputError
from rga.files import write_whole


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
