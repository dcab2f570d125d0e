"""Lists as Tcl writes and reads them, and the commands that deal with them."""

import fnmatch
from collections.abc import Callable
from typing import Any

from rga.errors import InputError
from rga.importing.opensees.tcl.numbers import number
from rga.importing.opensees.tcl.words import CLOSING, ESCAPES
from rga.importing.scripts.values import LONGEST, Unknown

PLAIN_SIGNS = set('{}[]$"\\; \t\n')


def split_list(text: str, where: str) -> list[str]:
    """The items of a list.

    Raises:
        InputError: a brace or quote in it is not closed.

    >>> split_list("a {b c} {}", "line 1")
    ['a', 'b c', '']
    """
    items: list[str] = []
    place, size = 0, len(text)
    while True:
        while place < size and text[place].isspace():
            place += 1
        if place >= size:
            return items
        opening = text[place]
        if opening == "{" or opening == '"':
            end = _closing(text, place, CLOSING[opening], where)
            items.append(text[place + 1 : end])
            place = end + 1
            continue
        item: list[str] = []
        while place < size and not text[place].isspace():
            if text[place] == "\\" and place + 1 < size:
                place += 1
                item.append(ESCAPES.get(text[place], text[place]))
            else:
                item.append(text[place])
            place += 1
        items.append("".join(item))


def _closing(text: str, place: int, sign: str, where: str) -> int:
    depth, opening = 0, text[place]
    for end in range(place, len(text)):
        if text[end] == opening and (opening == "{" or end == place):
            depth += 1
        elif text[end] == sign:
            depth -= 1
            if depth == 0:
                return end
    raise InputError(f"a list is not closed: {text[:40]!r}", where, f"close it with {sign}")


def write_list(items: list[str]) -> str:
    """A list of items.

    >>> write_list(["a", "b c", ""])
    'a {b c} {}'
    """
    return " ".join(
        f"{{{item}}}" if not item or PLAIN_SIGNS & set(item) else item for item in items
    )


def place_of(text: str, size: int, where: str) -> int:
    """An index into a list: a number, `end`, or one counted from these."""
    plain = text.strip().replace(" ", "")
    if plain.startswith("end"):
        rest = plain[3:]
        return size - 1 + (int(number(rest, where)) if rest else 0)
    for sign in "+-":
        first, found, second = plain[1:].partition(sign)
        if found:
            return int(number(plain[0] + first, where)) + int(number(sign + second, where))
    return int(number(plain, where))


def _lindex(where: str, text: str, *places: str) -> str:
    flat = [one for place in places for one in split_list(place, where)]
    for place in flat:
        items = split_list(text, where)
        index = place_of(place, len(items), where)
        text = items[index] if 0 <= index < len(items) else ""
    return text


def _lrange(where: str, text: str, first: str, last: str) -> str:
    items = split_list(text, where)
    start = max(place_of(first, len(items), where), 0)
    return write_list(items[start : max(place_of(last, len(items), where) + 1, 0)])


def _concat(where: str, *texts: str) -> str:
    return " ".join(filter(None, (text.strip() for text in texts)))


def _split(where: str, text: str, signs: str = " \t\n") -> str:
    if not signs:
        return write_list(list(text))
    for sign in signs[1:]:
        text = text.replace(sign, signs[0])
    return write_list(text.split(signs[0]) if text else [])


def _lsearch(where: str, *words: str) -> str:
    exact = "-exact" in words
    text, wanted = [word for word in words if word not in ("-exact", "-glob")][:2]
    for place, item in enumerate(split_list(text, where)):
        if item == wanted if exact else fnmatch.fnmatchcase(item, wanted):
            return str(place)
    return "-1"


def _lrepeat(where: str, count: str, *items: str) -> str:
    times = int(number(count, where))
    if times * (sum(map(len, items)) + len(items)) > LONGEST:
        raise InputError("a list grows beyond bounds", where, "write it out")
    return write_list(list(items) * times)


def _linsert(where: str, text: str, place: str, *items: str) -> str:
    every = split_list(text, where)
    index = place_of(place, len(every) + 1, where)
    return write_list([*every[:index], *items, *every[index:]])


def _lsort(where: str, *words: str) -> Any:
    options, text = words[:-1], words[-1]
    items = split_list(text, where)
    if not set(options) <= {"-integer", "-real", "-increasing", "-decreasing", "-ascii", "-unique"}:
        return Unknown("a list sorted in a way of its own")
    key: Any = str
    if {"-integer", "-real"} & set(options):
        key = lambda item: number(item, where)  # noqa: E731
    ordered = sorted(dict.fromkeys(items) if "-unique" in options else items, key=key)
    return write_list(ordered[::-1] if "-decreasing" in options else ordered)


#: list commands: functions of the place, for errors, and their words
COMMANDS: dict[str, Callable[..., Any]] = {
    "list": lambda where, *items: write_list(list(items)),
    "llength": lambda where, text: str(len(split_list(text, where))),
    "lindex": _lindex,
    "lrange": _lrange,
    "lreverse": lambda where, text: write_list(split_list(text, where)[::-1]),
    "concat": _concat,
    "split": _split,
    "join": lambda where, text, sign=" ": sign.join(split_list(text, where)),
    "lsearch": _lsearch,
    "lrepeat": _lrepeat,
    "linsert": _linsert,
    "lsort": _lsort,
}
