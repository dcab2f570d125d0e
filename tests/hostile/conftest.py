"""Files that are well formed, the many ways in which they can be spoiled, and what may come of it.

A command that is given one may do its work, or refuse it in a line: it never ends in a traceback,
hangs, takes much memory, or leaves something behind where it refuses.
"""

import json
import re
import resource
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import polars as pl
import pytest

from rga.cli import main
from rga.model import load_model
from rga.simulation import Simulator

#: what a case may take: time [s], and memory beyond that of this process [bytes]
LONGEST, MOST = 10, 2**30
#: model and record of a folder
MODEL, RECORD = "{}/model.json", "{}/record.csv"
#: rows of the record
ROWS = 60

NUMBERS: tuple[Any, ...] = (
    float("nan"), float("inf"), -float("inf"), 1e308, -1e308, 1e-308, 5e-324, -0.0, 0, 1, -1, 2**31,
    2**53, 2**63, -(2**63), 2**64, 10**30, 10**400, 1e300, 1e-300, 0.1, 1e6,
)  # fmt: skip
TEXTS = (
    "", " ", "x" * 300, "\ud800", "[/bold]", "[red]", "<script>alert(1)</script>", "\0", "\x1b[31m",
    "a\nb", "../../up", "nan", "1e400", "é" * 200, "\u202e", "%s%n", "{0}", "$HOME", "CON", "-o",
    "2026-13-01", "9999-12-31T23:59:59", "0001-01-01", "1e3", "true", "\ufeff", "\u2028", "=1+1",
)  # fmt: skip
OTHERS: tuple[Any, ...] = (None, True, False, [], {}, [[]], {"": {}}, [None], [[1, 2], [3]])


#: stands for lists within lists, so many
NESTED = "lists within lists: "


