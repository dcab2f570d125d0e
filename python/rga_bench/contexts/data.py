"""What the rows of a table have in common: the twin's model, and what is measured."""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from rga.arrays import FloatArray
from rga.inference import Rows, TrainingSettings
from rga.inference.networks.design_samples import design
from rga.model import Model, read_model
from rga.twin.calibration.lesson import Lesson
from rga.twin.hardware.interface import Station
from rga.twin.messages.queries import R4, sha256
from rga.twin.simulation_model import SimulationModel
from rga_bench.contexts.context_regime import Contexts
from rga_bench.contexts.drift import MeasuredRows, MeasurementConditions, following, when
from rga_bench.contexts.setting import DRIFTING, ContextsTask
from rga_bench.synthetic.bridges.full_case_study import full_case_study
from rga_bench.synthetic.physical_twin import PhysicalTwin

#: load tests that are drawn; a method gets the first of them, or none
LOAD_TESTS = 60


@dataclass(frozen=True)
class CalibrationData:
    """What a method is calibrated on.

    Attributes:
        lesson: with all load tests; every context is latent.
        usual: what the measured rows are measured under.
        test: rows to score under these conditions; half of them where there are drifts.
    """

    lesson: Lesson
    usual: MeasurementConditions
    test: MeasuredRows

    @property
    def ranges(self) -> FloatArray:
        """Smallest and largest of each context, float[contexts, 2]."""
        return ranges_of(self.lesson.simulation.model)


@dataclass(frozen=True)
class DriftStream:
    """A stream into which a drift comes, and rows to score.

    Attributes:
        rows: of the stream.
        changes: first rows of the parts that differ from the part before.
        drifted: rows to score under the drift, half of the test rows.
    """

    rows: MeasuredRows
    changes: tuple[int, ...]
    drifted: MeasuredRows


def calibration_of(task: ContextsTask) -> CalibrationData:
    """The same for all rows of a split."""
    return _calibration(replace(task, row=""))


def stream_of(task: ContextsTask, drift: str) -> DriftStream:
    """The same for all rows of a split.

    Raises:
        InputError: no such drift.
    """
    return _stream(replace(task, row=""), drift)


def ranges_of(model: Model) -> FloatArray:
    """Smallest and largest of each context, float[contexts, 2]."""
    return np.array([variable.range for variable in model.context.values()])


def station_of(model: Model) -> Station:
    """All sensors of a model, and no context measured."""
    return Station(tuple(model.sensors), (), 0.0, "seconds", {"time": np.zeros(0)})


@lru_cache(maxsize=2)
def _calibration(task: ContextsTask) -> CalibrationData:
    sizes = task.sizes
    model = read_model(full_case_study(), "full case study")
    names, sensors = list(model.context), len(model.sensors)
    ranges = ranges_of(model)
    manner = "ordinary" if task.manner == DRIFTING else task.manner
    contexts = Contexts.drawn(manner, ranges, _generator(task, "contexts"))
    twin = PhysicalTwin.draw(_number(task, "twin"), task.gap)
    usual = MeasurementConditions.usual(twin, contexts, sensors)
    box = dict(zip(names, map(tuple, contexts.source.tolist()), strict=True))
    seed = _number(task, "source")
    source = design(model, sizes.source, latent=names, seed=seed, box=box)
    even = MeasurementConditions.usual(twin, replace(contexts, manner="same"), sensors)
    load_tests = even.measured(LOAD_TESTS, _generator(task, "load tests"))
    real = usual.measured(sizes.unlabelled, _generator(task, "unlabelled")).readings
    lesson = Lesson(
        data=R4(
            row=0,
            simulation=SimulationModel(model, station_of(model)),
            contexts=source.contexts,
            readings=source.readings,
            falling=np.zeros(len(source.contexts), dtype=bool),
            real=real,
            real_contexts=np.zeros((len(real), 0)),
            simulated_rows=len(source.contexts),
            measured_rows=len(real),
            sha256=sha256(source.contexts, source.readings, real),
        ),
        latent=tuple(names),
        noise=np.array([sensor.noise for sensor in model.sensors.values()], dtype=float),
        clock=0.0,
        seed=_number(task, "method"),
        training=TrainingSettings(),
        progress=lambda done: None,
        load_tests=Rows(load_tests.contexts, load_tests.readings),
    )
    test = sizes.test // 2 if task.manner == DRIFTING else sizes.test
    return CalibrationData(lesson, usual, usual.measured(test, _generator(task, "test")))


@lru_cache(maxsize=8)
def _stream(task: ContextsTask, drift: str) -> DriftStream:
    sizes, known = task.sizes, _calibration(task)
    noise = known.lesson.noise
    drifted = known.usual.drifted(drift, noise, _generator(task, f"{drift} drift"))
    holds = when(drift, sizes.stream)
    changes = np.flatnonzero(np.diff(holds)) + 1
    return DriftStream(
        following(known.usual, drifted, holds, _generator(task, f"{drift} stream")),
        tuple(changes.tolist()),
        drifted.measured(sizes.test // 2, _generator(task, f"{drift} drifted")),
    )


def _generator(task: ContextsTask, purpose: str) -> np.random.Generator:
    return np.random.default_rng([task.seed, task.split, *purpose.encode()])


def _number(task: ContextsTask, purpose: str) -> int:
    return int(_generator(task, purpose).integers(2**31))
