"""Courses of many streams, over processes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from rga.parallel import finished
from rga_bench.detection.charts import Method
from rga_bench.detection.watch import Course, StreamWorld, WatchedCase, watched_together

#: streams, or baselines, that one process watches in one go
CHUNK, BASELINES = 25, 2
#: called with the share that is done
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Job:
    """What a method watches.

    Attributes:
        world: where streams come from.
        method: what watches.
        cases: of equally many streams; a chart is made once for them all.
        ceiling: a stream ends where a value exceeds it; None: the method's limit.
    """

    world: StreamWorld
    method: Method
    cases: tuple[WatchedCase, ...]
    ceiling: float | None = None

    def chunks(self) -> list[range]:
        """Numbers of streams that are watched in one go."""
        streams = self.cases[0].streams
        size = BASELINES * self.world.each if self.world.baseline else CHUNK
        return [range(at, min(at + size, streams)) for at in range(0, streams, size)]


def courses_of(jobs: Sequence[Job], workers: int, progress: Progress) -> list[list[list[Course]]]:
    """Courses by job and case, the same ones for any number of processes.

    Args:
        jobs: what is watched.
        workers: processes of this machine.
        progress: called with the share that is done.
    """
    tasks = [(number, job, chunk) for number, job in enumerate(jobs) for chunk in job.chunks()]
    parts: dict[tuple[int, int], list[list[Course]]] = {}
    for (number, _, chunk), future in finished(_watch, tasks, workers=workers):
        parts[number, chunk.start] = future.result()
        progress(len(parts) / len(tasks))
    found: list[list[list[Course]]] = [[[] for _ in job.cases] for job in jobs]
    for number, start in sorted(parts):
        for courses, part in zip(found[number], parts[number, start], strict=True):
            courses += part
    return found


def _watch(task: tuple[int, Job, range]) -> list[list[Course]]:
    _, job, chunk = task
    return watched_together(job.world, job.cases, job.method, chunk, job.ceiling)
