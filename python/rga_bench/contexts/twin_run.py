"""A twin on a stream into which a drift comes: the loop of the product, at a level of integration.

Diagnoses are left out: an answer would bring another model, and the levels are about contexts.
"""

import tempfile
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from rga.arrays import FloatArray
from rga.records import Record
from rga.twin.calibration.estimator import ContextEstimator, Learn
from rga.twin.calibration.lesson import Lesson
from rga.twin.history import History
from rga.twin.runner import taken_up
from rga.twin.settings import Level, Settings
from rga_bench.contexts.data import CalibrationData, DriftStream
from rga_bench.contexts.drift import MeasuredRows

#: time from one row to the next [s]
STEP = 600.0


@dataclass(frozen=True)
class TwinStream:
    """What a twin gets, row after row.

    Attributes:
        rows: of the calibration, of the stream, under the drift, and under usual conditions again.
        stream, drifted, ordinary: which of them are the latter three.
        contexts: true ones, float[rows, contexts]; NaN in those of the calibration.
    """

    rows: FloatArray
    stream: slice
    drifted: slice
    ordinary: slice
    contexts: FloatArray

    @classmethod
    def of(cls, known: CalibrationData, stream: DriftStream) -> "TwinStream":
        """The rows of a calibration, and of a stream with those to score behind it.

        Args:
            known: what is calibrated on, and rows under usual conditions.
            stream: into which the drift comes, and rows under it.
        """
        real = known.lesson.data.real
        parts: list[MeasuredRows] = [stream.rows, stream.drifted, known.test]
        unknown = np.full((len(real), len(known.ranges)), np.nan)
        ends = len(real) + np.cumsum([0, *(len(part.readings) for part in parts)])
        in_stream, drifted, ordinary = (slice(first, end) for first, end in pairwise(ends.tolist()))
        return cls(
            np.vstack([real, *(part.readings for part in parts)]),
            in_stream,
            drifted,
            ordinary,
            np.vstack([unknown, *(part.contexts for part in parts)]),
        )


class LearnedOnce:
    """Learns what it has learned before without learning again.

    All levels and drifts begin with the same calibration.

    Args:
        learn: learns.
    """

    def __init__(self, learn: Learn) -> None:
        self._learn = learn
        self._known: dict[str, ContextEstimator] = {}

    def __call__(self, lesson: Lesson) -> ContextEstimator:
        """What is learned from a lesson."""
        if lesson.data.sha256 not in self._known:
            self._known[lesson.data.sha256] = self._learn(lesson)
        return self._known[lesson.data.sha256]


def lived_through(
    known: CalibrationData, stream: TwinStream, learn: Learn, level: Level
) -> History:
    """What a twin lived through.

    Args:
        known: what it is calibrated on.
        stream: what it gets.
        learn: learns to infer contexts.
        level: of integration.
    """
    lesson = known.lesson
    model, calibrated = lesson.simulation.model, len(lesson.data.real)
    time = np.arange(len(stream.rows), dtype=float) * STEP
    record = Record(time, 0.0, "seconds", tuple(model.sensors), stream.rows)
    settings = Settings(
        level=level,
        calibration_rows=calibrated,
        design_rows=len(lesson.data.contexts),
        training=lesson.training,
    )
    with (
        tempfile.TemporaryDirectory() as folder,
        taken_up(
            model, record, Path(folder) / "twin.sqlite", settings, lesson.seed, learn=learn
        ) as running,
    ):
        while running.stage not in ("close", "report", "done"):
            if running.stage == "diagnose":
                running.postpone("levels are played without diagnoses")
            else:
                running.step()
        return running.history()
