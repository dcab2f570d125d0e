"""A challenge run: every draw judged once, in as many processes as are asked for."""

import time
from collections.abc import Callable, Sequence
from pathlib import Path

from rga.benchmark.challenge.design import Draw
from rga.benchmark.challenge.judge import Outcome, judge
from rga.benchmark.challenge.ledger import Ledger
from rga.workers import finished


def run(
    chosen: Sequence[Draw],
    *,
    folder: Path | None = None,
    workers: int = 1,
    dask: str | None = None,
    minutes: float | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> list[Outcome]:
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
    ledger = Ledger(folder) if folder is not None else None
    known = dict(ledger.outcomes) if ledger is not None else {}
    until = None if minutes is None else time.monotonic() + 60.0 * minutes
    missing = (one for one in chosen if one.id not in known)
    going = (one for one in missing if until is None or time.monotonic() < until)
    for _, judged in finished(judge, going, workers=workers, dask=dask):
        outcome = judged.result()
        known[outcome.id] = outcome
        if ledger is not None:
            ledger.add(outcome)
        progress(sum(one.id in known for one in chosen) / len(chosen))
    return [known[one.id] for one in chosen if one.id in known]
