"""A folder that loggers write to: every line is taken once, whatever becomes of the file."""

import json
import os
import random
import shutil
from collections.abc import Iterator
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from rga.operation.packets.packet import MOST_BYTES
from rga.operation.sources.file_head import HeadFinder
from rga.operation.sources.folder import Folder, Piece
from rga.operation.sources.source import Outcome
from rga.records.mapping import RecordMapping

HEAD = b"time,D1\n"
ONE_LINE = HeadFinder(RecordMapping(header_line=1, data_line=2))


class Rows:
    """Takes rows as a twin does: lines, whole payloads, and where each file is read on."""

    def __init__(self, folder: Path, files: str = "*", head: bytes = HEAD) -> None:
        self._folder, self._files, self._head = folder, files, head
        self.kept: dict[str, Any] = {}
        self.lines: list[bytes] = []
        self.whole: list[bytes] = []
        self.start()

    def start(self) -> None:
        """As when the service is started again: all that is known went through text."""
        finder = ONE_LINE if self._head else HeadFinder(RecordMapping(), headless=True)
        self.folder = Folder(self._folder, self._files, finder, json.loads(json.dumps(self.kept)))

    def receive(self, payloads: Any, cursor: Any = None) -> list[Outcome]:
        self.whole += [content for _, content in payloads]
        self.kept |= cursor
        return []

    def receive_lines(self, where: str, head: bytes, lines: bytes, cursor: Any) -> list[Outcome]:
        assert head == self._head
        self.lines += lines.splitlines()
        self.kept |= cursor
        return []

    def cursor(self) -> dict[str, Any]:
        return self.kept

    def numbers(self) -> dict[str, Any]:
        return {}

    def look(self) -> list[bytes]:
        """The lines that are new."""
        before = len(self.lines)
        self.fault = self.folder.look(self, Event())
        return self.lines[before:]


