"""Ways in which values, words and bytes of a file are other than they should be."""

import json
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

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
#: what a float can hold
LARGEST = float(np.finfo(float).max)
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
    elif kind == 3 and isinstance(value, int | float) and abs(value) <= LARGEST:
        holder[key] = value * 10.0 ** int(draw.integers(-300, 300))
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


def respelled(text: str, draw: np.random.Generator, lines: tuple[str, ...]) -> str:
    """A script or table of which one to three words or lines are others.

    Args:
        text: it.
        draw: what to draw from.
        lines: that may come in between.
    """
    for _ in range(int(draw.integers(1, 4))):
        kept = text.splitlines()
        place = int(draw.integers(len(kept)))
        kind = draw.integers(8)
        if kind == 0:
            del kept[place]
        elif kind == 1:
            kept.insert(place, kept[draw.integers(len(kept))])
        elif kind == 2:
            kept.insert(place, lines[draw.integers(len(lines))])
        else:
            words = re.split(r"([\w.+-]+)", kept[place])
            if len(words) > 1:
                values = (NUMBERS, TEXTS, re.findall(r"[\w.+-]+", text))[draw.integers(3)]
                words[1 + 2 * draw.integers(len(words) // 2)] = str(
                    values[draw.integers(len(values))]
                )
            kept[place] = "".join(words)
        text = "\n".join(kept) or " "
    return text
