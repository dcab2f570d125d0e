"""Files that are spoiled in one to three ways, through every command that reads them."""

import json
import re
import shutil
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

Given, Judged = Callable[..., Any], Callable[[Any], Any]
#: model and record of a folder
MODEL, RECORD = "{}/model.json", "{}/record.csv"
#: cases of a test, and how many tests there are at full length
CASES, TESTS = 60, 80

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


def drawn(number: int, sound: Path) -> tuple[tuple[str, ...], dict[str, bytes]]:
    """The command line of a case, and the file that it is spoiled by."""
    draw = np.random.default_rng(number)
    name, lines = list(READERS.values())[draw.integers(len(READERS))]
    spoilt = content(name, sound, draw)
    return lines[draw.integers(len(lines))], {name: spoilt}


def run(numbers: range, sound: Path, given: Given, judged: Judged) -> None:
    """Draw cases, and tell of those of which something comes that may not."""
    codes: Counter[int | None] = Counter()
    wrong = []
    for number in numbers:
        case = given(*drawn(number, sound))
        came = judged(case)
        codes[came.code] += 1
        wrong += [f"case {number}, rga {' '.join(case.words)}: {one}" for one in came.faults]
        shutil.rmtree(case.folder)
    assert not wrong, "\n".join(wrong)
    # Some are good all the same, and most are refused.
    assert codes[0] > 0 < codes[2]


def test_some_spoiled_files(sound: Path, given: Given, judged: Judged) -> None:
    run(range(CASES), sound, given, judged)


@pytest.mark.thorough
@pytest.mark.parametrize("place", range(1, TESTS + 1))
def test_spoiled_files(place: int, sound: Path, given: Given, judged: Judged) -> None:
    run(range(CASES * place, CASES * (place + 1)), sound, given, judged)
