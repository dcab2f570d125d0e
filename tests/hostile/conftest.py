"""Files that are well formed, the many ways in which they can be spoiled, and what may come of it.

A command that is given one may do its work, or refuse it in a line: it never ends in a traceback,
hangs, takes much memory, or leaves something behind where it refuses.
"""

import json
import resource
import shutil
import signal
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import mkdtemp
from types import FrameType
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np
import polars as pl
import pytest

from rga.cli import main
from rga.model import load_model
from rga.simulation import Simulator

#: what a case may take: time of a processor [s], and memory beyond that of this process [bytes]
LONGEST, MOST = 10, 2**30
#: times as long on a clock, where other processes have the processors as well
WAITS = 6
#: rows of the record
ROWS = 60


@dataclass(frozen=True)
class Case:
    """A command line, in a folder of files of which one is spoiled.

    Attributes:
        words: of the command line; "{}" is the folder.
        folder: of the files.
        output: folder that is empty before, and that the command may write to.
        longest: time of a processor that it may take [s].
    """

    words: tuple[str, ...]
    folder: Path
    output: Path
    longest: int = LONGEST


@dataclass
class Came:
    """What came of a case: its exit code, what it says, and what is wrong with that."""

    code: int | None = None
    said: str = ""
    faults: list[str] = field(default_factory=list)


class TooLong(BaseException):
    """A case has taken too long."""


