"""Files that are written whole or not at all."""

from collections.abc import Mapping
from pathlib import Path


def write_whole(files: Mapping[Path, bytes]) -> None:
    """Write files under temporary names beside them, and rename them when all are written.

    Args:
        files: contents by path; directories exist.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_whole({Path(folder) / "a.txt": b"1", Path(folder) / "b.txt": b"2"})
    ...     sorted(path.name for path in Path(folder).iterdir())
    ['a.txt', 'b.txt']
    """
    drafts = {path: path.with_name(path.name + ".partial") for path in files}
    for path, draft in drafts.items():
        draft.write_bytes(files[path])
    for path, draft in drafts.items():
        draft.replace(path)
