"""A disk that fills and places that cannot be written to: a line, and nothing is left."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

#: bytes that a file may have
ROOM = 30_000

LIMITED = f"""
import resource, signal, sys
from rga.cli import main
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, ({ROOM}, resource.RLIM_INFINITY))
main(sys.argv[1:])
"""


@pytest.fixture
def files(small_stream: Callable[..., Path]) -> Path:
    """A model, a record, settings of a run, and a list of bridges."""
    folder = small_stream(rows=100)
    (folder / "list.csv").write_text("name,model,record\nA,model.json,record.csv\n", "utf-8")
    return folder


def refused(code: str, *words: str | Path) -> str:
    """What a command says that is refused in a line."""
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, words)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2, done.stderr
    assert done.stderr.count("\n") == 1, done.stderr
    assert done.stderr.startswith("error: ")
    return done.stderr


COMMANDS = {
    "diagnose": ("diagnose", "{}/model.json", "{}/record.csv", "-o", "OUT"),
    "diagnose-many": ("diagnose-many", "{}/list.csv", "-o", "OUT", "--workers", "1"),
    "run": ("run", "{}/model.json", "{}/record.csv", "-o", "OUT", "--settings", "{}/settings.json"),
    "dataset": ("dataset", "{}/model.json", "-n", "2000", "-o", "OUT.parquet"),
    "example": ("example", "footbridge", "OUT"),
}


def words(name: str, folder: Path, out: Path) -> list[str]:
    return [one.replace("{}", str(folder)).replace("OUT", str(out)) for one in COMMANDS[name]]


@pytest.mark.parametrize(
    "name",
    [
        # A diagnosis alone stands for one of many.
        pytest.param(name, marks=[pytest.mark.thorough] if name == "diagnose-many" else [])
        for name in COMMANDS
    ],
)
def test_a_full_disk_is_told_in_a_line(name: str, files: Path, tmp_path: Path) -> None:
    said = refused(LIMITED, *words(name, files, tmp_path / "out"))
    assert "too large" in said or "full" in said or "fails" in said
    left = [path for path in tmp_path.rglob("*") if path.is_file()]
    # A dataset goes on with its parts, which are whole; a list says what kept its bridges.
    left = [path for path in left if path.parent.suffix != ".parts" and path.name != "summary.csv"]
    assert not left


@pytest.mark.parametrize("name", COMMANDS)
@pytest.mark.parametrize("place", ["x" * 300, "model.json/out"], ids=["too long", "in a file"])
def test_a_place_that_cannot_be_written(
    place: str, name: str, files: Path, tmp_path: Path, rga: Callable[..., Any]
) -> None:
    (tmp_path / "model.json").write_text("{}", "utf-8")
    done = rga(*words(name, files, tmp_path / place))
    assert (done.code, done.err.count("\n")) == (2, 1), done.err
    assert done.err.startswith("error: ")
    assert [path.name for path in tmp_path.iterdir()] == ["model.json"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is full")
@pytest.mark.parametrize(
    "more", [(), pytest.param(("--json",), marks=pytest.mark.thorough)], ids=["text", "JSON"]
)
def test_an_output_that_takes_nothing(more: tuple[str, ...], model_file: Path) -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "rga", "check", str(model_file), *more],
            stdout=full, stderr=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip
    assert done.returncode == 2
    assert (
        done.stderr == "error: no space left on device (the output): give another file or place\n"
    )


@pytest.mark.parametrize(
    "words",
    [
        ("schema", "model", "--json"),
        ("draw", "{}/model.json", "-o"),
        ("simulate", "{}/model.json", "{}/contexts.csv", "-o"),
        ("dataset", "{}/model.json", "-n", "3", "-o"),
    ],
    ids=lambda words: words[0],
)
def test_a_file_takes_the_place_of_no_pipe(
    words: tuple[str, ...], rga: Callable[..., Any], model_file: Path, tmp_path: Path
) -> None:
    pipe = tmp_path / ("pipe.svg" if words[0] == "draw" else "pipe.parquet")
    os.mkfifo(pipe)
    (model_file.parent / "contexts.csv").write_text("temperature,load\n3,5\n", "utf-8")
    done = rga(*(word.replace("{}", str(model_file.parent)) for word in words), pipe)
    assert (done.code, done.err.count("\n")) == (2, 1), done.err
    assert "no file of a disk" in done.err
    assert pipe.is_fifo()
