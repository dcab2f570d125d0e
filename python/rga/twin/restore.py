"""The past of a run, out of the repository: the twin's state, its rows, and what happened."""

import json
from dataclasses import replace

import numpy as np
from pydantic import ValidationError

from rga.arrays import IntArray
from rga.errors import InputError
from rga.findings.phrases import effect_words
from rga.model import Model, read_model
from rga.records import Record
from rga.twin.calibration.channel_noise import noise_of
from rga.twin.hardware.interface import LIVE, Station
from rga.twin.history import Event, History, Version
from rga.twin.messages.queries import R5, Query, Response, read_message, sha256
from rga.twin.repository import RunView, StoredMessage, StoredReadings
from rga.twin.repository.faults import Damaged
from rga.twin.rows.recent import Stretch, carried_on
from rga.twin.run_state import Standing
from rga.twin.state import TwinState, follow


def replay(view: RunView, channels: tuple[str, ...]) -> TwinState:
    """The state of the twin, from the log of messages alone.

    Args:
        view: a run of the repository, or the run as it stood.
        channels: sensors of the station.

    Raises:
        InputError: what the repository keeps is not what the log records.
    """
    state = TwinState()
    for message in log_of(view, "R1"):
        assert isinstance(message, Response)
        state = follow(state, message, channels)
    stood = view.last_message("R5")
    if stood is None:
        return state
    last = read_message(stood.kind, stood.row, stood.body)
    assert isinstance(last, R5)
    kept = view.gaps(last.first, last.first + last.rows, last.version).simulated
    if view.is_forgotten(last.first):
        kept = np.zeros((0, len(channels)))
    elif sha256(kept) != last.sha256:
        where = f"rows {last.first} to {last.first + last.rows - 1}"
        raise InputError(
            "the repository does not hold what the twin answered", where, "restore it from a copy"
        )
    return follow(state, last.model_copy(update={"simulated": kept}), channels)


def log_of(view: RunView, kind: str | None = None) -> list[Query | Response]:
    """The log of messages, or of one kind, without their arrays.

    Raises:
        InputError: an entry of the log is no message.
    """
    return [_read(one) for one in view.messages(kind)]


def story_of(
    view: RunView, first: int = 0, end: int | None = None
) -> list[Query | Response | Event]:
    """Messages and events in the order in which they passed, at rows from one to before another.

    Raises:
        InputError: an entry of the log is no message.
    """
    return [one if isinstance(one, Event) else _read(one) for one in view.story(first, end)]


def _read(stored: StoredMessage) -> Query | Response:
    try:
        return read_message(stored.kind, stored.row, stored.body)
    except ValidationError as error:
        raise InputError(
            "an entry of the log is no message", "repository", "begin a new run"
        ) from error


def standing_of(view: RunView) -> Standing:
    """Where a run stands."""
    kept = view.kept("standing")
    return Standing() if kept is None else Standing.model_validate_json(kept)


def stored_rows(
    view: RunView,
    station: Station,
    model: Model,
    first: int = 0,
    end: int | None = None,
    at_the_time: bool = False,
) -> Stretch:
    """Rows of a run, with what was inferred and simulated last, or at the time.

    Args:
        view: the run.
        station: what is mounted on the structure.
        model: as it was given.
        first, end: rows from one to before another; None: all from there on.
        at_the_time: what was inferred and simulated first.
    """
    seen, names = view.measured(first, end), list(model.context)
    widths = len(station.channels), len(station.measured), len(names)
    stretch = Stretch.empty(len(seen.rows), *widths)
    if not len(stretch):
        return stretch
    stretch.time[:], stretch.readings[:] = seen.time, seen.readings
    stretch.measured[:] = seen.contexts.reshape(stretch.measured.shape)
    inferred = view.inferred(first, end, at_the_time=at_the_time)
    gaps = view.gaps(first, end, at_the_time=at_the_time)
    if len(inferred.rows):
        stretch.contexts[inferred.rows - first] = inferred.contexts
        stretch.spread[inferred.rows - first] = inferred.spread
        stretch.simulated[gaps.rows - first] = gaps.simulated
    known = stretch.contexts[:, [names.index(name) for name in station.measured]]
    missing = np.isnan(stretch.measured)
    stretch.told[:] = carried_on(stretch.told[:0], np.where(missing, known, stretch.measured))
    return stretch


def station_of(view: RunView) -> Station:
    """What is mounted on the structure.

    Raises:
        InputError: the run was interrupted before its first step ended.
    """
    kept = view.kept("station")
    if kept is None:
        raise InputError("the run has not begun", "repository", "run it again")
    return Station.from_json(kept)


