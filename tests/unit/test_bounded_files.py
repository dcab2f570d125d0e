"""What is read: files of a disk, of a size that fits, of values that can be counted."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import rga
from rga.bounded_files import bytes_of
from rga.errors import InputError
from rga.findings import load_findings
from rga.model import io
from rga.records.mapping import read_mapping
from rga.simulation.dataset import write_dataset
from rga.twin import Settings
from rga.twin.settings import as_settings

READERS: dict[str, Callable[[Path], Any]] = {
    ".json": rga.load_model,
    ".yaml": rga.load_model,
    ".toml": read_mapping,
    ".settings": as_settings,
    ".findings": load_findings,
    ".csv": lambda path: rga.load_record(path, rga.ModelBuilder("none").build()),
}


@pytest.mark.parametrize("ending", READERS)
def test_what_never_ends_is_not_read(ending: str, tmp_path: Path) -> None:
    pipe = tmp_path / f"pipe{ending}"
    os.mkfifo(pipe)
    endless = tmp_path / f"endless{ending}"
    endless.symlink_to("/dev/zero")
    for path in (pipe, endless):
        with pytest.raises(InputError, match="no file of a disk"):
            READERS[ending](path)


def test_more_than_fits_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "large"
    path.write_bytes(b"0123456789")
    assert bytes_of(path, largest=10) == b"0123456789"
    with pytest.raises(InputError, match="has more than 0 MiB"):
        bytes_of(path, largest=9)
    with pytest.raises(InputError, match="cannot be read, embedded null byte"):
        bytes_of(Path("a\0b"))


@pytest.mark.parametrize("ending", [".json", ".toml", ".settings", ".findings"])
def test_what_stands_deep_within_itself_is_refused(ending: str, tmp_path: Path) -> None:
    path = tmp_path / f"deep{ending}"
    deep = "[" * 100_000
    path.write_text(f"a = {deep}" if ending == ".toml" else deep, encoding="utf-8")
    with pytest.raises(InputError, match="too deep in one another"):
        READERS[ending](path)


def test_aliases_that_make_too_much_of_little_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    lines = ["a0: &a0 [0, 0, 0, 0, 0, 0, 0, 0, 0]"]
    lines += [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]" for k in range(1, 10)]
    path.write_text("\n".join(lines), encoding="utf-8")
    with pytest.raises(InputError, match="aliases make more than"):
        rga.load_model(path)
    path.write_text("a: &a [*a]", encoding="utf-8")
    with pytest.raises(InputError, match="aliases make more than"):
        rga.load_model(path)
    path.write_text("a: &a {b: 1}\nc: *a", encoding="utf-8")
    assert io._parse(path.read_bytes(), ".yaml") == {"a": {"b": 1}, "c": {"b": 1}}


def test_what_no_disk_holds_is_not_begun(small_bridge: dict[str, Any], tmp_path: Path) -> None:
    model = io.read_model(small_bridge, "small bridge")
    with pytest.raises(InputError, match="and the disk has"):
        write_dataset(model, 10**20, tmp_path / "data.parquet")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    "wanted",
    [{"distinct": float("inf")}, {"design_rows": 10**7}, {"training": {"width": 100_000}}],
)
def test_settings_that_no_machine_can_follow_are_refused(wanted: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"less than or equal|finite"):
        Settings.model_validate(wanted)