def places(tree: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Paths of all values in a tree of dictionaries and lists."""
    inner = tree.items() if isinstance(tree, dict) else enumerate(tree)
    for key, value in inner:
        yield (*path, key)
        if isinstance(value, dict | list):
            yield from places(value, (*path, key))


def spoiled(tree: Any, draw: np.random.Generator) -> Any:
    """A copy of a tree in which one to three things are other than they should be."""
    tree = json.loads(json.dumps(tree))
    for _ in range(int(draw.integers(1, 4))):
        paths = list(places(tree))
        if not paths:
            break
        path = paths[draw.integers(len(paths))]
        holder = tree
        for key in path[:-1]:
            holder = holder[key]
        _spoil(holder, path[-1], tree, paths, draw)
    return tree


def _spoil(
    holder: Any, key: Any, tree: Any, paths: list[tuple[Any, ...]], draw: np.random.Generator
) -> None:
    kind, value = draw.integers(12), holder[key]
    if kind == 0:
        del holder[key]
    elif kind == 1 and isinstance(holder, dict):
        holder[TEXTS[draw.integers(len(TEXTS))]] = holder.pop(key)
    elif kind == 2:
        other = tree
        for step in paths[draw.integers(len(paths))]:
            other = other[step]
        holder[key] = json.loads(json.dumps(other))
    elif kind == 3 and isinstance(value, int | float):
        holder[key] = value * 10.0 ** draw.integers(-300, 300)
    elif kind == 4 and isinstance(value, int | float):
        holder[key] = -value
    elif kind == 5:
        holder[key] = f"{NESTED}{draw.choice([3, 60, 3000])}"
    elif kind == 6:
        holder[key] = OTHERS[draw.integers(len(OTHERS))]
    elif kind == 7 and isinstance(value, str):
        holder[key] = value + str(draw.choice(TEXTS))
    elif kind < 9:
        holder[key] = TEXTS[draw.integers(len(TEXTS))]
    else:
        holder[key] = NUMBERS[draw.integers(len(NUMBERS))]


def damaged(content: bytes, draw: np.random.Generator) -> bytes:
    """Bytes of which some are other than they should be."""
    begun = int(draw.integers(len(content) + 1))
    end = min(len(content), begun + int(draw.choice([1, 2, 16, 200])))
    kind = draw.integers(8)
    if kind == 0:
        return content[:begun]
    if kind == 1:
        return content[:begun] + content[end:]
    if kind == 2:
        return content[:end] + content[begun:]
    if kind == 3 and begun < len(content):
        flipped = content[begun] ^ (1 << int(draw.integers(8)))
        return content[:begun] + bytes([flipped]) + content[begun + 1 :]
    if kind == 4:
        return content.replace(b"\n", draw.choice([b"\r", b"\r\n", b"\0", b"\n\n", b";", b""]))
    if kind == 5:
        return content.replace(b",", draw.choice([b";", b"\t", b",,", b" , ", b'"', b"\xa0", b""]))
    if kind == 6:
        encoding = draw.choice(["utf-16", "utf-32", "utf-8-sig", "cp1252", "utf-7"])
        return content.decode("utf-8", "replace").encode(encoding, "replace")
    noise = draw.integers(0, 256, end - begun, dtype=np.uint8).tobytes()
    return content[:begun] + noise + content[end:]


def written(text: str) -> str:
    """Text with lists within lists where they are to be."""
    return re.sub(
        f'"{NESTED}([0-9]+)"', lambda found: "[" * int(found[1]) + "]" * int(found[1]), text
    )


def dumped(tree: Any, form: str) -> bytes:
    """A tree as JSON, or as YAML, of which JSON is a part."""
    text = written(json.dumps(tree))
    return text.replace("NaN", ".nan").encode() if form == "yaml" else text.encode()


def toml(tree: dict[str, Any]) -> bytes:
    """A flat tree, with tables of values in it, as TOML."""

    def value(one: Any) -> str:
        if isinstance(one, dict):
            return "{" + ", ".join(f"{json.dumps(k)} = {value(v)}" for k, v in one.items()) + "}"
        if isinstance(one, list):
            return "[" + ", ".join(map(value, one)) + "]"
        return "''" if one is None else json.dumps(one).replace("NaN", "nan")

    lines = [f"{json.dumps(key)} = {value(one)}" for key, one in tree.items()]
    return written("\n".join(lines)).replace("Infinity", "inf").encode("utf-8", "surrogatepass")


@dataclass(frozen=True)
class Case:
    """A command line, in a folder of files of which one is spoiled.

    Attributes:
        words: of the command line; "{}" is the folder.
        folder: of the files.
        output: folder that is empty before, and that the command may write to.
    """

    words: tuple[str, ...]
    folder: Path
    output: Path


@dataclass
class Came:
    """What came of a case: its exit code, what it says, and what is wrong with that."""

    code: int | None = None
    said: str = ""
    faults: list[str] = field(default_factory=list)


class TooLong(BaseException):
    """A case has taken too long."""


@contextmanager
def bounded() -> Iterator[None]:
    """A block that may take some time and memory, and no more."""

    def stop(_number: int, _frame: FrameType | None) -> None:
        raise TooLong

    soft, hard = resource.getrlimit(resource.RLIMIT_AS)
    pages = int(Path("/proc/self/statm").read_text("ascii").split()[0])
    before = signal.signal(signal.SIGALRM, stop)
    resource.setrlimit(resource.RLIMIT_AS, (pages * resource.getpagesize() + MOST, hard))
    signal.alarm(LONGEST)
    try:
        yield
    finally:
        signal.alarm(0)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        signal.signal(signal.SIGALRM, before)


@pytest.fixture
def judged(capsys: pytest.CaptureFixture[str]) -> Callable[[Case], Came]:
    """Runs a case, and says what is wrong with what came of it."""

    def run(case: Case) -> Came:
        came = Came()
        capsys.readouterr()
        words = [word.replace("{}", str(case.folder)) for word in case.words]
        try:
            with bounded():
                main(words)
        except SystemExit as left:
            came.code = int(left.code or 0)
        except TooLong:
            came.faults.append(f"it takes longer than {LONGEST} s")
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
            if words[0] in ("check", "import-record"):
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
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of files that nothing is wrong with."""
    bar = {"section": "bar", "material": "steel", "groups": ["bars"]}
    model = {
        "rga_model": 1,
        "name": "two bars",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
        "sections": {"bar": {"A": 0.01}},
        "nodes": {"W": [0, 0, 0], "T": [3, 0, 4], "E": [6, 0, 0]},
        "members": {"west": {"nodes": ["W", "T"], **bar}, "east": {"nodes": ["T", "E"], **bar}},
        "supports": {
            "W": {"node": "W", "fixed": ["ux", "uy", "uz"]},
            "E": {"node": "E", "fixed": ["ux", "uy", "uz"]},
        },
        "context": {
            "temperature": {"unit": "degC", "range": [-20, 40], "noise": 0.2},
            "load": {"unit": "N", "range": [0, 1e5]},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {"bars": 1.0},
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "weight": {
                "kind": "nodal_load",
                "forces": {"T": [0, 0, -1]},
                "factor": {"context": "load"},
            },
        },
        "sensors": {
            "D1": {
                "kind": "displacement", "node": "T", "direction": [0, 0, 1], "unit": "mm",
                "noise": 0.01,
            },
            "S1": {"kind": "strain", "member": "west", "unit": "microstrain", "noise": 0.5},
            "S2": {"kind": "strain", "member": "east", "unit": "microstrain", "noise": 0.5},
        },
    }  # fmt: skip
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
    words = [word.replace("{}", str(folder)) for word in ("diagnose", MODEL, RECORD, "-o", "{}")]
    with pytest.raises(SystemExit) as left:
        main(words)
    assert not left.value.code
    return folder


SETTINGS: dict[str, Any] = {
    "calibration_rows": 20, "packet": 10, "settle": 10, "detector": "window", "window": 30,
    "persistence": [3, 4], "design_rows": 64, "level": "B", "inference": "joint",
}  # fmt: skip
CRITERIA: dict[str, Any] = {"record": {"most_rows": 2000}, "cause": {"log_odds": 6.0}}
MAPPING: dict[str, Any] = {
    "time": {"column": "time", "format": "%Y-%m-%dT%H:%M:%S"},
    "separator": ",",
    "decimal": ".",
    "encoding": "utf-8",
    "skip_rows": 0,
    "missing": ["NA", -9999],
    "channels": {
        "D1": {"column": "D1", "scale": 1.0, "unit": "mm"},
        "S1": {"column": "S1"},
        "S2": {"column": "S2"},
        "temperature": {"column": "temperature"},
    },
}
#: by kind: the file that is spoiled, and the command lines that read it
READERS: dict[str, tuple[str, tuple[tuple[str, ...], ...]]] = {
    "model": (
        "model.json",
        (
            ("check", MODEL),
            ("draw", MODEL, "-o", "{}/out/drawing.svg"),
            ("simulate", MODEL, "{}/contexts.csv", "-o", "{}/out/simulated.csv"),
            ("results", MODEL, "--contexts", "temperature=3,load=5", "-o", "{}/out/results.csv"),
            ("whatif", MODEL, "--set", "load=3", "--set", "temperature=5"),
            ("dataset", MODEL, "-n", "20", "-o", "{}/out/set.parquet"),
            ("diagnose", MODEL, RECORD, "-o", "{}/out"),
            ("plan", MODEL, "{}/findings.json"),
            ("import-record", RECORD, "--model", MODEL, "-o", "{}/out/import.toml"),
        ),
    ),
    "model.yaml": (
        "model.yaml",
        (("check", "{}/model.yaml"), ("diagnose", "{}/model.yaml", RECORD, "-o", "{}/out")),
    ),
    "model.toml": ("model.toml", (("check", "{}/model.toml"),)),
    "record": (
        "record.csv",
        (
            ("diagnose", MODEL, RECORD, "-o", "{}/out"),
            ("import-record", RECORD, "--model", MODEL, "-o", "{}/out/import.toml"),
            ("diagnose-many", "{}/list.csv", "-o", "{}/out", "--workers", "1"),
        ),
    ),
    "record.parquet": (
        "record.parquet",
        (("diagnose", MODEL, "{}/record.parquet", "-o", "{}/out"),),
    ),
    "contexts": (
        "contexts.csv",
        (
            ("simulate", MODEL, "{}/contexts.csv", "-o", "{}/out/simulated.csv"),
            ("results", MODEL, "{}/contexts.csv", "-o", "{}/out/results.csv"),
        ),
    ),
    "mapping": (
        "import.toml",
        (("diagnose", MODEL, RECORD, "--import", "{}/import.toml", "-o", "{}/out"),),
    ),
    "settings": (
        "settings.json",
        (("run", MODEL, RECORD, "-o", "{}/out", "--settings", "{}/settings.json"),),
    ),
    "settings.toml": (
        "settings.toml",
        (("run", MODEL, RECORD, "-o", "{}/out", "--settings", "{}/settings.toml"),),
    ),
    "criteria": (
        "criteria.json",
        (("diagnose", MODEL, RECORD, "--criteria", "{}/criteria.json", "-o", "{}/out"),),
    ),
    "findings": ("findings.json", (("plan", MODEL, "{}/findings.json"),)),
    "list": ("list.csv", (("diagnose-many", "{}/list.csv", "-o", "{}/out", "--workers", "1"),)),
}
TREES = {
    "settings.json": SETTINGS,
    "settings.toml": SETTINGS,
    "criteria.json": CRITERIA,
    "import.toml": MAPPING,
}


def content(name: str, sound: Path, draw: np.random.Generator) -> bytes:
    """A file that is spoiled, by its name."""
    form = name.rpartition(".")[2]
    known = sound / ("model.json" if name.startswith("model") else name)
    tree = TREES.get(name)
    if tree is None and known.suffix == ".json":
        tree = json.loads(known.read_text("utf-8"))
    if tree is None:
        return damaged(known.read_bytes(), draw)
    as_bytes = toml if form == "toml" else lambda one: dumped(one, form)
    return damaged(as_bytes(tree), draw) if draw.random() < 0.15 else as_bytes(spoiled(tree, draw))


@pytest.fixture
def given(sound: Path, tmp_path: Path) -> Callable[..., Case]:
    """A case of files of one's own beside those that nothing is wrong with."""

    def make(words: tuple[str, ...], files: dict[str, bytes]) -> Case:
        for file in sound.iterdir():
            (tmp_path / file.name).write_bytes(file.read_bytes())
        for name, own in files.items():
            (tmp_path / name).write_bytes(own)
        (tmp_path / "out").mkdir()
        return Case(words, tmp_path, tmp_path / "out")

    return make


@pytest.fixture
def drawn(sound: Path, tmp_path: Path) -> Callable[[int, str | None], Case]:
    """Draws a case by its number."""

    def make(number: int, kind: str | None = None) -> Case:
        draw = np.random.default_rng(number)
        folder = tmp_path / str(number)
        folder.mkdir()
        for file in sound.iterdir():
            (folder / file.name).write_bytes(file.read_bytes())
        chosen = kind or list(READERS)[draw.integers(len(READERS))]
        name, lines = READERS[chosen]
        (folder / name).write_bytes(content(name, sound, draw))
        (folder / "out").mkdir()
        return Case(lines[draw.integers(len(lines))], folder, folder / "out")

    return make
