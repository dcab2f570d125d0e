"""The lines above the rows of files that grow: every row is read by those that it has."""

import json
import os
from pathlib import Path
from threading import Event
from typing import Any

import pytest

from rga.operation.sources.file_head import HeadFinder
from rga.operation.sources.folder import Folder
from rga.operation.sources.source import Outcome
from rga.records.mapping import RecordMapping


def append(path: Path, content: bytes) -> None:
    with path.open("ab") as file:
        file.write(content)


class Read:
    """Takes rows of files whose heads are found, each with its own."""

    def __init__(self, folder: Path, mapping: RecordMapping | None = None) -> None:
        self._path, self._finder = folder, HeadFinder(mapping or RecordMapping(), {"D1", "D2"})
        self.read: list[tuple[bytes, bytes]] = []
        self.whole: list[tuple[str, bytes]] = []
        self.takes_whole = False
        self.kept: dict[str, Any] = {}
        self.start()

    def start(self) -> None:
        """As when the service is started again: all that is known went through text."""
        known = json.loads(json.dumps(self.kept))
        self.folder = Folder(self._path, "*", self._finder, known)

    def receive(self, payloads: Any, cursor: Any = None) -> list[Outcome]:
        assert self.takes_whole, "these files have lines"
        self.whole += payloads
        self.kept |= cursor
        return []

    def receive_lines(self, where: str, head: bytes, lines: bytes, cursor: Any) -> list[Outcome]:
        self.read += [(head, line) for line in lines.splitlines()]
        self.kept |= cursor
        return []

    def cursor(self) -> dict[str, Any]:
        return self.kept

    def numbers(self) -> dict[str, Any]:
        return {}

    def look(self) -> str | None:
        """Take what is new; what is wrong with the folder."""
        return self.folder.look(self, Event())


@pytest.mark.parametrize("restarts", [False, True])
@pytest.mark.parametrize(
    ("head", "mapping"),
    [
        (b"time,D1\n,cm\n", None),
        (b"Logger X\nSerial 3\ntime,D1 (cm)\n", None),
        (b'"TOA5","a"\n"TIMESTAMP","D1"\n"TS","cm"\n"","Avg"\n', None),
        (b"a\nb\ntime;D1\n;cm\n", RecordMapping(header_line=3, units_line=4)),
    ],
)
def test_every_row_is_read_with_all_lines_above_the_first(
    tmp_path: Path, head: bytes, mapping: RecordMapping | None, restarts: bool
) -> None:
    rows, path = Read(tmp_path, mapping), tmp_path / "a.csv"
    lines = [f"2026-11-10T00:0{k}:00Z,{k}.5".encode() for k in range(4)]
    for line in head.splitlines(keepends=True):
        append(path, line)
        rows.look()
        assert rows.read == []
    for line in lines:
        append(path, line + b"\n")
        rows.look()
        if restarts:
            rows.start()
    assert rows.read == [(head, line) for line in lines]


