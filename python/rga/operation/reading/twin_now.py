"""Where a twin that is served stands."""

from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np

from rga.findings.phrases import effect_words
from rga.report.figures.of_run.run_gap import mean
from rga.twin.commands.proposals import decision
from rga.twin.repository import Proposal, RunView
from rga.twin.restore import standing_of
from rga.twin.run_state import Stage, Standing
from rga.twin.twin import Twin

#: rows over which a gap is averaged
RECENT = 24
#: stages before the end of the first calibration
LEARNS = ("initialise", "gather", "calibrate")


@dataclass(frozen=True)
class SensorNow:
    """The last row of a sensor.

    Attributes:
        measured, simulated: in its unit; None: missing.
        noise: standard deviation of a row [its unit]; None: nothing tells it.
        gap: squared difference over the variance of the noise [-].
        recent: mean of the gap over the last rows, which tells more than one of them [-].

    What is simulated, and both gaps, are by the version in force; None: it has not followed them.
    """

    measured: float | None
    simulated: float | None
    noise: float | None
    gap: float | None
    recent: float | None


@dataclass(frozen=True)
class TwinNow:
    """Where a twin stands.

    Attributes:
        steps: that it has acknowledged: another number, another state.
        rows: that it has taken in.
        time: of the last of them; None before the first.
        stage: what it does next.
        version: of the model that is in force; 0 before the first.
        causes: what that version has beyond the model as given, in words.
        out_of_sync: whether readings have left what the model lets expect, and nothing in force
            explains it.
        is_sought: whether the reason for that is being looked for.
        learns: whether it has yet to learn about the version in force.
        undecided: the proposal that nobody has decided about.
        out_of_use: sensors that are not watched now: they were left out of the calibration, or
            somebody has taken them out.
        gap: mean over the sensors in use of the last row, by the version in force [-].
        recent: mean over the sensors in use and the last rows, by the version in force [-].
        sensors: by name.
        contexts: mean and standard deviation of each, in its unit.
    """

    steps: int
    rows: int
    time: datetime | None
    stage: Stage
    version: int
    causes: tuple[str, ...]
    out_of_sync: bool
    is_sought: bool
    learns: bool
    undecided: Proposal | None
    out_of_use: tuple[str, ...]
    gap: float | None
    recent: float | None
    sensors: dict[str, SensorNow]
    contexts: dict[str, tuple[float, float]]


def twin_now(twin: Twin, view: RunView, noise: dict[str, float]) -> TwinNow:
    """Where a twin stands.

    Args:
        twin: as its repository holds it.
        view: its run.
        noise: standard deviation of a row of each sensor [its unit]; NaN where nothing tells it.
    """
    row, standing = view.rows - 1, standing_of(view)
    last = view.measured(max(0, row), row + 1)
    # What a version before has said of these rows would be read as said by the one in force.
    followed = view.gaps(max(0, row + 1 - RECENT), row + 1, version=twin.version)
    reached = len(followed.rows) > 0 and int(followed.rows[-1]) == row
    station = twin.station
    names = list(station.channels)
    none = np.full(len(names), np.nan)
    measured = last.readings[-1] if len(last.rows) else none
    simulated = followed.simulated[-1] if reached else none
    squares = followed.gaps[-1] if reached else none
    recent = mean(followed.gaps, axis=0) if len(followed.rows) else none
    sensors = {}
    for k, name in enumerate(names):
        own = noise.get(name, np.nan)
        sensors[name] = SensorNow(
            _number(measured[k]),
            _number(simulated[k]),
            _number(own),
            _number(squares[k] / own**2),
            _number(recent[k] / own**2),
        )
    time = moment(station.start, float(last.time[-1])) if len(last.rows) else None
    out = out_of_use(standing, time)
    used = [one for name, one in sensors.items() if name not in out]
    known = [one.gap for one in used if one.gap is not None]
    usual = [one.recent for one in used if one.recent is not None]
    proposals = view.proposals()
    open_ = proposals[-1] if proposals and decision(view, proposals[-1]) is None else None
    effects = twin.state.versions.get(twin.version, {})
    spread = twin.spread
    return TwinNow(
        steps=view.steps,
        rows=row + 1,
        time=time,
        stage=standing.stage,
        version=twin.version,
        causes=tuple(effect_words(one) for one in effects.values()),
        out_of_sync=standing.out_of_sync,
        is_sought=standing.alarm is not None,
        learns=standing.stage in LEARNS or standing.learned_under != twin.version,
        undecided=open_,
        out_of_use=tuple(name for name in names if name in out),
        gap=float(np.mean(known)) if known else None,
        recent=float(np.mean(usual)) if usual else None,
        sensors=sensors,
        contexts={
            name: (float(mean), spread.get(name, 0.0)) for name, mean in twin.context.items()
        },
    )


def out_of_use(standing: Standing, time: datetime | None) -> set[str]:
    """Sensors that are not watched at a time: left out by the calibration, or taken out by hand.

    Args:
        standing: of the run.
        time: of the newest row; None: there is none.
    """
    out = set(standing.stuck)
    if time is not None:
        now = time.timestamp()
        for sensor, since, until in standing.excluded:
            if since <= now and (until is None or now < until):
                out.add(sensor)
    return out


def moment(start: str | float, elapsed: float) -> datetime:
    """The time of a row [s since the first] of a twin that is served: its rows are in UTC.

    >>> moment("2026-11-23T00:00:00+00:00", 90.0).isoformat()
    '2026-11-23T00:01:30+00:00'
    """
    return datetime.fromisoformat(str(start)) + timedelta(seconds=elapsed)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
