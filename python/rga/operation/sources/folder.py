"""A folder that loggers write files to: what is new in them, line by line where they grow."""

import os
import stat
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from hashlib import sha256
from pathlib import Path
from threading import Event
from typing import Any, BinaryIO

from rga.operation.packets.native import is_native
from rga.operation.packets.packet import MOST_BYTES
from rga.operation.sources.file_head import (
    LOOKED_AT,
    HeadFinder,
    HeadLines,
    beginnings,
    completed,
)
from rga.operation.sources.source import Inlet

#: bytes at the head of a file, and before where it is read on, by which it is known again
HEAD = 1024
#: of a payload, so that its head has room as well
_LONGEST = MOST_BYTES // 2
#: how long a last line without an end is waited for [s]
ENDLESS = 60.0
#: lines after which a file without a row is told of
MANY_LINES = 20
#: first bytes of files that are written as a whole
_WHOLE = (b"PAR1", b"TDSm", b"MATLAB", b"\x89HDF", b"{", b"[")


@dataclass(frozen=True)
class Piece:
    """What is new in a file.

    Attributes:
        where: the file.
        head: lines above its rows; None: the file is read as a whole.
        content: lines that are new; or all of it.
        cursor: where the file is read on when the piece is kept.
    """

    where: str
    head: bytes | None
    content: bytes
    cursor: Mapping[str, Any]


@dataclass(frozen=True)
class _File:
    path: Path
    name: str
    key: str
    size: int
    changed: int


