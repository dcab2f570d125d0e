"""What was found of broken channels."""

from dataclasses import dataclass
from typing import Any

from rga_bench.faults.judge import FaultOutcome


@dataclass(frozen=True)
class FaultsResult:
    """What was found.

    Attributes:
        machine: that it was found on.
        versions: of packages and of the code.
        outcomes: in the order of the trials.
    """

    machine: dict[str, Any]
    versions: dict[str, str]
    outcomes: list[FaultOutcome]
