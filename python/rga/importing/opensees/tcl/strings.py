"""Commands that make texts of texts: `string`, `format`, and names of files."""

import fnmatch
import re
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any

from rga.errors import InputError
from rga.importing.opensees.tcl.lists import place_of, split_list
from rga.importing.opensees.tcl.numbers import is_number, number
from rga.importing.scripts.values import LONGEST, Unknown

FIELD = re.compile(r"%(%|[-+ 0#]*(\d*)(?:\.\d+)?(?:l|ll|h)?([a-zA-Z]))", re.ASCII)


def string(where: str, what: str, *words: str) -> Any:
    """`string`: what is done, and to which texts."""
    if what not in STRING:
        return Unknown(f"string {what}")
    return STRING[what](where, *(word for word in words if word not in ("-nocase", "--")))


def format_text(where: str, pattern: str, *values: str) -> Any:
    """`format`, by the fields of C."""
    left = list(values)

    def field(found: re.Match[str]) -> str:
        if found[1] == "%":
            return "%"
        letter = found[3]
        if not left or int(found[2] or 0) > 1000 or letter not in "sdifgGeExXoc":
            raise InputError(f"the format {pattern!r} cannot be filled", where, "write the text")
        value: Any = left.pop(0)
        if letter in "fgGeE":
            value = float(number(value, where))
        elif letter != "s":
            value = int(number(value, where))
        return str(found[0].replace("l", "") % value)

    return FIELD.sub(field, pattern)


def file_name(where: str, what: str, *words: str) -> Any:
    """The part of `file` that only deals with names; None where it would touch files."""
    if what == "join":
        return str(PurePosixPath(*words))
    if not words:
        return None
    path = PurePosixPath(words[0])
    parts = {
        "dirname": str(path.parent),
        "tail": path.name,
        "extension": path.suffix,
        "rootname": str(path.with_suffix("")),
        "normalize": str(path),
    }
    return parts.get(what)


def _map(where: str, pairs: str, text: str) -> str:
    items = split_list(pairs, where)
    table = dict(zip(items[::2], items[1::2], strict=False))
    keys = "|".join(re.escape(key) for key in items[::2] if key)
    return re.sub(keys, lambda found: table[found[0]], text) if keys else text


def _repeat(where: str, text: str, count: str) -> str:
    times = int(number(count, where))
    if len(text) * times > LONGEST:
        raise InputError("a text grows beyond bounds", where, "write it out")
    return text * times


def _range(where: str, text: str, first: str, last: str) -> str:
    start = max(place_of(first, len(text), where), 0)
    return text[start : max(place_of(last, len(text), where) + 1, 0)]


def _is(where: str, kind: str, text: str) -> Any:
    if kind in ("double", "integer"):
        whole = kind == "integer"
        return str(int(is_number(text) and not (whole and isinstance(number(text, where), float))))
    return Unknown(f"string is {kind}")


STRING: dict[str, Callable[..., Any]] = {
    "map": _map,
    "tolower": lambda where, text: text.lower(),
    "toupper": lambda where, text: text.upper(),
    "trim": lambda where, text, signs=None: text.strip(signs),
    "trimleft": lambda where, text, signs=None: text.lstrip(signs),
    "trimright": lambda where, text, signs=None: text.rstrip(signs),
    "length": lambda where, text: str(len(text)),
    "equal": lambda where, one, other: str(int(one == other)),
    "compare": lambda where, one, other: str((one > other) - (one < other)),
    "match": lambda where, pattern, text: str(int(fnmatch.fnmatchcase(text, pattern))),
    "first": lambda where, needle, text: str(text.find(needle)),
    "index": lambda where, text, place: _range(where, text, place, place),
    "range": _range,
    "repeat": _repeat,
    "is": _is,
}
