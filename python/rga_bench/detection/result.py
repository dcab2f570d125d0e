"""What was measured."""

from dataclasses import dataclass
from typing import Any

from rga_bench.detection.charts import Method
from rga_bench.detection.faults import StreamChange
from rga_bench.detection.rates import Arl0, Delay, Share, arl0, delay, share
from rga_bench.detection.setting import DetectionSetting
from rga_bench.detection.watch import Course, StreamWorld
from rga_bench.measurement import Measurement

#: None: none
Bounds = tuple[float | None, float | None]


@dataclass(frozen=True)
class Alarms:
    """False alarms of a detector.

    Attributes:
        detector: its name.
        limit: that it was set to; None: it sets one itself.
        noise: name of the world.
        known: whether the noise is known, or estimated from a baseline.
        arl0: rows between false alarms.
        quiet: streams without an alarm in as many rows as there should be between alarms.
    """

    detector: str
    limit: float | None
    noise: str
    known: bool
    arl0: Arl0
    quiet: Share

    @classmethod
    def of(
        cls,
        world: StreamWorld,
        method: Method,
        limit: float | None,
        rows: float,
        found: list[Course],
    ) -> "Alarms":
        """Of courses without a change.

        Args:
            world: where their streams come from.
            method: what watched.
            limit: that is reported.
            rows: that should be between alarms.
            found: the courses.
        """
        return cls(
            method.name,
            limit,
            world.noise.name,
            not world.baseline,
            arl0(found, method.limit, world.in_common),
            share(found, method.limit, int(rows), world.in_common),
        )


@dataclass(frozen=True)
class Seen:
    """How soon a detector sees a change in white noise.

    Attributes:
        detector: its name.
        kind: what changes, such as a step.
        fault: in words, without the number of sensors.
        size: of the change [sd].
        count: sensors that change.
        known: whether the noise is known, or estimated from a baseline.
        delay: rows.
    """

    detector: str
    kind: str
    fault: str
    size: float
    count: int
    known: bool
    delay: Delay

    @classmethod
    def of(
        cls, world: StreamWorld, method: Method, fault: StreamChange, found: list[Course]
    ) -> "Seen":
        """Of courses with a change."""
        return cls(
            method.name,
            type(fault).__name__.lower(),
            fault.name,
            fault.size,
            fault.count,
            not world.baseline,
            delay(found, method.limit, world.in_common),
        )


@dataclass(frozen=True)
class Point:
    """A detector at one of its limits, on a step of 1 sd in one sensor.

    Attributes:
        detector: its name.
        limit: of its values.
        arl0: rows between false alarms.
        delay: rows from the onset to the next alarm.
    """

    detector: str
    limit: float
    arl0: float
    delay: float


@dataclass(frozen=True)
class JudgedFigure:
    """A figure with a target.

    Attributes:
        name: what it is.
        value: what was found; None where it is unknown.
        low, high: its 90 % interval.
        rare: whether false alarms are as rare as they should be; else the figure means nothing.
        least, aim: bounds required and aimed at.
    """

    name: str
    value: float | None
    low: float | None
    high: float | None
    rare: bool
    least: Bounds
    aim: Bounds

    @property
    def verdict(self) -> str:
        """Whether the figure lies within the bounds."""
        if not self.rare:
            return "too many false alarms"
        for bounds, word in ((self.aim, "aim"), (self.least, "met")):
            if self.value is None:
                return ""
            low, high = bounds
            if (low is None or low <= self.value) and (high is None or self.value <= high):
                return word
        return "missed"


@dataclass(frozen=True)
class DetectionResult:
    """What was measured, where and when.

    Attributes:
        machine: processor, instruction sets, cores, memory.
        versions: of packages; None for what is not installed.
        day: ISO 8601.
        setting: how much was measured, and the seed.
        alarms: false alarms.
        delays: of every change.
        points: a detector at other limits.
        judged: figures held against their targets.
        throughput: what detectors cost, on one core.
    """

    machine: dict[str, Any]
    versions: dict[str, str | None]
    day: str
    setting: DetectionSetting
    alarms: list[Alarms]
    delays: list[Seen]
    points: list[Point]
    judged: list[JudgedFigure]
    throughput: list[Measurement]
