"""Times of tasks that are compared, on a machine that has other work too."""

import time
from collections.abc import Callable, Sequence


def shortest(tasks: Sequence[Callable[[], object]], seconds: float, turns: int = 5) -> list[float]:
    """Shortest time of each task [s], taken in turns, so that what disturbs one disturbs all.

    Args:
        tasks: are run once before, for their caches.
        seconds: over which turns are begun.
        turns: that are taken at least.
    """
    times: list[list[float]] = [[] for _ in tasks]
    for task in tasks:
        task()
    begin = time.perf_counter()
    while time.perf_counter() - begin < seconds or len(times[0]) < turns:
        for task, taken in zip(tasks, times, strict=True):
            start = time.perf_counter()
            task()
            taken.append(time.perf_counter() - start)
    return [min(taken) for taken in times]