def given_model(view: RunView) -> Model:
    """The model as it was given."""
    return read_model(json.loads(view.versions()[0].model), "repository")


def record_of(view: RunView, first: int = 0, end: int | None = None) -> Record:
    """The rows that the repository holds, from one to before another, as a record."""
    return _as_record(view, view.measured(first, end), station_of(view).channels)


def whole_record(view: RunView) -> tuple[Record, list[tuple[int, int]]]:
    """The rows that the repository holds as they were written, as a record.

    Returns:
        The record, and the first and last rows of those that are damaged.

    Raises:
        InputError: none is whole.
    """
    try:
        return record_of(view), []
    except Damaged:
        whole, damaged = list[StoredReadings](), list[tuple[int, int]]()
    for first, behind in view.packets(0, view.rows):
        try:
            whole.append(view.measured(first, behind))
        except Damaged:
            damaged.append((first, behind - 1))
    if not whole:
        raise InputError("no row is whole", "repository", "restore it from a copy")
    parts = [vars(one).values() for one in whole]
    seen = StoredReadings(*(np.concatenate(column) for column in zip(*parts, strict=True)))
    return _as_record(view, seen, station_of(view).channels), damaged


def chosen_record(view: RunView, rows: IntArray) -> Record:
    """Chosen rows that the repository holds, as a record.

    Args:
        view: a run of the repository.
        rows: int[n].
    """
    return _as_record(view, view.measured_at(rows), station_of(view).channels)


def times_and_contexts(view: RunView, end: int) -> Record:
    """The rows before one as a record without its readings."""
    return _as_record(view, view.times_and_contexts(end), ())


def _as_record(view: RunView, seen: StoredReadings, channels: tuple[str, ...]) -> Record:
    station, rows = station_of(view), len(seen.rows)
    columns = seen.contexts.reshape(rows, len(station.measured)).T
    record = Record(
        time=seen.time,
        start=station.start,
        time_format=station.time_format,
        sensors=channels,
        readings=seen.readings.reshape(rows, len(channels)),
        contexts=dict(zip(station.measured, columns, strict=True)),
        sha256=view.identity.source,
    )
    if not view.identity.source.startswith(LIVE):
        return record
    # Rows that go on arriving are told apart by what they are.
    digest = sha256(record.time, record.readings, seen.contexts)
    return replace(record, sha256=digest)


def history_of(view: RunView) -> History:
    """What a run left behind so far, or had left behind as of a time."""
    standing, station, model = standing_of(view), station_of(view), given_model(view)
    record = record_of(view)
    rows = stored_rows(view, station, model, at_the_time=True)
    stuck = np.array([name in standing.stuck for name in station.channels], dtype=np.bool_)
    # As they were kept: readings that were not used have none.
    kept, gaps = view.gaps(at_the_time=True), np.full(rows.readings.shape, np.nan)
    if len(kept.rows):
        gaps[kept.rows] = kept.gaps
    told = rows.readings[: standing.calibrated or len(rows)]
    state = replay(view, station.channels)
    latent = [list(model.context).index(name) for name in state.latent]
    stated = [model.sensors[name].noise for name in station.channels]
    return History(
        model=model,
        record=record,
        level=json.loads(view.identity.settings)["level"],
        calibration_rows=standing.calibrated,
        contexts=state.latent,
        inferred=rows.contexts[:, latent],
        spread=rows.spread[:, latent],
        simulated=rows.simulated,
        gaps=gaps,
        noise=noise_of(stated, told, stuck),
        events=view.events(),
        versions=_versions(view, record, state),
        growth=_growth(view),
    )


def _versions(view: RunView, record: Record, state: TwinState) -> tuple[Version, ...]:
    """Every version, with the row from which on it was first in force."""
    begun = {number: row for row, number in reversed(view.in_force())}
    return tuple(
        Version(
            number=one.number,
            row=begun[one.number],
            time=record.time_label(float(record.time[begun[one.number]]) if len(record) else 0.0),
            causes=tuple(effect_words(effect) for effect in json.loads(one.causes).values()),
            gain=one.gain,
            gain_ci90=one.gain_ci90,
            in_force=one.number == state.version,
        )
        for one in view.versions()
    )


def _growth(view: RunView) -> tuple[tuple[int, int, int], ...]:
    """(row, simulations stored, novel contexts among them) after every change."""
    stored = view.simulated()
    ends = np.flatnonzero(np.diff(stored.row, append=-1))
    novel = np.cumsum(stored.origin == "novel")
    return tuple((int(stored.row[end]), int(end) + 1, int(novel[end])) for end in ends)
