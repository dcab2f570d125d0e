"""What a run of the twin on a record ended with."""

from dataclasses import dataclass

from rga.findings import Findings
from rga.twin.history import History


@dataclass(frozen=True)
class Outcome:
    """What a run ended with.

    Attributes:
        findings: of the closing diagnosis of the whole record.
        history: of the twin.
    """

    findings: Findings
    history: History
