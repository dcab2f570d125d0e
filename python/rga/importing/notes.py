"""What a reader says about a file: what it left out, took for granted, or must refuse."""

import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Literal

from rga.errors import InputError

#: "refused" and "question" keep a file from becoming a model; "dropped" is in the file and not in
#: the model; "assumed" was decided by the reader; "noticed" is worth a look
Severity = Literal["refused", "question", "dropped", "assumed", "noticed"]
#: what a user may accept: second order read as first, parts left out, values that look wrong
Acceptance = Literal["linear", "partial", "values"]
ORDER: tuple[Severity, ...] = ("refused", "question", "dropped", "assumed", "noticed")
#: what a note becomes when the user accepts it
ACCEPTED: dict[Acceptance, Severity] = {
    "linear": "assumed",
    "partial": "dropped",
    "values": "noticed",
}
LINE = re.compile(r"line (\d+)")
ROW = re.compile(r"(?P<sheet>.+), row (?P<row>\d+)(?: \((?P<name>.*)\))?")


@dataclass(frozen=True)
class ImportNote:
    """One thing that a reader says.

    Attributes:
        severity: how grave it is.
        where: the lines, cells or names of the file that it is about.
        what: it is.
        remedy: what would mend it; empty where nothing needs to be.
    """

    severity: Severity
    where: str
    what: str
    remedy: str = ""

    def __str__(self) -> str:
        return f"{self.severity}: {self.what} ({self.where})" + (
            f": {self.remedy}" if self.remedy else ""
        )


class ImportRefused(InputError):
    """A file that would become a wrong model, with everything that keeps it from being right.

    Attributes:
        notes: all that the reader says, gravest first.
        counts: what it found, by kind.
    """

    def __init__(self, path: str, notes: list[ImportNote], counts: dict[str, int]) -> None:
        self.path, self.notes, self.counts = path, notes, counts
        grave = [note for note in notes if note.severity in ("refused", "question")]
        super().__init__(
            "; ".join(f"{note.where}: {note.what}" for note in grave),
            path,
            "; ".join(dict.fromkeys(note.remedy for note in grave if note.remedy)),
        )
        # The parts are the arguments, so that the error passes from process to process.
        self.args = (path, notes, counts)


class Notes:
    """Notes as they come in; what is said of several places becomes one note.

    Args:
        accept: what the user accepts.
    """

    def __init__(self, accept: Collection[Acceptance] = ()) -> None:
        self._accept = frozenset(accept)
        self._places: dict[tuple[Severity, str, str], list[str]] = {}

    def say(self, severity: Severity, where: str, what: str, remedy: str = "") -> None:
        """Take a note."""
        places = self._places.setdefault((severity, what, remedy), [])
        places.append(where)

    def refuse(self, where: str, what: str, remedy: str, unless: Acceptance | None = None) -> None:
        """ImportNote what would make the model wrong, or was accepted.

        Args:
            unless: what the user may accept instead.
        """
        if unless in self._accept and unless is not None:
            self.say(ACCEPTED[unless], where, what)
        else:
            option = f"; or accept it: --accept-{unless}" if unless else ""
            self.say("refused", where, what, remedy + option)

    @property
    def grave(self) -> bool:
        """Whether something keeps the file from becoming a model."""
        return any(severity in ("refused", "question") for severity, _, _ in self._places)

    def listed(self) -> list[ImportNote]:
        """All notes, gravest first."""
        notes = [
            ImportNote(severity, joined(places), what, remedy)
            for (severity, what, remedy), places in self._places.items()
        ]
        return sorted(notes, key=lambda note: ORDER.index(note.severity))


def joined(places: Iterable[str]) -> str:
    """Places in short: neighbouring lines as a range.

    >>> joined(["line 3", "line 4", "line 5", "line 9"])
    'lines 3-5, 9'
    >>> joined(["nodes, row 3 (A)", "nodes, row 4 (B)"])
    'nodes, rows 3-4 (A, B)'
    >>> joined(["line 3", "units.tcl, line 4"])
    'line 3; units.tcl, line 4'
    """
    every = list(dict.fromkeys(places))
    if len(every) < 2:
        return "; ".join(every)
    lines = [found for place in every if (found := LINE.fullmatch(place))]
    if len(lines) == len(every):
        return f"lines {_ranges([int(line[1]) for line in lines])}"
    rows = [found for place in every if (found := ROW.fullmatch(place))]
    if len(rows) == len(every) and len({row["sheet"] for row in rows}) == 1:
        names = ", ".join(row["name"] for row in rows if row["name"])
        numbers = _ranges([int(row["row"]) for row in rows])
        return f"{rows[0]['sheet']}, rows {numbers}" + (f" ({names})" if names else "")
    return "; ".join(every)


def _ranges(numbers: list[int]) -> str:
    """Numbers in short: neighbours as a range."""
    numbers = sorted(numbers)
    ranges: list[list[int]] = []
    for number in numbers:
        if ranges and number == ranges[-1][1] + 1:
            ranges[-1][1] = number
        else:
            ranges.append([number, number])
    return ", ".join(f"{a}" if a == b else f"{a}-{b}" for a, b in ranges)
