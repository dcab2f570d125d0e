"""What was found of ways to infer contexts."""

from dataclasses import dataclass
from typing import Any

from rga_bench.contexts.setting import ContextsSetting
from rga_bench.contexts.task_run import TaskOutcome


@dataclass(frozen=True)
class ContextsResult:
    """What was found.

    Attributes:
        machine: that it was found on.
        versions: of packages.
        setting: how much was run.
        rows: names of floors and methods, in the order of the table.
        absent: methods that were left out, and the packages that they lack.
        outcomes: in the order of the tasks.
    """

    machine: dict[str, Any]
    versions: dict[str, str | None]
    setting: ContextsSetting
    rows: tuple[str, ...]
    absent: dict[str, list[str]]
    outcomes: list[TaskOutcome]
