"""The optimum of every change: its limit, its delay, and what other delays would cost."""

from dataclasses import replace
from math import log

from rga_bench.detection.curves import optimal_curve
from rga_bench.detection.faults import StreamChange
from rga_bench.detection.optimum import (
    OPTIMUM,
    expected_delay,
    has_optimum,
    optimal,
    optimal_limit,
)
from rga_bench.detection.rates import limit_for
from rga_bench.detection.result import Point, Seen
from rga_bench.detection.setting import EXAMPLE, DetectionSetting
from rga_bench.detection.tasks import Job, Progress, courses_of
from rga_bench.detection.watch import WatchedCase

#: expected delay below which false alarms are waited for, and how long in each stream, as a part of
#: the rows that should be between them
SOON, WAITED = 4.0, 0.25


def optima(
    setting: DetectionSetting, workers: int, progress: Progress
) -> tuple[list[Seen], list[Point]]:
    """Delays of the optimum for every change that has one; and its curve for the example."""
    faults = [fault for fault in setting.faults() if has_optimum(fault)]
    jobs = [_job(setting, fault) for fault in faults]
    seen, points = [], []
    for fault, job, found in zip(faults, jobs, courses_of(jobs, workers, progress), strict=True):
        changed, *undisturbed = found
        if undisturbed:
            limit = limit_for(undisturbed[0], setting.arl0)
        else:
            limit = optimal_limit(changed, setting.arl0)
        seen.append(Seen.of(job.world, replace(job.method, limit=limit), fault, changed))
        if fault == EXAMPLE:
            points = optimal_curve(OPTIMUM, limit, changed, setting.arl0)
    return seen, points


def _job(setting: DetectionSetting, fault: StreamChange) -> Job:
    """Streams with the change; where it is soon seen, others without it."""
    cases = [setting.changed(fault, setting.streams)]
    if expected_delay(fault, setting.sensors, setting.arl0) < SOON:
        cap = int(WAITED * setting.arl0)
        cases.append(WatchedCase(setting.streams, cap, purpose="limits"))
    method = optimal(fault, setting.sensors, setting.arl0)
    return Job(setting.known, method, tuple(cases), log(setting.arl0))
