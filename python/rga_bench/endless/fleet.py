"""Many bridges on one machine, a row a minute from each, by simulation of the clock."""

import resource
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import rga
from rga_bench.endless.stream import EVERY, Progress, Stream, settings

#: cores that the share is of
CORES = 2
#: minutes before those that are measured, in which all twins are calibrated
BEFORE = 120


@dataclass(frozen=True)
class Fleet:
    """What a fleet costs.

    Attributes:
        bridges, sensors: how many bridges, and sensors on each.
        minutes: that were simulated.
        load: time of the processor over that of two cores in these minutes [-].
        median, slowest: time from the arrival of the rows of a minute until all twins have taken
            them in [s].
    """

    bridges: int
    sensors: int
    minutes: int
    load: float
    median: float
    slowest: float


def fleet(bridges: int, sensors: int, minutes: int, seed: int, progress: Progress) -> Fleet:
    """Feed a row a minute to every bridge, and let one worker play them all in turn."""
    stream = Stream(sensors, 10, settings(1, calibration_rows=100), seed)
    with tempfile.TemporaryDirectory() as folder:
        places = [Path(folder) / str(number) for number in range(bridges)]
        for number, place in enumerate(places):
            with stream.twin(place) as twin:
                stream.play(twin, 0, BEFORE)
            progress(0.5 * number / bridges)
        worker, waits, begun = rga.Worker(places), [], _processor()
        for minute in range(BEFORE, BEFORE + minutes):
            arrived = time.perf_counter()
            for place in places:
                with rga.LiveTwin(place) as twin:
                    twin.feed(stream.rows(minute, minute + 1))
            worker.round()
            waits.append(time.perf_counter() - arrived)
            progress(0.5 + 0.5 * (minute - BEFORE) / minutes)
        spent = _processor() - begun
    return Fleet(
        bridges=bridges,
        sensors=sensors,
        minutes=minutes,
        load=spent / (CORES * EVERY * minutes),
        median=float(np.median(waits)),
        slowest=max(waits),
    )


def _processor() -> float:
    """Time of the processor that this process and its children took so far [s]."""
    own, children = (
        resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return own.ru_utime + own.ru_stime + children.ru_utime + children.ru_stime
