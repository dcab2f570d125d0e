"""A challenge run: every draw judged once, in as many processes as are asked for."""

import time
from collections.abc import Callable, Sequence
from pathlib import Path

from rga_bench.diagnosis.design import Draw
from rga_bench.diagnosis.judge import DrawOutcome, judge
from rga_bench.ledger import outcomes_of


def run(
    chosen: Sequence[Draw],
    *,
    folder: Path | None = None,
    workers: int = 1,
    dask: str | None = None,
    minutes: float | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> list[DrawOutcome]:
    """Judge draws; no outcome depends on the number of workers.

    Args:
        chosen: the draws, in the order in which they are begun.
        folder: keeps the outcomes; those that it holds already are not made again.
        workers: processes at work on this machine.
        dask: address of the scheduler of a Dask cluster, whose workers do the work instead.
        minutes: after which no further draw is begun; None: all are.
        progress: told the share that is done.

    Returns:
        The outcomes that there are, in the order of the draws.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of another version; or there is
            no cluster.
    """
    until = None if minutes is None else time.monotonic() + 60.0 * minutes
    return outcomes_of(
        judge,
        chosen,
        DrawOutcome,
        folder=folder,
        workers=workers,
        dask=dask,
        going=lambda: until is None or time.monotonic() < until,
        progress=progress,
    )
