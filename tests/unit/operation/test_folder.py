"""A folder that loggers write to: every line is taken once, whatever becomes of the file."""

import json
from pathlib import Path
from typing import Any

from rga.operation.sources.folder import Folder

HEAD = b"time,D1\n"


def taken(folder: Folder, cursor: Any = None) -> tuple[list[bytes], Any]:
    """Rows that are new, and the cursor behind them."""
    rows = []
    for piece in folder.pieces(cursor):
        assert piece.payload.startswith(HEAD)
        rows += piece.payload.removeprefix(HEAD).splitlines()
        # It goes through a database as text.
        cursor = json.loads(json.dumps(piece.cursor))
    return rows, cursor


def append(path: Path, text: bytes) -> None:
    with path.open("ab") as file:
        file.write(text)


def test_lines_are_taken_as_they_come(tmp_path: Path) -> None:
    path, folder = tmp_path / "a.csv", Folder(tmp_path, "*.csv", head_lines=1)
    append(path, b"time,")
    assert taken(folder) == ([], None)
    append(path, b"D1\n0,1\n1,")
    rows, cursor = taken(folder)
    assert rows == [b"0,1"]
    assert taken(folder, cursor) == ([], cursor)
    append(path, b"2\n2,3\n")
    # Another process goes on where this one was.
    rows, cursor = taken(Folder(tmp_path, "*.csv", head_lines=1), cursor)
    assert rows == [b"1,2", b"2,3"]


def test_a_file_of_another_name_is_the_same_file(tmp_path: Path) -> None:
    path, folder = tmp_path / "a.csv", Folder(tmp_path, "*.csv", head_lines=1)
    append(path, HEAD + b"0,1\n")
    _, cursor = taken(folder)
    path.rename(tmp_path / "b.csv")
    append(tmp_path / "b.csv", b"1,2\n")
    assert taken(folder, cursor)[0] == [b"1,2"]


def test_a_file_that_was_replaced_is_read_anew(tmp_path: Path) -> None:
    path, folder = tmp_path / "a.csv", Folder(tmp_path, "*.csv", head_lines=1)
    append(path, HEAD + b"0,1\n1,2\n")
    _, cursor = taken(folder)
    path.write_bytes(HEAD + b"5,6\n")
    rows, cursor = taken(folder, cursor)
    assert rows == [b"5,6"]
    (tmp_path / "new").write_bytes(HEAD + b"7,8\n8,9\n")
    (tmp_path / "new").rename(path)
    assert taken(folder, cursor)[0] == [b"7,8", b"8,9"]


def test_a_folder_that_is_away_is_not_empty(tmp_path: Path) -> None:
    folder = Folder(tmp_path / "share", "*", head_lines=1)
    assert not folder.is_there
    assert taken(folder, {"1:2": ["x", 3]}) == ([], {"1:2": ["x", 3]})


def test_a_long_file_comes_in_pieces(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("rga.operation.sources.folder._LONGEST", 20)
    append(tmp_path / "a.csv", HEAD + b"".join(b"%d,1\n" % k for k in range(50)))
    folder = Folder(tmp_path, "*", head_lines=1)
    pieces = list(folder.pieces(None))
    assert len(pieces) > 5
    assert len(taken(folder)[0]) == 50
    # After any of them the rest is left.
    assert (
        len(taken(folder, pieces[2].cursor)[0])
        + sum(len(one.payload.splitlines()) - 1 for one in pieces[:3])
        == 50
    )


def test_other_files_are_taken_when_they_have_stopped_growing(tmp_path: Path) -> None:
    path, folder = tmp_path / "a.parquet", Folder(tmp_path, "*", head_lines=1)
    append(path, b"PAR1 half")
    assert list(folder.pieces(None)) == []
    append(path, b" whole PAR1")
    assert list(folder.pieces(None)) == []
    (piece,) = folder.pieces(None)
    assert piece.payload == b"PAR1 half whole PAR1"
    assert list(folder.pieces(piece.cursor)) == []
