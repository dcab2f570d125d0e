"""Which rows a twin learns from after an alarm."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import pytest

import rga
from rga.twin import ContextEstimator, Lesson, Settings
from rga.twin.calibration.joint_posterior import JointEstimator
from rga.twin.runner import Running

Stream = Callable[..., Path]
SETTINGS = Settings(level="B", calibration_rows=100, packet=10, settle=40, arl0=5000)
SENSOR, FIRST = "D2", 150


class Enough(Exception):
    """Nothing more is asked of a run."""


@dataclass(frozen=True, eq=False)
class Fixed:
    """What a first lesson teaches; of later ones it keeps how many rows were new."""

    joint: JointEstimator
    lessons: list[int] = field(default_factory=list)

    def refined(self, lesson: Lesson) -> ContextEstimator:
        self.lessons.append(len(lesson.data.real) - lesson.new)
        return self

    def __getattr__(self, name: str) -> Any:
        return None if name == "found" else getattr(self.joint, name)


@pytest.mark.parametrize(("until", "size", "usual"), [(160, 1.6, True), (300, 2.5, False)])
def test_rows_that_an_alarm_chose_teach_nothing_where_the_gap_is_usual(
    small_stream: Stream, tmp_path: Path, until: int, size: float, usual: bool
) -> None:
    folder = small_stream(sinks=False, drifts=False, rows=300)
    model = rga.load_model(folder / "model.json")
    record = rga.load_record(folder / "record.csv", model).rows(slice(0, 220))
    readings = record.readings.copy()
    column = list(model.sensors).index(SENSOR)
    readings[FIRST:until, column] += size * float(model.sensors[SENSOR].noise or 0.0)
    learned = []

    def learn(lesson: Lesson) -> ContextEstimator:
        learned.append(Fixed(JointEstimator.learn(lesson)))
        return learned[-1]

    def watch(running: Running) -> None:
        if running.stage in ("diagnose", "close"):
            raise Enough

    with pytest.raises(Enough):
        rga.run(
            model, replace(record, readings=readings), tmp_path, settings=SETTINGS, learn=learn,
            watch=watch,
        )  # fmt: skip
    with rga.Twin.open(tmp_path) as twin:
        events = twin.history().events
    alarm, after = (
        next(one for one in events if one.kind == kind) for kind in ("alarm", "recalibration")
    )
    assert FIRST < alarm.row < FIRST + 12
    assert after.words.startswith("contexts explain") is usual
    assert (learned[0].lessons[0] == after.row - alarm.row) is usual
    assert learned[0].lessons[0] >= after.row - alarm.row
