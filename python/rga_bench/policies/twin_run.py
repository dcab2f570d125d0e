"""A twin on a stream: what its policy cost, and the gap that it left."""

import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rga.model import load_model
from rga.records import load_record
from rga.twin.calibration.expectation import rows_against_expected
from rga.twin.history import History
from rga.twin.messages.queries import Q3, Q4
from rga.twin.repository import Repository, RunView
from rga.twin.restore import history_of, log_of, standing_of
from rga.twin.runner import taken_up
from rga.twin.settings import Settings
from rga_bench.policies.setting import OUT_OF_SYNC, STREAMS, PolicyTask
from rga_bench.synthetic import draw_stream


@dataclass(frozen=True)
class PolicyResult:
    """What became of a twin on a stream; costs are those after the first calibration.

    Attributes:
        stream, seed, policy: of the task.
        recalibrations, alarms: number of each.
        diagnoses: that were requested.
        steps: of the optimiser, in all trainings.
        simulations: that were requested.
        gap: mean over the rows and sensors of the squared gap over the variance of the noise, as
            the twin stood at the time [-].
        rg: the paper's RG, the mean of the squared gap over the rows and displacement sensors,
            as the twin stood at the time [mm^2].
        out_of_sync: share of the rows whose gap is beyond what a recalibration may leave [-].
        seconds: that the rows took.
    """

    stream: str
    seed: int
    policy: str
    recalibrations: int
    alarms: int
    diagnoses: int
    steps: int
    simulations: int
    gap: float
    rg: float
    out_of_sync: float
    seconds: float = field(compare=False)

    @property
    def id(self) -> str:
        """That of the task."""
        return f"{self.seed}/{self.stream}/{self.policy}"


def run_twin(task: PolicyTask) -> PolicyResult:
    """Draw the stream, and let the twin run through it up to the closing diagnosis.

    Nothing is hidden in the structure: a diagnosis that the twin requests is counted, not made.
    """
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        case = draw_stream(task.seed, hidden=None, rows=task.rows, **STREAMS[task.stream])
        case.write(folder)
        model = load_model(folder / "model.json")
        record = load_record(folder / "record.csv", model)
        begun = 0.0
        with taken_up(model, record, folder, task.settings, task.seed) as running:
            while running.stage != "close":
                if running.stage == "diagnose":
                    running.postpone("nothing is hidden here")
                else:
                    running.step()
                if running.stage == "watch" and not begun:
                    begun = time.perf_counter()
            seconds = time.perf_counter() - begun
        with Repository.open(folder, read_only=True) as kept:
            (view,) = kept.runs()
            return _measured(task, view, seconds)


def _measured(task: PolicyTask, view: RunView, seconds: float) -> PolicyResult:
    history, log = history_of(view), log_of(view)
    kinds = [event.kind for event in history.events]
    trained = sum(isinstance(one, Q4) for one in log)
    simulated = [one.rows for one in log if isinstance(one, Q3)]
    return PolicyResult(
        stream=task.stream,
        seed=task.seed,
        policy=task.policy,
        recalibrations=kinds.count("recalibration"),
        alarms=kinds.count("alarm"),
        diagnoses=kinds.count("diagnosis"),
        steps=_steps(trained, kinds.count("recalibration"), task.settings),
        simulations=sum(simulated[1:]),
        seconds=seconds,
        **_gaps(history, standing_of(view).share, OUT_OF_SYNC),
    )


def _steps(trained: int, recalibrations: int, settings: Settings) -> int:
    """Of all trainings but the first: of recalibrations, and of networks begun for a version."""
    training = settings.training
    afresh = trained - 1 - recalibrations
    reduced = training.reduced_steps if training.physics == "reduced" else 0
    return recalibrations * training.fine_steps + afresh * (training.steps + reduced)


def _gaps(history: History, share: float, allowed: float) -> dict[str, float]:
    watched = slice(history.calibration_rows, None)
    gaps, simulated = history.gaps[watched], history.simulated[watched]
    moves = [sensor.kind == "displacement" for sensor in history.model.sensors.values()]
    expected = rows_against_expected(gaps, simulated, history.noise, share)
    return {
        "gap": float(np.nanmean(rows_against_expected(gaps, simulated, history.noise, 0.0))),
        "rg": float(np.nanmean(gaps[:, moves])),
        "out_of_sync": float(np.mean(expected > allowed)),
    }
