"""A challenge run: every draw judged once, in as many processes as are asked for."""

import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from multiprocessing import get_context
from pathlib import Path

from rga.benchmark.challenge.design import Draw
from rga.benchmark.challenge.judge import Outcome, judge
from rga.benchmark.challenge.ledger import Ledger


def run(
    chosen: Sequence[Draw],
    *,
    folder: Path | None = None,
    workers: int = 1,
    minutes: float | None = None,
    progress: Callable[[float], None] = lambda done: None,
) -> list[Outcome]:
    """Judge draws; no outcome depends on the number of workers.

    Args:
        chosen: the draws, in the order in which they are begun.
        folder: keeps the outcomes; those that it holds already are not made again.
        workers: processes at work.
        minutes: after which no further draw is begun; None: all are.
        progress: told the share that is done.

    Returns:
        The outcomes that there are, in the order of the draws.

    Raises:
        InputError: the folder cannot be used, or holds outcomes of another version.
    """
    ledger = Ledger(folder) if folder is not None else None
    known = dict(ledger.outcomes) if ledger is not None else {}
    until = None if minutes is None else time.monotonic() + 60.0 * minutes
    missing = (one for one in chosen if one.id not in known)
    going = (one for one in missing if until is None or time.monotonic() < until)
    for outcome in _judged(going, workers):
        known[outcome.id] = outcome
        if ledger is not None:
            ledger.add(outcome)
        progress(sum(one.id in known for one in chosen) / len(chosen))
    return [known[one.id] for one in chosen if one.id in known]


def _judged(draws: Iterator[Draw], workers: int) -> Iterator[Outcome]:
    """Outcomes as they come; a draw is taken from the iterator when a process is free for it."""
    if workers == 1:
        yield from map(judge, draws)
        return
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        going: set[Future[Outcome]] = set()
        while True:
            while len(going) < workers and (draw := next(draws, None)) is not None:
                going.add(pool.submit(judge, draw))
            if not going:
                return
            done, going = wait(going, return_when=FIRST_COMPLETED)
            for one in done:
                yield one.result()