@contextmanager
def bounded(longest: int) -> Iterator[None]:
    """A block that may take some time and memory, and no more."""

    def stop(_number: int, _frame: FrameType | None) -> None:
        raise TooLong

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text("ascii").split()[0])
    timers = {signal.ITIMER_PROF: longest, signal.ITIMER_REAL: WAITS * longest}
    before = [signal.signal(number, stop) for number in (signal.SIGPROF, signal.SIGALRM)]
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + MOST, hard))
    for timer, most in timers.items():
        signal.setitimer(timer, most)
    try:
        yield
    finally:
        for timer in timers:
            signal.setitimer(timer, 0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        for number, handler in zip((signal.SIGPROF, signal.SIGALRM), before, strict=True):
            signal.signal(number, handler)


@pytest.fixture
def judged(capsys: pytest.CaptureFixture[str]) -> Callable[[Case], Came]:
    """Runs a case, and says what is wrong with what came of it."""

    def run(case: Case) -> Came:
        came = Came()
        capsys.readouterr()
        words = [word.replace("{}", str(case.folder)) for word in case.words]
        try:
            with bounded(case.longest), catch_warnings():
                # What is told of on the way to no number is no word of this package.
                simplefilter("error", RuntimeWarning)
                main(words)
        except SystemExit as left:
            came.code = int(left.code or 0)
        except TooLong:
            came.faults.append(f"it takes longer than {case.longest} s")
        except BaseException as error:
            place = error.__traceback__
            while place is not None and place.tb_next is not None:
                place = place.tb_next
            where = (
                "" if place is None else f"{place.tb_frame.f_code.co_filename}:{place.tb_lineno}"
            )
            came.faults.append(f"{type(error).__name__}: {str(error)[:200]} at {where}")
        out, err = capsys.readouterr()
        came.said = err
        if came.code == 2:
            lines = [one for one in err.splitlines() if not one.startswith("warning: ")]
            listed = [one for one in lines[1:] if not one.startswith("  ")]
            if words[0] in ("check", "import", "import-record"):
                # They list all that is wrong, as their result.
                err, listed = f"error: {out}{err}", []
            if "error: " not in err and "Usage" not in err:
                came.faults.append(f"it does not say why: {err[:200]!r}")
            elif listed and "Usage" not in err:
                came.faults.append(f"more than a line: {err[:300]!r}")
            left = [str(path.relative_to(case.output)) for path in case.output.rglob("*")]
            if words[0] == "diagnose-many":
                # It is where the errors of the bridges stand.
                left = [one for one in left if one != "summary.csv"]
            if words[0] == "import-record":
                # A mapping that somebody has to complete is written.
                left = []
            if left:
                came.faults.append(f"it leaves {left[:5]}")
        elif came.code not in (0, None) and not (came.code == 1 and out):
            came.faults.append(f"exit code {came.code}: {err[:200]!r}")
        if "Traceback" in err:
            came.faults.append("a traceback is printed")
        if case.output.is_dir():
            for path in case.output.rglob("findings.json"):
                try:
                    json.loads(path.read_text("utf-8"), parse_constant=_no_constant)
                except ValueError as error:
                    came.faults.append(f"findings: {error}")
        return came

    return run


def _no_constant(name: str) -> None:
    raise ValueError(f"{name} is no number")


@pytest.fixture(scope="session")
def sound(bars: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of files that nothing is wrong with."""
    model = deepcopy(bars)
    model["context"]["temperature"]["noise"] = 0.2
    model["sensors"]["S2"] = {**model["sensors"]["S1"], "member": "east"}
    folder = tmp_path_factory.mktemp("sound")
    (folder / "model.json").write_text(json.dumps(model), "utf-8")
    draw = np.random.default_rng(1)
    contexts = pl.DataFrame(
        {"temperature": draw.uniform(0, 20, ROWS), "load": draw.uniform(0, 1e5, ROWS)}
    )
    contexts.write_csv(folder / "contexts.csv")
    readings = Simulator(load_model(folder / "model.json")).predict(
        contexts.to_dict(as_series=False)
    )
    readings += draw.standard_normal(readings.shape) * [0.01, 0.5, 0.5]
    time = [f"2026-03-{1 + k // 24:02}T{k % 24:02}:00:00" for k in range(ROWS)]
    columns = {"time": time, "D1": readings[:, 0], "S1": readings[:, 1], "S2": readings[:, 2]}
    frame = pl.DataFrame(columns | {"temperature": contexts["temperature"]})
    frame.write_csv(folder / "record.csv")
    frame.with_columns(pl.col("time").str.to_datetime()).write_parquet(folder / "record.parquet")
    (folder / "list.csv").write_text("name,model,record\nA,model.json,record.csv\n", "utf-8")
    words = ["diagnose", *(str(folder / name) for name in ("model.json", "record.csv"))]
    found = tmp_path_factory.mktemp("found")
    with pytest.raises(SystemExit) as left:
        main([*words, "-o", str(found)])
    assert not left.value.code
    shutil.copy(found / "findings.json", folder)
    return folder


@pytest.fixture
def given(sound: Path, tmp_path: Path) -> Callable[..., Case]:
    """A case of files of one's own beside those that nothing is wrong with."""

    def make(words: tuple[str, ...], files: dict[str, bytes]) -> Case:
        folder = Path(mkdtemp(dir=tmp_path))
        for file in sound.iterdir():
            (folder / file.name).write_bytes(file.read_bytes())
        for name, own in files.items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_bytes(own)
        (folder / "out").mkdir()
        return Case(words, folder, folder / "out")

    return make


@pytest.fixture
def judged_all(
    given: Callable[..., Case], judged: Callable[[Case], Came]
) -> Callable[[range, Callable[[int], Any]], None]:
    """Runs cases by number, and tells of those of which something comes that may not."""

    def run(numbers: range, drawn: Callable[[int], Any]) -> None:
        codes: Counter[int | None] = Counter()
        wrong = []
        for number in numbers:
            case = given(*drawn(number))
            came = judged(case)
            codes[came.code] += 1
            wrong += [f"case {number}, rga {' '.join(case.words)}: {one}" for one in came.faults]
            shutil.rmtree(case.folder)
        assert not wrong, "\n".join(wrong)
        # Some are good all the same, and most are refused.
        assert codes[0] > 0 < codes[2]

    return run
