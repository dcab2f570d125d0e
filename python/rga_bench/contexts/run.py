"""All rows of the table, in as many processes as are asked for."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rga.errors import InputError
from rga_bench.contexts.floors import FLOORS
from rga_bench.contexts.rows import METHODS, applies
from rga_bench.contexts.setting import ContextsSetting
from rga_bench.contexts.task_run import TaskOutcome, run_task
from rga_bench.ledger import outcomes_of
from rga_bench.machine import machine, versions


@dataclass(frozen=True)
class ContextsResult:
    """What was found.

    Attributes:
        machine: that it was found on.
        versions: of packages.
        setting: how much was played.
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


def measure(
    setting: ContextsSetting,
    *,
    folder: Path | None = None,
    workers: int = 1,
    dask: str | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> ContextsResult:
    """Play every task once; no outcome depends on the number of workers, but for times.

    Args:
        setting: how much is played.
        folder: keeps the outcomes; those that it holds already are not made again.
        workers: processes at work on this machine.
        dask: address of the scheduler of a Dask cluster, whose workers do the work instead.
        progress: told the share that is done.

    Raises:
        InputError: no such row, drift or manner; the folder cannot be used, or holds outcomes of
            another version; or there is no cluster.
    """
    wanted = (*FLOORS, *METHODS) if setting.rows is None else setting.rows
    for name in wanted:
        if name not in METHODS and name not in FLOORS:
            known = ", ".join((*FLOORS, *METHODS))
            raise InputError(f"there is no row {name!r}", "rows", f"give some of {known}")
    absent = {
        name: missing for name in wanted if name in METHODS and (missing := METHODS[name].missing)
    }
    rows = tuple(name for name in wanted if name not in absent)
    outcomes = outcomes_of(
        run_task,
        [task for task in setting.tasks(rows) if applies(task)],
        TaskOutcome,
        folder=folder,
        workers=workers,
        dask=dask,
        progress=progress,
    )
    return ContextsResult(machine(), versions(), setting, rows, absent, outcomes)
