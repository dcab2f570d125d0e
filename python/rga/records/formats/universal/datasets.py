"""What is in a universal file, by pyuff; and what its degrees of freedom are called here."""

import re
from pathlib import Path
from typing import Any

from rga.errors import InputError
from rga.lazy import needing_extras

#: as such a file begins: a line of -1, and the number of a dataset
_BEGIN = re.compile(rb"\s*-1 *\r?\n *\d{1,6}[ bB]?[^\n]*\r?\n")
#: endings of names of such files; and what begins a dataset, and ends it, wherever pyuff sees it
_NAMES = (".uff", ".unv")
_ABOUT = re.compile(rb" {4}-1 *\r?$", re.MULTILINE)
#: translations and rotations as datasets number them
DIRECTIONS = ("", "x", "y", "z", "rx", "ry", "rz")


def is_universal(data: bytes, path: Path) -> bool:
    """Whether a file is a universal one by its first lines, or is called so.

    >>> is_universal(b"    -1\\n    55\\n", Path("modes.txt"))
    True
    >>> is_universal(b"time,f\\n", Path("modes.csv")), is_universal(b"time,f\\n", Path("modes.uff"))
    (False, True)
    """
    called_so = bool(data) and path.suffix.lower() in _NAMES
    return called_so or _BEGIN.match(data[:400]) is not None


def datasets(path: Path, number: int, what: str) -> list[dict[str, Any]]:
    """The datasets of one number.

    Args:
        path: of the file.
        number: 55 or 58, as pyuff reads them.
        what: they hold, in words.

    Raises:
        InputError: there is none, or one is damaged or breaks off.
        MissingPackageError: pyuff is not installed.
    """
    _check_ends(path)
    with needing_extras():
        import pyuff
    try:
        file = pyuff.UFF(str(path))
        kinds = [int(one) for one in file.get_set_types()]
        chosen = [place for place, kind in enumerate(kinds) if kind == number]
        found = [file.read_sets(place) for place in chosen]
    except MemoryError:
        raise
    except Exception:  # pyuff says no more than that something is wrong
        raise InputError(
            f"a dataset {number} cannot be read", str(path), "export the file again, as ASCII"
        ) from None
    if not found:
        others = ", ".join(map(str, sorted(set(kinds)))) or "none"
        raise InputError(
            f"there is no dataset {number} ({what})",
            f"{path}, datasets {others}",
            "export it as well",
        )
    return found


def _check_ends(path: Path) -> None:
    """Refuse a file in which no dataset begins, or the last one has no end: pyuff leaves it out."""
    data = path.read_bytes()
    about = [one.start() for one in _ABOUT.finditer(data)]
    if not about:
        raise InputError(
            "the file is called a universal file, and no dataset begins in it with a line of -1",
            str(path),
            "export it again, or give a table a name that ends in .csv",
        )
    if len(about) % 2:
        number, *_ = data[about[-1] :].split()[1:2] or [b"without a number"]
        begun, last = (1 + data.count(b"\n", 0, at) for at in (about[-1], len(data.rstrip())))
        raise InputError(
            f"the file breaks off in dataset {number.decode('ascii', 'replace')}, which begins in "
            f"line {begun} and has no end",
            f"{path}, line {last}",
            "export or copy it again",
        )


def point_of(node: int, direction: int) -> str:
    """What a degree of freedom is called: that of a translation along x at node 12 is n12_x.

    Args:
        node: its number.
        direction: from 1, along x, to 6, about z; negative against it; 0: none is said.

    >>> point_of(12, 1), point_of(12, -3), point_of(7, 5), point_of(7, 0)
    ('n12_x', 'n12_z', 'n7_ry', 'n7')
    """
    said = DIRECTIONS[abs(direction)]
    return f"n{node}_{said}" if said else f"n{node}"
