"""Streams watched by a method: what its values rose to, and when."""

from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga_bench.detection.charts import Chart, Method
from rga_bench.detection.faults import StreamChange
from rga_bench.detection.noise import WHITE, NoiseSource, StationaryNoise
from rga_bench.detection.streams import ResidualStream

#: rows that are fed at once: few at first, for an alarm may come soon, then what caches hold
FIRST_BLOCK, LAST_BLOCK = 64, 256


@dataclass(frozen=True)
class StreamWorld:
    """Where streams and baselines come from.

    Attributes:
        seed: what is drawn depends on it, the noise, the purpose and the number only, so that all
            methods and faults meet the same noise.
        noise: of every stream.
        sensors: in a row.
        baseline: rows that a method is made from; 0: the noise is known.
        each: streams to a baseline.
    """

    seed: int
    noise: StationaryNoise = WHITE
    sensors: int = 84
    baseline: int = 0
    each: int = 1

    @property
    def in_common(self) -> int:
        """Streams in turn that have a baseline in common; 1: none have."""
        return self.each if self.baseline else 1

    def stream(self, case: "WatchedCase", number: int) -> ResidualStream:
        """One of a case."""
        seed = self._seed(case.purpose, number)
        return ResidualStream(self.noise, self.sensors, seed, case.fault, case.onset)

    def made(self, method: Method, number: int) -> Chart:
        """A fresh chart from the baseline of that number."""
        seed = self._seed("baseline", number)
        rows = None
        if self.baseline:
            rows = NoiseSource(self.noise, self.sensors, seed).take(self.baseline)
        return method.make(rows, int(seed.generate_state(1)[0]))

    def _seed(self, purpose: str, number: int) -> np.random.SeedSequence:
        words = f"{purpose} {self.noise.name}".encode()
        return np.random.SeedSequence([self.seed, *words], spawn_key=(number,))


@dataclass(frozen=True)
class WatchedCase:
    """What is watched.

    Attributes:
        streams: how many.
        cap: rows after the onset at most.
        onset: rows before the fault, or before run lengths are counted.
        fault: what happens; None: nothing.
        purpose: other purposes see other streams.
    """

    streams: int
    cap: int
    onset: int = 0
    fault: StreamChange | None = None
    purpose: str = ""


@dataclass(frozen=True)
class Course:
    """What a chart did on a stream.

    Attributes:
        before: its largest value before the onset.
        rows: of its records since the onset, counted from 1.
        values: of the records, ascending.
        watched: rows since the onset.
    """

    before: float
    rows: FloatArray
    values: FloatArray
    watched: int

    def exceeds(self, limit: float) -> int | None:
        """Number of the first record above the limit."""
        found = int(np.searchsorted(self.values, limit, side="right"))
        return found if found < len(self.values) else None

    def length(self, limit: float) -> tuple[int, bool]:
        """Rows until the alarm, and whether there was one."""
        found = self.exceeds(limit)
        return (self.watched, False) if found is None else (int(self.rows[found]), True)


def watched(
    world: StreamWorld,
    case: WatchedCase,
    method: Method,
    numbers: range | None = None,
    ceiling: float | None = None,
) -> list[Course]:
    """Courses of a method on the streams of a case.

    Args:
        world: where the streams come from.
        case: what is watched.
        method: what watches.
        numbers: of the streams; None: all.
        ceiling: a stream ends where a value exceeds it; None: the method's limit.
    """
    return watched_together(world, (case,), method, numbers or range(case.streams), ceiling)[0]


def watched_together(
    world: StreamWorld,
    cases: Sequence[WatchedCase],
    method: Method,
    numbers: range,
    ceiling: float | None = None,
) -> list[list[Course]]:
    """The same of several cases; a chart is made once for all streams of a baseline."""
    end = method.limit if ceiling is None else ceiling
    courses: list[list[Course]] = [[] for _ in cases]
    made: tuple[int, Chart] | None = None
    for number in numbers:
        own = number // world.each if world.baseline else 0
        if made is None or made[0] != own:
            made = own, world.made(method, own)
        for case, found in zip(cases, courses, strict=True):
            stream = world.stream(case, number)
            found.append(_course(deepcopy(made[1]), stream, case.onset, case.cap, end))
    return courses


def _course(chart: Chart, stream: ResidualStream, onset: int, cap: int, ceiling: float) -> Course:
    before = -np.inf
    for size in _blocks(onset):
        before = max(before, float(chart.values(stream.take(size)).max()))
    rows: list[FloatArray] = []
    values: list[FloatArray] = []
    seen, highest = 0, -np.inf
    for size in _blocks(cap):
        found = chart.values(stream.take(size))
        largest = np.maximum.accumulate(found)
        new = found > np.maximum(np.concatenate([[-np.inf], largest[:-1]]), highest)
        rows.append(np.asarray(seen + 1.0 + np.flatnonzero(new)))
        values.append(found[new])
        seen, highest = seen + size, max(highest, float(largest[-1]))
        if highest > ceiling:
            break
    return Course(before, np.concatenate(rows), np.concatenate(values), seen)


def _blocks(rows: int) -> Iterator[int]:
    size = FIRST_BLOCK
    while rows > 0:
        yield min(size, rows)
        rows, size = rows - size, min(2 * size, LAST_BLOCK)
