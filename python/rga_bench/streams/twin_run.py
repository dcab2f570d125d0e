"""A twin on a stream, as `rga run` plays it, and what became of it."""

import tempfile
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from rga.jobs.run import run
from rga.model import Model, load_model
from rga.model.parameter import NORMAL_90, listed
from rga.records import load_record
from rga.twin import Twin
from rga.twin.history import Event, History
from rga.twin.settings import Settings
from rga_bench.diagnosis.permitted_causes import STIFF_JOINTS
from rga_bench.field.case import draw_field
from rga_bench.streams.setting import ELSEWHERE, StreamTask
from rga_bench.synthetic import Case, draw_stream
from rga_bench.synthetic.noise import stream

#: a broken gauge is off by so many spreads of its noise, from this share of the rows on
BROKEN, BREAKS = (5.0, 20.0), (0.68, 0.74)


@dataclass(frozen=True)
class StreamOutcome:
    """What became of a twin on a stream. Rows are counted from the change on.

    Attributes:
        sort, seed, inference: of the task.
        chosen: inference that was in force.
        error: squared error of the contexts that nothing measures over that of a guess in the
            middle of their ranges, mean over them and the rows after the calibration [-].
        covered: share of their 90 % intervals that hold the truth, on the same rows [-].
        delay: rows from the change to its alarm; None: nothing changed, or no alarm came.
        named: rows from the change to the version that names it; None likewise.
        false_versions: versions with a cause that is none.
        verdict: of the closing diagnosis.
        false_causes: that the closing diagnosis names.
        alarms, recalibrations, diagnoses, new_versions, novel: number of each, and of novel
            contexts.
        gap: median over the rows after the calibration of the gap over the noise, at the time [-].
        seconds: that the run took.
    """

    sort: str
    seed: int
    inference: str
    chosen: str
    error: float
    covered: float
    delay: int | None
    named: int | None
    false_versions: int
    verdict: str
    false_causes: int
    alarms: int
    recalibrations: int
    diagnoses: int
    new_versions: int
    novel: int
    gap: float
    seconds: float = field(compare=False)

    @property
    def id(self) -> str:
        """That of the task."""
        return f"{self.sort}/{self.seed}/{self.inference}"


def run_twin(task: StreamTask) -> StreamOutcome:
    """Draw the stream, and run the twin on it up to its report."""
    case, change = drawn(task)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        case.write(folder)
        model = load_model(folder / "model.json")
        record = load_record(folder / "record.csv", model)
        settings = Settings(inference=task.inference)
        begun = time.perf_counter()
        outcome = run(model, record, folder / "twin", settings=settings, seed=task.seed)
        seconds = time.perf_counter() - begun
        with Twin.open(folder / "twin") as twin:
            chosen, versions = twin.inference, twin.state.versions
    history = outcome.history
    error, covered = _contexts(history, case, model)
    gaps = history.gaps[history.calibration_rows :] / history.noise**2
    wrong = [one for one in versions.values() if any(is_false(e, case) for e in one.values())]
    right = {
        number
        for number, one in versions.items()
        if any(is_hidden(effect, case) for effect in one.values())
    }
    named = [one.row for one in history.versions if one.number in right]
    alarms = [one.row for one in history.events if one.kind == "alarm" and change is not None]
    return StreamOutcome(
        sort=task.sort,
        seed=task.seed,
        inference=task.inference,
        chosen=chosen,
        delay=_after(alarms, change),
        named=_after(named, change),
        false_versions=len(wrong),
        verdict=outcome.findings.verdict,
        false_causes=sum(is_false(one.effect, case) for one in outcome.findings.causes),
        new_versions=len(versions) - 1,
        seconds=seconds,
        gap=float(np.median(np.nanmean(gaps, axis=1))),
        error=error,
        covered=covered,
        **_counts(history.events),
    )


def drawn(task: StreamTask) -> tuple[Case, int | None]:
    """The stream of a task, and the row at which something changes for good."""
    if task.sort in ELSEWHERE:
        return _elsewhere(task), None
    hidden = "drawn" if task.sort == "structure" else None
    drift = task.sort in ("drift", "structure")
    case = draw_stream(task.seed, hidden=hidden, drift=drift, rows=task.rows)
    if task.sort == "structure":
        return case, int(np.searchsorted(case.time, case.truth["onset"]))
    if task.sort != "gauge":
        return case, None
    draw = stream(task.seed, "broken gauge")
    name = str(draw.choice(list(case.model["sensors"])))
    begun = int(draw.uniform(*BREAKS) * task.rows)
    off = float(np.exp(draw.uniform(*np.log(BROKEN)))) * draw.choice([-1.0, 1.0])
    noise = float(case.model["sensors"][name]["noise"])
    case.channels[name] = case.channels[name] + off * noise * (np.arange(task.rows) >= begun)
    case.truth["broken"] = name
    return case, begun


def _elsewhere(task: StreamTask) -> Case:
    """A stream of another structure, none of its contexts measured."""
    case = draw_field(task.seed, structure=task.sort, rows=task.rows)
    assert case.beyond is not None
    for name, course in case.beyond.contexts.items():
        del case.channels[name]
        case.truth.setdefault("contexts", {})[name] = course[: task.rows].tolist()
    return case


def _after(rows: Iterable[int], change: int | None) -> int | None:
    """Rows from a change to the first of some rows behind it."""
    if change is None:
        return None
    return min((row - change + 1 for row in rows if row >= change), default=None)


def is_false(effect: Mapping[str, Any], case: Case) -> bool:
    """Whether an effect is none of a stream; the stiff joints of the frame are true."""
    return not is_hidden(effect, case) and effect["kind"] not in STIFF_JOINTS


def is_hidden(effect: Mapping[str, Any], case: Case) -> bool:
    """Whether an effect is what is hidden in a stream, by kind and place."""
    truth = case.truth
    if "broken" in truth:
        return listed(effect.get("sensor", [])) == [truth["broken"]]
    place = truth["place"].items()
    same = all(listed(effect.get(name, [])) == listed(value) for name, value in place)
    return bool(effect["kind"] == truth["kind"] and same)


def _contexts(history: History, case: Case, model: Model) -> tuple[float, float]:
    """Error and coverage of the contexts inferred after the calibration [-]."""
    watched = slice(history.calibration_rows, None)
    true = np.column_stack([case.truth["contexts"][name] for name in history.contexts])[watched]
    width = np.ptp([model.context[name].range for name in history.contexts], axis=1)
    off = np.abs(history.inferred[watched] - true)
    held = off <= NORMAL_90 * history.spread[watched]
    return float((off**2 / (width**2 / 12)).mean()), float(held.mean())


def _counts(events: Iterable[Event]) -> dict[str, int]:
    kinds = [event.kind for event in events]
    return {
        "alarms": kinds.count("alarm"),
        "recalibrations": kinds.count("recalibration"),
        "diagnoses": kinds.count("diagnosis"),
        "novel": kinds.count("novel context"),
    }
