"""All trials, in as many processes as are asked for."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rga_bench.faults.judge import FaultOutcome, judge
from rga_bench.faults.trial import FaultTrial
from rga_bench.ledger import outcomes_of, versions
from rga_bench.machine import machine


@dataclass(frozen=True)
class FaultsResult:
    """What was found.

    Attributes:
        machine: that it was found on.
        versions: of packages and of this code.
        outcomes: in the order of the trials.
    """

    machine: dict[str, Any]
    versions: dict[str, str]
    outcomes: list[FaultOutcome]


def measure(
    chosen: Sequence[FaultTrial],
    *,
    folder: Path | None = None,
    workers: int = 1,
    dask: str | None = None,
    minutes: float | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> FaultsResult:
    """Diagnose every trial once; no outcome depends on the number of workers, but for times.

    Args:
        chosen: the trials, in the order in which they are begun.
        folder: keeps the outcomes; those that it holds already are not made again.
        workers: processes at work on this machine.
        dask: address of the scheduler of a Dask cluster, whose workers do the work instead.
        minutes: after which no further trial is begun; None: all are.
        progress: told the share that is done.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of another version; or there is
            no cluster.
    """
    until = None if minutes is None else time.monotonic() + 60.0 * minutes
    outcomes = outcomes_of(
        judge,
        chosen,
        FaultOutcome,
        folder=folder,
        workers=workers,
        dask=dask,
        going=lambda: until is None or time.monotonic() < until,
        progress=progress,
    )
    return FaultsResult(machine(), versions(), outcomes)
