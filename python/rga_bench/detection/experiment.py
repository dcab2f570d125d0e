"""How soon a change is seen, at which rate of false alarms, beside the optimum."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from datetime import date
from math import inf
from pathlib import Path
from typing import Any, Self

from threadpoolctl import threadpool_limits

from rga_bench.detection.charts import Method
from rga_bench.detection.curves import curve
from rga_bench.detection.detectors import WINDOW_RULE, Z, free, ready
from rga_bench.detection.noise import WORLDS
from rga_bench.detection.optima import optima
from rga_bench.detection.rates import limit_for
from rga_bench.detection.result import Alarms, DetectionResult, Seen
from rga_bench.detection.setting import BASELINE, EXAMPLE, DetectionSetting, shorter
from rga_bench.detection.table import page
from rga_bench.detection.targets import targets
from rga_bench.detection.tasks import Job, Progress, courses_of
from rga_bench.detection.throughput import throughput
from rga_bench.detection.watch import Course, StreamWorld
from rga_bench.experiment import Execution, Experiment
from rga_bench.machine import machine, versions
from rga_bench.page import MarkdownPage

#: shares of the time that limits and the optimum take, roughly
LIMITS, OPTIMA = 0.1, 0.2


@dataclass(frozen=True)
class DetectionExperiment(Experiment[DetectionResult]):
    """How soon a change is seen.

    Attributes:
        setting: how much is measured.
        others: detectors that are measured beside those of rga; they can be pickled.
    """

    name = "detector"

    setting: DetectionSetting
    others: Sequence[Method] = ()

    @classmethod
    def of(cls, seed: int, *, quick: bool) -> Self:
        """That of a command line."""
        return cls(shorter(seed) if quick else DetectionSetting(seed=seed))

    def measure(self, execution: Execution) -> DetectionResult:
        """All figures; limits and optima come first, since all others depend on them."""
        setting, workers = self.setting, execution.workers

        def part(low: float, high: float) -> Progress:
            return lambda done: execution.progress(low + done * (high - low))

        with threadpool_limits(1):
            costs = throughput(setting.seconds, setting.seed)
            limited, undisturbed = _limited(setting, workers, part(0.0, LIMITS))
            delays, points = optima(setting, workers, part(LIMITS, LIMITS + OPTIMA))
            methods = [*limited, *ready(setting.sensors, setting.arl0), *self.others]
            jobs = [job for method in methods for job in _jobs(setting, method)]
            found = courses_of(jobs, workers, part(LIMITS + OPTIMA, 1.0))
        rule = replace(next(one for one in limited if one.name == WINDOW_RULE), limit=Z)
        alarms = [Alarms.of(setting.known, rule, Z, setting.arl0, undisturbed[WINDOW_RULE])]
        for job, cases in zip(jobs, found, strict=True):
            world, method = job.world, job.method
            own = undisturbed.get(method.name)
            limit = None if own is None else method.limit
            for case, courses in zip(job.cases, cases, strict=True):
                if case.fault is None:
                    alarms.append(Alarms.of(world, method, limit, setting.arl0, courses))
                    continue
                delays.append(Seen.of(world, method, case.fault, courses))
                if case.fault == EXAMPLE and own is not None and not world.baseline:
                    points += curve(method.name, own, courses, setting.arl0)
        judged = targets(setting.arl0, alarms, delays) if setting.judged else []
        if not setting.judged:
            costs = [replace(one, least=None) for one in costs]
        day = date.today().isoformat()
        return DetectionResult(
            machine(), versions(), day, setting, alarms, delays, points, judged, costs
        )

    def page(self, result: DetectionResult, command: str) -> MarkdownPage:
        """All tables."""
        return page(result, command)

    def write_figures(self, result: DetectionResult, folder: Path) -> None:
        """Write `delays.png` and `limits.png`."""
        from rga_bench.detection.plot import plot

        plot(result, folder)

    def content(self, result: DetectionResult, command: str) -> dict[str, Any]:
        """All of the result, with the verdicts on its figures."""
        verdicts = [{**asdict(one), "verdict": one.verdict} for one in result.judged]
        return {"command": command, **asdict(result), "judged": verdicts}


def _limited(
    setting: DetectionSetting, workers: int, progress: Progress
) -> tuple[list[Method], dict[str, list[Course]]]:
    """Detectors with the limits that they need, and what these come from."""
    jobs = [
        Job(setting.known, one, (setting.undisturbed("limits", one.fill, setting.null),), inf)
        for one in free(setting.sensors)
    ]
    found = courses_of(jobs, workers, progress)
    undisturbed = {job.method.name: own for job, (own,) in zip(jobs, found, strict=True)}
    limited = [
        replace(job.method, limit=limit_for(undisturbed[job.method.name], setting.arl0))
        for job in jobs
    ]
    return limited, undisturbed


def _jobs(setting: DetectionSetting, method: Method) -> list[Job]:
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
        world = StreamWorld(setting.seed, noise, setting.sensors, BASELINE, setting.each)
        cases = [setting.undisturbed("false alarms", 0, streams)]
        if noise == known.noise:
            cases += [setting.changed(fault, streams) for fault in setting.faults_estimated()]
        jobs.append(Job(world, method, tuple(cases)))
    return jobs
