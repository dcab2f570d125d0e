"""Files that are written whole or not at all."""

from collections.abc import Mapping
from contextlib import suppress
from errno import EISDIR
from pathlib import Path

from rga.errors import InputError


def write_whole(files: Mapping[Path, bytes]) -> None:
    """Write files under temporary names beside them, and rename them when all are written.

    Args:
        files: contents by path; directories are made where they are missing.

    Raises:
        InputError: one cannot be written; no draft of another stays.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_whole({Path(folder) / "a.txt": b"1", Path(folder) / "b.txt": b"2"})
    ...     sorted(path.name for path in Path(folder).iterdir())
    ['a.txt', 'b.txt']
    """
    drafts = {path: path.with_name(path.name + ".partial") for path in files}
    path = next(iter(files), Path())
    try:
        for path, draft in drafts.items():
            if path.is_dir():
                raise IsADirectoryError(EISDIR, "it is a directory")
            path.parent.mkdir(parents=True, exist_ok=True)
            draft.write_bytes(files[path])
        for path, draft in drafts.items():
            draft.replace(path)
    except OSError as error:
        for draft in drafts.values():
            with suppress(OSError):
                draft.unlink()
        reason = (error.strerror or "refused").lower()
        what = f"the output cannot be written, {reason}"
        raise InputError(what, str(path), "give another place") from None
