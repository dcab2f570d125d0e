"""What a check has found: how bad, where, what, and how to mend it."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import Literal

from rga.errors import InputError, SeveralMistakes

Severity = Literal["error", "warning", "note"]
#: names that a finding lists; it counts the others
MOST_NAMED = 6


@dataclass(frozen=True)
class Finding:
    """One thing that a check has found.

    Attributes:
        severity: `error`: it cannot be used so; `warning`: it looks like a slip; `note`: worth
            knowing, and maybe meant so.
        where: the part of the model, the channel or the file.
        what: is wrong or odd.
        remedy: how to mend it.

    >>> print(Finding("warning", "material 'steel'", "E is 210 Pa", "write 2.1e11"))
    warning: E is 210 Pa (material 'steel'): write 2.1e11
    """

    severity: Severity
    where: str
    what: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.severity}: {self.what} ({self.where}): {self.remedy}"


def refused(error: InputError, severity: Severity = "error") -> list[Finding]:
    """An error as findings, one for each mistake that it tells."""
    if not isinstance(error, SeveralMistakes):
        return [Finding(severity, error.where, error.what, error.remedy)]
    told, more = error.mistakes[: error.MOST], len(error.mistakes) - error.MOST
    found = [Finding(severity, error.where, one, error.remedy) for one in told]
    if more > 0:
        found.append(Finding(severity, error.where, f"... and {more} more mistakes", error.remedy))
    return found


def named(names: Collection[str] | Iterable[str]) -> str:
    """Names in quotes, the first of them.

    >>> named("abc"), named(str(k) for k in range(9))
    ("'a', 'b', 'c'", "'0', '1', '2', '3', '4', '5' and 3 more")
    """
    every = list(names)
    shown, more = ", ".join(map(repr, every[:MOST_NAMED])), len(every) - MOST_NAMED
    return f"{shown} and {more} more" if more > 0 else shown


def parts(kind: str, names: Collection[str] | Iterable[str]) -> str:
    """Parts of a model of one kind, as the place of a finding.

    >>> parts("node", ["A"]), parts("node", "AB")
    ("node 'A'", "nodes 'A', 'B'")
    """
    every = list(names)
    return f"{kind}{'' if len(every) == 1 else 's'} {named(every)}"
