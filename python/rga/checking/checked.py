"""What all checks have found together: as text, as JSON, as HTML."""

import json
from collections import Counter
from dataclasses import asdict, dataclass
from html import escape
from typing import Any

from rga.checking.finding import Finding
from rga.checking.record_summary import RecordSummary

#: findings that a notebook shows; it counts the others
MOST_SHOWN = 30


@dataclass(frozen=True)
class CheckResult:
    """What checks have found.

    Attributes:
        findings: errors, then warnings, then notes.
        record: what was read as the record; None: none was, or it could not be.

    >>> checked = CheckResult((Finding("note", "group 'a'", "no effect names it", "leave it"),))
    >>> checked.ok
    True
    >>> print(checked)
    note: no effect names it (group 'a'): leave it
    1 note.
    """

    findings: tuple[Finding, ...] = ()
    record: RecordSummary | None = None

    @property
    def ok(self) -> bool:
        """Whether there is no error; warnings and notes may be there."""
        return not any(one.severity == "error" for one in self.findings)

    def sentence(self) -> str:
        """How many findings there are of which kind."""
        count = Counter(one.severity for one in self.findings)
        said = [f"{count[one]} {one}{'s' * (count[one] > 1)}" for one in count]
        return f"{', '.join(said)}." if said else "Nothing looks wrong."

    def __str__(self) -> str:
        read = [f"record: {line}" for line in self.record.lines()] if self.record else []
        return "\n".join([*read, *map(str, self.findings), self.sentence()])

    def content(self) -> dict[str, Any]:
        """The findings as they are written to JSON, and what was read as the record."""
        read = {"record": asdict(self.record)} if self.record else {}
        return {"ok": self.ok, **read, "findings": [asdict(one) for one in self.findings]}

    def to_json(self) -> str:
        """The same as text."""
        return json.dumps(self.content(), indent=1)

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{one.severity}</td><td>{escape(one.where)}</td><td>{escape(one.what)}</td>"
            f"<td>{escape(one.remedy)}</td></tr>"
            for one in self.findings[:MOST_SHOWN]
        )
        more = len(self.findings) - MOST_SHOWN
        rest = f"<p>... and {more} more.</p>" if more > 0 else ""
        head = "<tr><th></th><th>where</th><th>what</th><th>remedy</th></tr>"
        table = f"<table>{head}{rows}</table>" if rows else ""
        lines = self.record.lines()[:MOST_SHOWN] if self.record else []
        read = "".join(f"<p>{escape(line)}</p>" for line in lines)
        return f"{read}<p>{escape(self.sentence())}</p>{table}{rest}"