@pytest.mark.parametrize("restarts", [False, True])
@pytest.mark.parametrize(
    ("head", "again", "then"),
    [
        (b"time,D1,D2\n", b"time,D1,D2\n", b"time,D1,D2\n"),
        (b"time,D1,D2\n", b"time,D2,D1\n", b"time,D2,D1\n"),
        (b"time,D1 (mm),D2\n", b"time,D1 (cm),D2\n", b"time,D1 (cm),D2\n"),
        (b"time,D1,D2\n,mm,mm\n", b"time,D1 (cm),D2 (cm)\n", b"time,D1 (cm),D2 (cm)\n"),
        (b"Logger X\ntime,D1,D2\n", b"time,D2,D1\n", b"Logger X\ntime,D2,D1\n"),
        (b"Logger X\ntime,D1,D2\n", b"Logger X\ntime,D2,D1\n", b"Logger X\ntime,D2,D1\n"),
        (b"time D1 D2\n", b"time D2 D1\n", b"time D2 D1\n"),
        (b"time,D1,D2\n,mm,cm\n", b"time,D1,D2\n", b"time,D1,D2\n,mm,cm\n"),
        (b"time,D1,D2\n,mm,cm\n", b"time,D2,D1\n", b"time,D2,D1\n,cm,mm\n"),
        (
            b'"TOA5","a"\n"TS","D1","D2"\n"TS","mm","cm"\n"","Avg","Smp"\n',
            b'"TS","D2","D1"\n',
            b'"TOA5","a"\n"TS","D2","D1"\n"TS","cm","mm"\n"","Smp","Avg"\n',
        ),
    ],
)
def test_rows_below_a_head_that_comes_again_are_read_by_it(
    tmp_path: Path, head: bytes, again: bytes, then: bytes, restarts: bool
) -> None:
    rows, path = Read(tmp_path), tmp_path / "a.csv"
    sign = b"," if b"," in head else b" "
    lines = [sign.join([b"2026-11-10T00:0%d:00Z" % k, b"1", b"2"]) for k in range(5)]
    append(path, head + lines[0] + b"\n")
    rows.look()
    append(path, lines[1] + b"\n" + again)
    rows.look()
    if restarts:
        rows.start()
        rows.look()
    append(path, lines[2] + b"\n")
    rows.look()
    if restarts:
        rows.start()
    append(path, lines[3] + b"\n" + again + lines[4] + b"\n")
    rows.look()
    heads = [head, head, then, then, then]
    assert rows.read == list(zip(heads, lines, strict=True))


def test_a_row_that_nothing_follows_is_read_when_its_file_rests(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.operation.sources.folder.ENDLESS", 0.0)
    rows = Read(tmp_path)
    append(tmp_path / "a.csv", b"time,D1\n2026-11-10T00:00:00Z,1.5")
    append(tmp_path / "b.csv", b"time,D1\n2026-11-10T00:01:00Z,1.5\n")
    for _ in range(3):
        rows.look()
    assert len(rows.read) == 2


def test_a_file_in_which_no_row_is_found_is_told(tmp_path: Path) -> None:
    rows = Read(tmp_path)
    append(tmp_path / "a.csv", b"nothing that is a row\n" * 30)
    assert "no row is found in it" in str(rows.look())
    assert rows.read == []


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> None:
    """What rests is waited for until it is there at two looks."""
    monkeypatch.setattr("rga.operation.sources.folder.ENDLESS", 0.0)


def test_a_file_that_ends_within_its_stated_head_is_given_as_a_whole_once(
    tmp_path: Path, patient: None
) -> None:
    read = Read(tmp_path, RecordMapping(header_line=3))
    read.takes_whole = True
    append(tmp_path / "a.csv", b"1,5\n2,6\n")
    # Nothing else is there: its logger may still write the head, and it is told that it waits.
    assert read.look() is None
    assert read.look() == "a.csv: it ends within the lines above its rows"
    assert read.whole == []
    os.utime(tmp_path / "a.csv", (1, 1))
    append(tmp_path / "b.csv", b"Logger X\n\ntime,D1\n0,1\n")
    for _ in range(3):
        assert read.look() is None
    read.start()
    for _ in range(3):
        assert read.look() is None
    assert read.whole == [("a.csv", b"1,5\n2,6\n")]
    assert [line for _, line in read.read] == [b"0,1"]
    # A head that is completed after all has rows.
    append(tmp_path / "a.csv", b"time,D1\n3,7\n")
    read.look()
    assert read.read[-1] == (b"1,5\n2,6\ntime,D1\n", b"3,7")
    assert len(read.whole) == 1


def test_a_file_that_has_its_head_and_no_row_yet_waits(tmp_path: Path, patient: None) -> None:
    read = Read(tmp_path, RecordMapping(header_line=3))
    for name in "ab":
        append(tmp_path / f"{name}.csv", b"Logger X\n\ntime,D1\n")
    for _ in range(3):
        assert read.look() is None
    append(tmp_path / "a.csv", b"0,1\n")
    assert read.look() is None
    assert [line for _, line in read.read] == [b"0,1"]
    # One that is being written waits without a word.
    append(tmp_path / "c.csv", b"Logger X\n")
    assert read.look() is None
