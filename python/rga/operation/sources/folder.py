"""A folder that loggers write files to: what is new in them, line by line where they grow."""

from collections.abc import Iterator
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from rga.operation.packets.packet import MOST_BYTES

#: bytes at the head of a file by which it is known when it has another name
HEAD = 1024
#: of a payload, so that its head has room as well
_LONGEST = MOST_BYTES // 2
#: first bytes of files that are written as a whole
_WHOLE = (b"PAR1", b"TDSm", b"MATLAB", b"\x89HDF")


@dataclass(frozen=True)
class Piece:
    """What is new in a file.

    Attributes:
        where: the file.
        payload: its head, and lines that are new; or all of it.
        cursor: of the folder when the piece is kept.
    """

    where: str
    payload: bytes
    cursor: dict[str, Any]


class Folder:
    """The files of a folder, as far as they were read.

    A file is known by its number on the disk and its first bytes, whatever it is called; one that
    was replaced is read anew. A line is read when its end is there, a file that is no text when
    it has stopped growing.

    Args:
        path: of the folder.
        files: names of the files, * for any text.
        head_lines: before the first row of a text file.
    """

    def __init__(self, path: Path, files: str, head_lines: int) -> None:
        self._path, self._files, self._head_lines = path, files, head_lines
        self._sizes: dict[str, int] = {}

    @property
    def is_there(self) -> bool:
        """Whether the folder can be looked at: a share may not be mounted."""
        return self._path.is_dir()

    def pieces(self, cursor: dict[str, Any] | None) -> Iterator[Piece]:
        """What is new since a cursor, oldest file first.

        Args:
            cursor: of the last piece that was kept; None: all is new.
        """
        known = dict(cursor or {})
        files = [one for one in self._path.glob(self._files) if one.is_file()]
        for path in sorted(files, key=lambda one: (one.stat().st_mtime_ns, one.name)):
            with path.open("rb") as file:
                head = file.read(HEAD)
            if head.startswith(_WHOLE):
                yield from self._whole(path, known)
            else:
                yield from self._lines(path, known)

    def _whole(self, path: Path, known: dict[str, Any]) -> Iterator[Piece]:
        size, before = path.stat().st_size, self._sizes.get(path.name)
        self._sizes[path.name] = size
        if size != before or size > MOST_BYTES:
            return
        content = path.read_bytes()
        key, mark = _key(path), sha256(content).hexdigest()
        if known.get(key) != mark:
            known[key] = mark
            yield Piece(path.name, content, dict(known))

    def _lines(self, path: Path, known: dict[str, Any]) -> Iterator[Piece]:
        key = _key(path)
        with path.open("rb") as file:
            head = b"".join(file.readline(_LONGEST) for _ in range(self._head_lines))
            begin, mark = len(head), sha256(head[:HEAD]).hexdigest()
            before = known.get(key)
            offset = begin
            if isinstance(before, list) and before[0] == mark and before[1] <= path.stat().st_size:
                offset = before[1]
            if not head.endswith(b"\n"):
                return
            file.seek(offset)
            while end := (content := file.read(_LONGEST)).rfind(b"\n") + 1:
                offset += end
                file.seek(offset)
                known[key] = [mark, offset]
                yield Piece(path.name, head + content[:end], dict(known))


def _key(path: Path) -> str:
    stat = path.stat()
    return f"{stat.st_dev}:{stat.st_ino}"