@pytest.fixture
def rows(tmp_path: Path) -> Rows:
    return Rows(tmp_path)


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A last line without an end is waited for until it is there at two looks."""
    monkeypatch.setattr("rga.operation.sources.folder.ENDLESS", 0.0)
    return


def append(path: Path, text: bytes) -> None:
    with path.open("ab") as file:
        file.write(text)


def test_lines_are_taken_as_they_come(tmp_path: Path, rows: Rows) -> None:
    path = tmp_path / "a.csv"
    append(path, b"time,")
    assert rows.look() == []
    append(path, b"D1\n0,1\n1,")
    assert rows.look() == [b"0,1"]
    assert rows.look() == []
    append(path, b"2\n2,3\n")
    # Another process goes on where this one was.
    rows.start()
    assert rows.look() == [b"1,2", b"2,3"]
    assert rows.look() == []


def test_a_file_of_another_name_is_the_same_file(tmp_path: Path, rows: Rows) -> None:
    path = tmp_path / "a.csv"
    append(path, HEAD + b"0,1\n")
    rows.look()
    path.rename(tmp_path / "b.csv")
    append(tmp_path / "b.csv", b"1,2\n")
    append(path, HEAD + b"2,3\n")
    assert sorted(rows.look()) == [b"1,2", b"2,3"]


def test_a_file_that_was_replaced_is_read_anew(tmp_path: Path, rows: Rows) -> None:
    path = tmp_path / "a.csv"
    append(path, HEAD + b"0,1\n1,2\n")
    rows.look()
    path.write_bytes(HEAD + b"5,6\n")
    assert rows.look() == [b"5,6"]
    (tmp_path / "new").write_bytes(HEAD + b"7,8\n8,9\n")
    (tmp_path / "new").rename(path)
    assert rows.look() == [b"7,8", b"8,9"]
    # In place, and longer than before.
    path.write_bytes(HEAD + b"1,1\n2,2\n3,3\n")
    assert rows.look() == [b"1,1", b"2,2", b"3,3"]


def test_a_file_that_was_cut_is_read_anew(tmp_path: Path, rows: Rows) -> None:
    path = tmp_path / "a.csv"
    append(path, HEAD + b"0,1\n1,2\n2,3\n")
    rows.look()
    os.truncate(path, len(HEAD))
    assert rows.look() == []
    append(path, b"3,4\n")
    assert rows.look() == [b"3,4"]


def test_a_folder_that_is_away_is_not_empty(tmp_path: Path) -> None:
    share, away = tmp_path / "share", tmp_path / "away"
    share.mkdir()
    append(share / "a.csv", HEAD + b"0,1\n")
    rows = Rows(share)
    rows.look()
    share.rename(away)
    assert rows.look() == []
    assert rows.fault == f"{share} is away"
    share.mkdir()
    assert rows.look() == []
    assert rows.fault == "the folder is empty, and was not: a share may be away"
    # A share that comes back may number its files anew.
    shutil.copytree(away, share, dirs_exist_ok=True)
    append(share / "a.csv", b"1,2\n")
    assert rows.look() == [b"1,2"]
    assert rows.fault is None


def test_an_empty_folder_is_no_fault(rows: Rows) -> None:
    assert rows.look() == []
    assert rows.fault is None


@pytest.mark.parametrize("seed", range(4))
def test_a_storm_of_changes_doubles_nothing(tmp_path: Path, rows: Rows, seed: int) -> None:
    draw, written, replaced, renamed = random.Random(seed), 0, False, False
    path = tmp_path / "0.csv"
    append(path, HEAD)
    for k in range(1, 300):
        if draw.random() < 0.5:
            append(path, b"%d,1\n" % written)
            written += 1
        elif draw.random() < 0.5 and not replaced:
            path, renamed = path.rename(tmp_path / f"{k}.csv"), True
        elif not renamed:
            # Another file takes its place that begins as it does, as where it is copied anew.
            replaced = True
            again = tmp_path / "again"
            again.write_bytes(path.read_bytes())
            again.rename(path)
        if draw.random() < 0.1:
            rows.look()
            replaced = renamed = False
    rows.look()
    assert rows.lines == [b"%d,1" % k for k in range(written)]


def test_a_last_line_without_an_end_waits_for_it(tmp_path: Path, rows: Rows, patient: None) -> None:
    path = tmp_path / "a.csv"
    append(path, HEAD + b"0,1\n1,2")
    for _ in range(3):
        rows.look()
    assert rows.lines == [b"0,1"]
    assert rows.fault == "a.csv: its last line has no end"
    append(path, b"5\n")
    assert rows.look() == [b"1,25"]
    assert rows.fault is None


def test_a_last_line_ends_where_the_logger_goes_on_in_another_file(
    tmp_path: Path, rows: Rows, patient: None
) -> None:
    append(tmp_path / "a.csv", HEAD + b"0,1\n1,2")
    os.utime(tmp_path / "a.csv", (1, 1))
    append(tmp_path / "b.csv", HEAD + b"2,3\n")
    for _ in range(3):
        rows.look()
    assert sorted(rows.lines) == [b"0,1", b"1,2", b"2,3"]
    assert rows.fault is None


def test_a_line_that_never_ends_is_told(
    tmp_path: Path, rows: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.operation.sources.folder._LONGEST", 20)
    append(tmp_path / "a.csv", HEAD + b"0,1\n" + b"1" * 100)
    assert rows.look() == [b"0,1"]
    assert rows.fault == "a.csv: a line has more than 20 bytes"


def test_a_long_file_comes_in_pieces(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr("rga.operation.sources.folder._LONGEST", 20)
    append(tmp_path / "a.csv", HEAD + b"".join(b"%d,1\n" % k for k in range(50)))
    pieces = list(Folder(tmp_path, "*", ONE_LINE).pieces())
    assert len(pieces) > 5
    # After any of them the rest is left.
    rest = Folder(tmp_path, "*", ONE_LINE, pieces[2].cursor).pieces()

    def count(parts: Any) -> int:
        return sum(len(one.content.splitlines()) for one in parts)

    assert count(pieces[:3]) + count(rest) == 50


def test_what_was_not_kept_comes_again(tmp_path: Path) -> None:
    append(tmp_path / "a.csv", HEAD + b"0,1\n")
    folder = Folder(tmp_path, "*", ONE_LINE)
    first: Piece = next(folder.pieces())
    assert next(folder.pieces()) == first
    assert list(folder.pieces()) == [first]
    assert list(folder.pieces()) == []


def test_very_many_files_are_read_once(tmp_path: Path, rows: Rows) -> None:
    for k in range(2000):
        append(tmp_path / f"{k}.csv", HEAD + b"%d,1\n" % k)
    assert len(rows.look()) == 2000
    opened = rows.folder._pieces_of
    rows.folder._pieces_of = lambda *_, **__: pytest.fail("it is read again")  # type: ignore[method-assign]
    assert rows.look() == []
    rows.folder._pieces_of = opened  # type: ignore[method-assign]
    append(tmp_path / "77.csv", b"x,1\n")
    assert rows.look() == [b"x,1"]


def test_links_in_a_circle_are_left_alone(tmp_path: Path) -> None:
    append(tmp_path / "a.csv", HEAD + b"0,1\n")
    (tmp_path / "loop").symlink_to(tmp_path, target_is_directory=True)
    (tmp_path / "one.csv").symlink_to(tmp_path / "two.csv")
    (tmp_path / "two.csv").symlink_to(tmp_path / "one.csv")
    (tmp_path / "gone.csv").symlink_to(tmp_path / "nowhere")
    rows = Rows(tmp_path, "**/*.csv")
    assert rows.look() == [b"0,1"]
    assert "cannot be read" in str(rows.fault)


def test_a_file_that_cannot_be_read_keeps_no_other_from_it(
    tmp_path: Path, rows: Rows, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in "ab":
        append(tmp_path / f"{name}.csv", HEAD + b"0,%s\n" % name.encode())
    opened = Path.open

    def refuse(path: Path, *rest: Any) -> Any:
        if path.name == "a.csv":
            raise PermissionError(13, "Permission denied")
        return opened(path, *rest)

    monkeypatch.setattr(Path, "open", refuse)
    assert rows.look() == [b"0,b"]
    assert rows.fault == "a.csv: it cannot be read: Permission denied"


def test_other_files_are_taken_when_they_have_stopped_growing(tmp_path: Path, rows: Rows) -> None:
    path = tmp_path / "a.parquet"
    append(path, b"PAR1 half")
    rows.look()
    assert rows.whole == []
    append(path, b" whole PAR1")
    rows.look()
    assert rows.whole == []
    rows.look()
    assert rows.whole == [b"PAR1 half whole PAR1"]
    rows.start()
    for _ in range(3):
        rows.look()
    assert len(rows.whole) == 1


def test_json_and_what_is_no_text_is_taken_as_a_whole(tmp_path: Path, rows: Rows) -> None:
    for name, content in (("a", b'{"v": 1}'), ("b", b"\x81\xa1v\x01"), ("c", b"\x89PNG\n\0\n")):
        append(tmp_path / name, content)
    append(tmp_path / ".draft", b"{")
    rows.look()
    rows.look()
    assert sorted(rows.whole) == [b'{"v": 1}', b"\x81\xa1v\x01", b"\x89PNG\n\0\n"]
    with (tmp_path / "d").open("wb") as file:
        file.write(b"PAR1")
        file.truncate(MOST_BYTES + 1)
    rows.look()
    assert "d: it has 8388609 bytes" in str(rows.fault)


def test_line_protocol_has_no_head(tmp_path: Path) -> None:
    rows = Rows(tmp_path, head=b"")
    rows.folder = Folder(tmp_path, "*", ONE_LINE)
    append(tmp_path / "a", b"air v=1 1795392000\n")
    assert rows.look() == [b"air v=1 1795392000"]


@pytest.mark.parametrize("is_file", [True, False])
def test_links_that_lead_out_of_the_folder_are_not_followed(tmp_path: Path, is_file: bool) -> None:
    logger, other = tmp_path / "logger", tmp_path / "other"
    logger.mkdir()
    other.mkdir()
    append(logger / "a.csv", HEAD + b"0,1\n")
    append(other / "secret.csv", HEAD + b"1,2\n")
    link = logger / ("b.csv" if is_file else "b")
    link.symlink_to(other / "secret.csv" if is_file else other)
    rows = Rows(logger, "*.csv" if is_file else "*/*.csv")
    assert rows.look() == ([b"0,1"] if is_file else [])
    name = "b.csv" if is_file else "b/secret.csv"
    assert rows.fault == f"{name}: it is a link that leads out of the folder: not followed"
    link.unlink()
    rows.look()
    assert rows.fault is None


def test_links_within_the_folder_are_followed_also_where_it_is_a_link_itself(
    tmp_path: Path,
) -> None:
    logger = tmp_path / "disk"
    logger.mkdir()
    append(logger / "kept.txt", HEAD + b"0,1\n")
    (logger / "a.csv").symlink_to(logger / "kept.txt")
    (tmp_path / "logger").symlink_to(logger)
    rows = Rows(tmp_path / "logger", "*.csv")
    assert rows.look() == [b"0,1"]
    assert rows.fault is None