class Folder:
    """The files of a folder, as far as they were read.

    A file is known by its number on the disk, or by its name where a share that was away gives it
    another number; and it is the same file as long as its head, and what stands before the place
    where it is read on, are the same. One that was replaced or cut is read anew. A line is read
    when its end is there, a file that is no text or JSON when it has stopped growing, and so is one
    that ends within the lines that the mapping states above the rows, where the logger goes on in
    another. Files whose names begin with a dot are left alone, and links that lead out of the
    folder are not followed.

    Where the lines above the rows come again in a file, as a logger writes them that starts again,
    the rows below are read by them.

    Args:
        path: of the folder.
        files: names of the files, * for any text.
        heads: finds the lines above the rows of a text file.
        known: how far the files were read, as the cursors of pieces say it.
    """

    def __init__(
        self, path: Path, files: str, heads: HeadFinder, known: Mapping[str, Any] | None = None
    ) -> None:
        self._path, self._files, self._heads = path, files, heads
        self._known = dict(known or {})
        self._by_name = {state["name"]: state for state in self._known.values()}
        self._read: dict[str, tuple[int, int]] = {}
        self._resting: dict[str, tuple[tuple[int, int], float]] = {}
        self._faults: dict[str, str] = {}

    def look(self, inlet: Inlet, ending: Event) -> str | None:
        """Give what is new to an inlet; what is wrong with the folder, in words."""
        if not self._path.is_dir():
            return f"{self._path} is {'no folder' if self._path.exists() else 'away'}"
        for piece in self.pieces():
            if piece.head is None:
                inlet.receive([(piece.where, piece.content)], piece.cursor)
            else:
                inlet.receive_lines(piece.where, piece.head, piece.content, piece.cursor)
            if ending.is_set():
                break
        return self.fault

    @property
    def fault(self) -> str | None:
        """What is wrong with files, in words; None: nothing."""
        if not self._faults:
            return None
        name, words = next(iter(self._faults.items()))
        more = f", and {len(self._faults) - 1} more files" if len(self._faults) > 1 else ""
        return f"{name}: {words}{more}" if name else words

    def pieces(self) -> Iterator[Piece]:
        """What is new, oldest file first; whoever asks for another piece has kept the last."""
        self._faults.clear()
        files = self._listed()
        if self._known and not files:
            self._faults[""] = "the folder is empty, and was not: a share may be away"
        for number, file in enumerate(files):
            if self._read.get(file.key) == (file.size, file.changed):
                # It may have got another name.
                if file.key in self._known:
                    self._by_name[file.name] = self._known[file.key]
                continue
            try:
                yield from self._pieces_of(file, youngest=number == len(files) - 1)
            except FileNotFoundError:
                continue
            except OSError as error:
                self._faults[file.name] = f"it cannot be read: {error.strerror or error}"

    def _listed(self) -> list[_File]:
        """The files, oldest first."""
        found = []
        leads_out = _ways_out(self._path)
        for path in self._path.glob(self._files):
            name = path.relative_to(self._path).as_posix()
            if path.name.startswith("."):
                continue
            try:
                if leads_out(path.parent) or (path.is_symlink() and leads_out(path)):
                    self._faults[name] = "it is a link that leads out of the folder: not followed"
                    continue
                known = path.stat()
            except FileNotFoundError:
                continue
            except OSError as error:
                self._faults[name] = f"it cannot be read: {error.strerror or error}"
                continue
            if stat.S_ISREG(known.st_mode):
                key = str(known.st_ino)
                found.append(_File(path, name, key, known.st_size, known.st_mtime_ns))
        return sorted(found, key=lambda one: (one.changed, one.name))

    def _pieces_of(self, file: _File, youngest: bool) -> Iterator[Piece]:
        with file.path.open("rb") as opened:
            head = opened.read(HEAD)
            if head.startswith(_WHOLE) or b"\0" in head or is_native(head):
                yield from self._whole(file, opened)
            else:
                yield from self._lines(file, opened, youngest)

    def _whole(self, file: _File, opened: BinaryIO) -> Iterator[Piece]:
        if file.size > MOST_BYTES:
            self._faults[file.name] = f"it has {file.size} bytes, and {MOST_BYTES} are allowed"
            return
        if not self._rests(file, 0.0):
            return
        opened.seek(0)
        content = opened.read(MOST_BYTES + 1)
        mark = sha256(content).hexdigest()
        state = {"name": file.name, "mark": mark, "offset": len(content), "tail": ""}
        if all(before["mark"] != mark for before in self._states(file)):
            yield Piece(file.name, None, content, {file.key: state})
        self._keep(file, state)
        self._read[file.key] = file.size, file.changed

    def _lines(self, file: _File, opened: BinaryIO, youngest: bool) -> Iterator[Piece]:
        first = _whole_lines(opened, 0)
        found = self._heads.find(first)
        rests = found is None and self._rests(file, ENDLESS)
        if rests:
            first = _whole_lines(opened, 0, ended=False)
            found = self._heads.find(first)
        if found is None and rests and 0 < len(first) < self._heads.promised:
            if youngest:
                self._faults[file.name] = "it ends within the lines above its rows"
            else:
                # The logger goes on in another file: it is refused, as a record is that ends so.
                yield from self._whole(file, opened)
        if found is None:
            # It has no row yet, as a logger leaves it that has just begun.
            if len(first) > MANY_LINES:
                self._faults[file.name] = "no row is found in it: state header_line in import.toml"
            return
        above = first[: found.count]
        again = beginnings(above, found)
        opened.seek(0)
        count = self._heads.stated if found.count else 0
        stated = b"".join(opened.readline(_LONGEST) for _ in range(count))
        mark = sha256(stated[:HEAD]).hexdigest()
        begin = (0, sum(len(line) + 1 for line in above))
        offset, place = self._read_on(file, opened, mark, begin)
        head = _head(opened, place, above, found)
        while True:
            opened.seek(offset)
            content = opened.read(_LONGEST)
            end = content.rfind(b"\n") + 1
            if not end and content:
                if len(content) == _LONGEST:
                    self._faults[file.name] = f"a line has more than {_LONGEST} bytes"
                    return
                if not self._rests(file, ENDLESS):
                    return
                if youngest:
                    self._faults[file.name] = "its last line has no end"
                    return
                # The logger goes on in another file, so that this is all of the line.
                end = len(content)
            if not end:
                break
            other = again.search(content, 0, end) if again is not None else None
            if other is not None and other.start() == 0:
                more = _whole_lines(opened, offset)
                lines_again = self._heads.again(more, above, found)
                if lines_again is None:
                    return
                place = (offset, offset + sum(len(line) + 1 for line in more[:lines_again]))
                head, offset = _head(opened, place, above, found), place[1]
                continue
            if other is not None:
                end = other.start()
            lines, offset = content[:end], offset + end
            state = self._at(file, opened, mark, offset, place)
            yield Piece(file.name, head, lines, {file.key: state})
            self._keep(file, state)
        # It may have got another number.
        self._keep(file, self._at(file, opened, mark, offset, place))
        self._read[file.key] = file.size, file.changed

    def _at(
        self, file: _File, opened: BinaryIO, mark: str, offset: int, head: tuple[int, int]
    ) -> dict[str, Any]:
        """How far a file was read, and where the head of what follows stands."""
        tail = _tail(opened, offset)
        return {"name": file.name, "mark": mark, "offset": offset, "tail": tail, "head": [*head]}

    def _read_on(
        self, file: _File, opened: BinaryIO, mark: str, head: tuple[int, int]
    ) -> tuple[int, tuple[int, int]]:
        """Where a file is read on, and its head there: at its first row, if it is another file."""
        offset = head[1]
        for before in self._states(file):
            known = before["mark"] == mark and offset < before["offset"] <= file.size
            if known and before["tail"] == _tail(opened, before["offset"]):
                begin, end = before.get("head", head)
                offset, head = before["offset"], (begin, end)
        return offset, head

    def _states(self, file: _File) -> list[Any]:
        """How far the file was read of this number, and that of this name."""
        states = (self._known.get(file.key), self._by_name.get(file.name))
        return [one for one in states if one is not None]

    def _keep(self, file: _File, state: Any) -> None:
        self._known[file.key] = self._by_name[file.name] = state

    def _rests(self, file: _File, seconds: float) -> bool:
        """Whether a file has not changed for so long; it was at least once as it is."""
        now = time.monotonic()
        changed, since = self._resting.get(file.key, (None, now))
        if changed != (file.size, file.changed):
            self._resting[file.key] = (file.size, file.changed), now
            return False
        return now - since >= seconds


def _ways_out(folder: Path) -> Callable[[Path], bool]:
    """Whether a path leads out of a folder; each is followed once."""
    inside = os.path.realpath(folder)

    @cache
    def leads_out(path: Path) -> bool:
        return not Path(os.path.realpath(path)).is_relative_to(inside)

    return leads_out


def _whole_lines(opened: BinaryIO, offset: int, ended: bool = True) -> list[bytes]:
    """Lines from a place on, without their ends; one that has no end only if that is asked for."""
    opened.seek(offset)
    *lines, last = opened.read(LOOKED_AT).split(b"\n")
    return lines if ended or not last else [*lines, last]


def _head(
    opened: BinaryIO, place: tuple[int, int], above: Sequence[bytes], found: HeadLines
) -> bytes:
    """The lines above rows; of a head that came again, with what it lacks of the first."""
    opened.seek(place[0])
    head = opened.read(place[1] - place[0])
    if not place[0]:
        return head
    return b"".join(line + b"\n" for line in completed(head.split(b"\n")[:-1], above, found))


def _tail(opened: BinaryIO, offset: int) -> str:
    """Mark of what stands before a place."""
    begin = max(0, offset - HEAD)
    opened.seek(begin)
    return sha256(opened.read(offset - begin)).hexdigest()
