"""Files and folders of the sources stay small enough to be read at a glance."""

from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCES = [
    path
    for folder in ("python", "rust", "tests", "tools")
    for ending in ("py", "rs")
    for path in (ROOT / folder).rglob(f"*.{ending}")
]
MOST_LINES, MOST_FILES = 400, 20


def too_long(paths: list[Path]) -> list[str]:
    lines = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in paths}
    return [f"{path}: {count} lines" for path, count in lines.items() if count > MOST_LINES]


def too_full(paths: list[Path]) -> list[str]:
    files = Counter(path.parent for path in paths)
    return [f"{folder}: {count} files" for folder, count in files.items() if count > MOST_FILES]


def test_no_file_is_long_and_no_folder_full() -> None:
    assert len(SOURCES) > 500
    assert too_long(SOURCES) == []
    assert too_full(SOURCES) == []


@pytest.mark.parametrize("beyond", [0, 1])
def test_one_beyond_a_limit_is_found(tmp_path: Path, beyond: int) -> None:
    paths = [tmp_path / f"{number}.py" for number in range(MOST_FILES + beyond)]
    for path in paths:
        path.write_text("pass\n" * (MOST_LINES + beyond), encoding="utf-8")
    assert len(too_long(paths)) == beyond * len(paths)
    assert len(too_full(paths)) == beyond
