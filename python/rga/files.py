"""Files that are written whole or not at all."""

import shutil
from collections.abc import Mapping, Sequence
from contextlib import suppress
from errno import EISDIR
from io import BytesIO
from os import PathLike, sep
from pathlib import Path
from typing import TYPE_CHECKING

from rga.errors import InputError, kind_of
from rga.inputs import is_input

if TYPE_CHECKING:
    import polars as pl


class CannotWrite(InputError):
    """The disk or its rights do not let something be written."""

    def __init__(self, what: str, where: str, remedy: str = "give another place") -> None:
        super().__init__(what, where, remedy)


def cannot_write(error: OSError, path: Path) -> CannotWrite:
    """The error of an output that the system does not let be written.

    >>> str(cannot_write(OSError(28, "No space left on device"), Path("out.csv")))
    'the output cannot be written, no space left on device (out.csv): give another place'
    """
    reason = (error.strerror or "refused").lower()
    return CannotWrite(f"the output cannot be written, {reason}", str(path))


def as_path(given: object, where: str) -> Path:
    """A path as a caller gives it.

    Args:
        given: it.
        where: it is given, for an error.

    Raises:
        InputError: this is none.

    >>> as_path(None, "directory")
    Traceback (most recent call last):
    rga.errors.InputError: None is no path (directory): give that of a file or a directory
    """
    if not isinstance(given, str | PathLike):
        what = f"{kind_of(given)} is no path"
        raise InputError(what, where, "give that of a file or a directory")
    return Path(given)


def as_file(given: object, where: str = "output") -> Path:
    """The path of a file to write, as a caller gives it.

    Raises:
        InputError: this is none, or that of a directory, which a path itself does not show.

    >>> as_file("rows.csv/")
    Traceback (most recent call last):
    rga.errors.InputError: 'rows.csv/' names a directory (output): leave out the slash at its end
    """
    path = as_path(given, where)
    if str(given).endswith(("/", sep)):
        what = f"{str(given)!r} names a directory"
        raise InputError(what, where, "leave out the slash at its end")
    return path


def check_place(path: Path) -> None:
    """Refuse as the place of a file what would be gone then: a device, a pipe, an input.

    Raises:
        CannotWrite: it is one.

    >>> check_place(Path("/dev/null"))
    Traceback (most recent call last):
    rga.files.CannotWrite: the output is no file of a disk (/dev/null): give another place
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        raise CannotWrite("the output is no file of a disk", str(path))
    if is_input(path):
        raise CannotWrite("the output would replace a file that was read", str(path))


def made_directory(directory: str | Path) -> Path:
    """The directory, made where it is missing.

    Raises:
        InputError: this is no path.
        CannotWrite: it cannot be made.
    """
    directory = as_path(directory, "directory")
    if directory.exists() and not directory.is_dir():
        raise CannotWrite("the output cannot be written, it is a file", str(directory))
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(error, directory) from None
    return directory


def write_whole(files: Mapping[Path, bytes]) -> None:
    """Write files under temporary names beside them, and rename them when all are written.

    Args:
        files: contents by path; directories are made where they are missing.

    Raises:
        CannotWrite: one cannot be written; no draft of another stays, nor a directory without any.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_whole({Path(folder) / "a.txt": b"1", Path(folder) / "b.txt": b"2"})
    ...     sorted(path.name for path in Path(folder).iterdir())
    ['a.txt', 'b.txt']
    """
    drafts = {path: path.with_name(path.name + ".partial") for path in files}
    path, made = next(iter(files), Path()), list[Path]()
    try:
        for path, draft in drafts.items():
            check_place(path)
            if path.is_dir():
                raise IsADirectoryError(EISDIR, "it is a directory")
            made += [one for one in path.parents if not one.exists()]
            path.parent.mkdir(parents=True, exist_ok=True)
            draft.write_bytes(files[path])
        for path, draft in drafts.items():
            draft.replace(path)
    except BaseException as error:
        for draft in drafts.values():
            with suppress(OSError):
                draft.unlink()
        for one in made:
            with suppress(OSError):
                one.rmdir()
        if not isinstance(error, OSError):
            raise
        raise cannot_write(error, path) from None


def check_room(path: Path, wanted: float) -> None:
    """Whether a disk has room for what is to be written.

    Args:
        path: of the file; the directory that it is to lie in, or one above, is there.
        wanted: bytes.

    Raises:
        InputError: it has less.
    """
    place = next((one for one in path.absolute().parents if one.exists()), Path("/"))
    if wanted > (free := shutil.disk_usage(place).free):
        words = f"it would take {wanted / 1e9:.3g} GB, and the disk has {free / 1e9:.3g}"
        raise InputError(words, str(path), "ask for less, or name another disk")


def wrong_ending(path: Path, what: str, endings: Sequence[str]) -> InputError:
    """The error of a file to write whose ending names no format.

    Args:
        path: of the file.
        what: it should hold.
        endings: of the formats that there are.

    >>> str(wrong_ending(Path("a.bmp"), "drawing", (".svg", ".png")))
    "'.bmp' is no format of a drawing (a.bmp): name a .svg or .png file"
    >>> wrong_ending(Path("a"), "table", (".csv", ".parquet")).what
    'the name of the table has no ending'
    """
    *others, last = endings
    remedy = f"name a {', '.join(others)} or {last} file"
    if path.is_dir():
        return InputError(f"the {what} cannot be written, it is a directory", str(path), remedy)
    if not path.suffix:
        return InputError(f"the name of the {what} has no ending", str(path), remedy)
    return InputError(f"{path.suffix!r} is no format of a {what}", str(path), remedy)


def write_table(table: "pl.DataFrame", path: str | Path) -> None:
    """Write a table as CSV or Parquet, by the ending of its file.

    Raises:
        InputError: another ending, or a place that cannot be written to.
    """
    path, content = as_file(path), BytesIO()
    if path.suffix.lower() == ".csv":
        table.write_csv(content)
    elif path.suffix.lower() == ".parquet":
        table.write_parquet(content)
    else:
        raise wrong_ending(path, "table", (".csv", ".parquet"))
    write_whole({path: content.getvalue()})
