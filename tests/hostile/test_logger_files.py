"""Files of loggers that are spoiled in one to three ways, and read with and without a model."""

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hostile.logger_files import made
from hostile.spoiling import damaged, respelled

MODEL = "{}/model.json"
#: cases in every run; and cases of a test, and how many tests there are, at full length
FEW, CASES, TESTS = 20, 60, 40
#: numbers that stand where lengths, kinds, places and times do, by how they are written
NUMBERS: tuple[tuple[str, tuple[float, ...]], ...] = (
    ("<i", (0, 1, -1, 2, 3, 5, 9, 16, 17, 100, 2**16, 2**31 - 1, -(2**31))),
    ("<I", (14, 15, 0x21, 0x44, 0x69, 2**28, 2**30)),
    ("<q", (0, -1, 2**31, 2**40, 2**62, 2**63 - 1, -(2**63))),
    ("<d", (float("nan"), float("inf"), -1.0, 0.0, 1e300, 5e-324, 1e15)),
    ("<f", (float("nan"), float("inf"), 1e30)),
    ("<h", (0, -1, 1, 300, 2**15 - 1)),
    ("<B", (0, 1, 4, 6, 14, 255)),
)
NAMES = (
    "waveform.tdms", "timed.tdms", "plain.mat", "packed.mat", "old.mat", "wide.bin", "short.bin",
    "steps.bin", "table.parquet", "catman.asc", "labview.lvm", "logger.dat", "machine.dat",
    "points.lp", "pack.json", "observations.json",
)  # fmt: skip
TEXTS = ("*", "1e400", "[", "{", '"', "***End_of_Header***", "TOA5", "\t\t", "-1", "nan")


@pytest.fixture(scope="module")
def files(sound: Path) -> dict[str, bytes]:
    return made(sound / "record.csv")


def renumbered(content: bytes, draw: np.random.Generator) -> bytes:
    """Bytes of which one number, mostly of the head, is another."""
    kind, values = NUMBERS[draw.integers(len(NUMBERS))]
    number = values[draw.integers(len(values))]
    packed = struct.pack(kind, number if kind in "<d<f" else int(number))
    within = len(content) if draw.random() < 0.4 else min(len(content), 1500)
    place = int(draw.integers(max(1, within - len(packed))))
    return content[:place] + packed + content[place + len(packed) :]


def drawn(number: int, files: dict[str, bytes]) -> tuple[tuple[str, ...], dict[str, bytes]]:
    """The command line of a case, and the file that it is spoiled by."""
    draw = np.random.default_rng([number, 3])
    name = NAMES[draw.integers(len(NAMES))]
    content = files[name]
    as_text = name.endswith((".asc", ".lvm", ".dat", ".lp", ".json"))
    if as_text and draw.random() < 0.7:
        content = respelled(content.decode(), draw, TEXTS).encode("utf-8", "surrogatepass")
    else:
        for _ in range(int(draw.integers(1, 4))):
            other = damaged if as_text or draw.random() < 0.4 else renumbered
            content = other(content, draw)
    command = (
        ("import-record", f"{{}}/{name}", "--model", MODEL, "-o", "{}/out/import.toml"),
        ("diagnose", MODEL, f"{{}}/{name}", "-o", "{}/out"),
    )
    return command[int(draw.random() < 0.5)], {name: content}


@pytest.mark.parametrize("name", NAMES)
def test_what_is_not_spoiled_is_read(
    name: str, files: dict[str, bytes], given: Callable[..., object], judged: Callable[..., object]
) -> None:
    words = ("import-record", f"{{}}/{name}", "--model", MODEL, "-o", "{}/out/import.toml")
    case = given(words, {name: files[name]})
    came = judged(case)
    assert (came.code, came.faults) == (0, []), came.said


def test_some_spoiled_logger_files(
    files: dict[str, bytes], judged_all: Callable[..., None]
) -> None:
    judged_all(range(FEW), lambda number: drawn(number, files))


@pytest.mark.thorough
@pytest.mark.parametrize("place", range(1, TESTS + 1))
def test_spoiled_logger_files(
    place: int, files: dict[str, bytes], judged_all: Callable[..., None]
) -> None:
    judged_all(range(CASES * place, CASES * (place + 1)), lambda number: drawn(number, files))
