"""All measurements in one run."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import date
from math import inf

from threadpoolctl import threadpool_limits

from rga.benchmark.detector.charts import Method
from rga.benchmark.detector.curves import curve, optimal_curve
from rga.benchmark.detector.detectors import WINDOW_RULE, Z, free, ready
from rga.benchmark.detector.faults import Fault, Step
from rga.benchmark.detector.noise import WORLDS
from rga.benchmark.detector.optimum import (
    OPTIMUM,
    expected_delay,
    has_optimum,
    optimal,
    optimal_limit,
)
from rga.benchmark.detector.rates import arl0, delay, limit_for, share
from rga.benchmark.detector.result import Alarms, Point, Result, Seen
from rga.benchmark.detector.setting import BASELINE, Setting
from rga.benchmark.detector.targets import targets
from rga.benchmark.detector.tasks import Job, courses_of
from rga.benchmark.detector.watch import Course, World
from rga.benchmark.solver.machine import machine, versions

Progress = Callable[[float], None]
#: share of the time that the limits take, roughly
FIRST = 0.2
#: expected delay of the optimum below which its false alarms are waited for
SOON = 4.0
#: the change of the curves
EXAMPLE = Step(1.0)


@dataclass(frozen=True)
class _Limits:
    """What setting the limits has shown.

    Attributes:
        methods: detectors at their limits.
        delays: of the optimum.
        undisturbed: courses without a change, by the name of the detector.
        points: of the optimum's curve.
    """

    methods: list[Method]
    delays: list[Seen]
    undisturbed: dict[str, list[Course]]
    points: list[Point]


def measure(
    setting: Setting,
    others: Sequence[Method] = (),
    *,
    workers: int = 1,
    progress: Progress | None = None,
) -> Result:
    """All figures, the same ones for any number of processes.

    Args:
        setting: how much is measured.
        others: detectors that are measured beside those of rga; they can be pickled.
        workers: processes of this machine.
        progress: told the share that is done.
    """
    with threadpool_limits(1):
        limits = _limits(setting, workers, _part(progress, 0.0, FIRST))
        methods = [*limits.methods, *ready(setting.sensors, setting.arl0), *others]
        alarms = [_as_published(setting, limits.undisturbed[WINDOW_RULE])]
        delays, points = list(limits.delays), list(limits.points)
        jobs = [job for method in methods for job in _jobs(setting, method)]
        found = courses_of(jobs, workers, _part(progress, FIRST, 1.0))
    for job, cases in zip(jobs, found, strict=True):
        name = job.method.name
        for case, courses in zip(job.cases, cases, strict=True):
            if case.fault is None:
                alarms.append(_alarms(setting, job, courses, name in limits.undisturbed))
                continue
            delays.append(_seen(job.world, name, job.method.limit, case.fault, courses))
            if case.fault == EXAMPLE and not job.world.baseline and name in limits.undisturbed:
                points += curve(name, limits.undisturbed[name], courses, setting.arl0)
    judged = targets(setting.arl0, alarms, delays) if setting.judged else []
    day = date.today().isoformat()
    return Result(machine(), versions(), day, setting, alarms, delays, points, judged)


def _limits(setting: Setting, workers: int, progress: Progress | None) -> _Limits:
    """Limits of the detectors that have none of their own, and of the optimum."""
    methods = free(setting.sensors)
    faults = [fault for fault in setting.faults() if has_optimum(fault)]
    known = setting.known
    jobs = [
        Job(known, method, (setting.undisturbed("limits", method.fill, setting.null),), inf)
        for method in methods
    ]
    optima = [optimal(fault, setting.sensors, setting.arl0) for fault in faults]
    for fault, optimum in zip(faults, optima, strict=True):
        jobs.append(Job(known, optimum, (setting.changed(fault, setting.streams),)))
    direct = [expected_delay(fault, setting.sensors, setting.arl0) < SOON for fault in faults]
    for optimum, watched in zip(optima, direct, strict=True):
        if watched:
            case = setting.undisturbed("limits", 0, max(setting.null // 16, 10))
            jobs.append(Job(known, optimum, (case,), inf))
    found = [cases[0] for cases in courses_of(jobs, workers, progress)]
    undisturbed = dict(zip((one.name for one in methods), found, strict=False))
    changed = found[len(methods) : len(methods) + len(faults)]
    rest = iter(found[len(methods) + len(faults) :])
    delays, points = [], []
    for fault, courses, watched in zip(faults, changed, direct, strict=True):
        limit = (
            limit_for(next(rest), setting.arl0) if watched else optimal_limit(courses, setting.arl0)
        )
        delays.append(_seen(known, OPTIMUM, limit, fault, courses))
        if fault == EXAMPLE:
            points = optimal_curve(OPTIMUM, limit, courses, setting.arl0)
    return _Limits(
        [replace(one, limit=limit_for(undisturbed[one.name], setting.arl0)) for one in methods],
        delays,
        undisturbed,
        points,
    )


def _jobs(setting: Setting, method: Method) -> list[Job]:
    """All that a detector is measured on."""
    known = setting.known
    jobs = [
        Job(known, method, (setting.undisturbed("false alarms", method.fill, setting.null),)),
        *(
            Job(known, method, (setting.changed(fault, setting.streams),))
            for fault in setting.faults()
        ),
    ]
    streams = setting.baselines * setting.each
    for noise in WORLDS:
        world = World(setting.seed, noise, setting.sensors, BASELINE, setting.each)
        cases = [setting.undisturbed("false alarms", 0, streams)]
        if noise == known.noise:
            cases += [setting.changed(fault, streams) for fault in setting.faults_estimated()]
        jobs.append(Job(world, method, tuple(cases)))
    return jobs


def _alarms(setting: Setting, job: Job, courses: list[Course], limited: bool) -> Alarms:
    world, limit = job.world, job.method.limit
    each = world.each if world.baseline else 1
    return Alarms(
        job.method.name,
        limit if limited else None,
        world.noise.name,
        not world.baseline,
        arl0(courses, limit, each),
        share(courses, limit, int(setting.arl0), each),
    )


def _as_published(setting: Setting, courses: list[Course]) -> Alarms:
    """The window rule with the paper's bound."""
    rows = int(setting.arl0)
    found = arl0(courses, Z), share(courses, Z, rows)
    return Alarms(f"{WINDOW_RULE} as published", Z, setting.known.noise.name, True, *found)


def _seen(world: World, name: str, limit: float, fault: Fault, courses: list[Course]) -> Seen:
    return Seen(
        name,
        type(fault).__name__.lower(),
        fault.name,
        fault.size,
        fault.count,
        not world.baseline,
        delay(courses, limit, world.each if world.baseline else 1),
    )


def _part(progress: Progress | None, low: float, high: float) -> Progress | None:
    """Progress of a part of the run."""
    if progress is None:
        return None
    return lambda done: progress(low + done * (high - low))
