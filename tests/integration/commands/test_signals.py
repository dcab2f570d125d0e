"""Ctrl-C and SIGTERM end a command in a line; what it had done is gone on from."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from rga.cli.output import whole_file
from rga.cli.signals import Stopped, stopping

ENDED = {signal.SIGINT: (130, "interrupted"), signal.SIGTERM: (143, "terminated")}


def begun(*words: str | Path) -> subprocess.Popen[str]:
    """A command, in a group of processes of its own."""
    command = [sys.executable, "-m", "rga", *map(str, words)]
    return subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def until(process: subprocess.Popen[str], there: Callable[[], bool]) -> None:
    """Wait until something is there."""
    while not there():
        assert process.poll() is None, process.communicate()


@pytest.mark.parametrize(
    ("whom", "number"),
    [
        ("the process", signal.SIGTERM),
        ("its group", signal.SIGINT),
        pytest.param("the process", signal.SIGINT, marks=pytest.mark.thorough),
        pytest.param("its group", signal.SIGTERM, marks=pytest.mark.thorough),
    ],
)
def test_a_dataset_goes_on_where_a_signal_stopped_it(
    whom: str, number: signal.Signals, model_file: Path, tmp_path: Path
) -> None:
    target = tmp_path / "set.parquet"
    parts = tmp_path / "set.parquet.parts"
    words = ("dataset", model_file, "-n", "2000000", "-o", target, "--workers", "2")
    process = begun(*words)
    until(process, lambda: len(list(parts.glob("0*.parquet"))) > 1)
    (os.kill if whom == "the process" else os.killpg)(process.pid, number)
    _, said = process.communicate(timeout=20)
    code, word = ENDED[number]
    assert (process.returncode, said) == (
        code,
        f"{word}; the same command goes on where it stood\n",
    )
    kept = {file.name: file.stat().st_mtime_ns for file in parts.glob("0*.parquet")}
    assert not target.exists()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["model.json", parts.name]
    process = begun(*words)
    until(process, lambda: len(list(parts.glob("0*.parquet"))) > len(kept))
    process.kill()
    process.communicate()
    for name, written in kept.items():
        assert (parts / name).stat().st_mtime_ns == written


@pytest.mark.parametrize("number", ENDED)
def test_a_diagnosis_leaves_nothing(
    number: signal.Signals, small_stream: Callable[..., Path], tmp_path: Path
) -> None:
    folder = small_stream(rows=100)
    out = tmp_path / "out"
    process = begun("diagnose", folder / "model.json", folder / "record.csv", "-o", out)
    until(process, lambda: any(tmp_path.iterdir()))
    process.send_signal(number)
    said, error = process.communicate(timeout=20)
    code, word = ENDED[number]
    assert (process.returncode, said, error) == (code, "", f"{word}\n")
    assert list(tmp_path.iterdir()) == []


def test_a_signal_that_comes_with_the_first_directory_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    make = Path.mkdir

    def stopped(path: Path, *rest: Any, **more: Any) -> None:
        make(path, *rest, **more)
        if path.parent == tmp_path:
            raise Stopped(signal.SIGTERM)

    monkeypatch.setattr(Path, "mkdir", stopped)
    with pytest.raises(Stopped), whole_file(tmp_path / "out.json"):
        pytest.fail("nothing is written")
    assert list(tmp_path.iterdir()) == []


def test_what_a_library_swallowed_comes_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rga.cli.signals.AGAIN", 0.1)
    until = time.monotonic() + 20.0
    with pytest.raises(Stopped) as stopped, stopping():  # noqa: PT012
        with suppress(Stopped):
            signal.raise_signal(signal.SIGTERM)
        while time.monotonic() < until:
            pass
    assert stopped.value.code == 143
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_a_signal_where_python_passes_errors_over_comes_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Ended:
        def __init__(self, error: type[BaseException] | None) -> None:
            self.error = error

        def __del__(self) -> None:
            if self.error is not None:
                raise self.error
            signal.raise_signal(signal.SIGTERM)

    told: list[type[BaseException]] = []
    monkeypatch.setattr("sys.unraisablehook", lambda one: told.append(one.exc_type))
    monkeypatch.setattr("rga.cli.signals.AGAIN", 0.2)
    reached = False

    def passed_over() -> None:
        nonlocal reached
        Ended(ValueError)
        Ended(None)
        reached = True
        time.sleep(10)

    with pytest.raises(Stopped), stopping():
        passed_over()
    assert reached
    assert told == [ValueError]
