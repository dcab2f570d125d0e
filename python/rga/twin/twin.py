"""A twin as its repository holds it."""

from collections.abc import Mapping
from getpass import getuser
from pathlib import Path
from typing import Self

import numpy as np

from rga.errors import InputError
from rga.findings.phrases import effect_words
from rga.model import Effect, Model
from rga.model.effect import seconds
from rga.records import Record
from rga.simulation.whatif import WhatIf, whatif
from rga.twin.commands.command import AnyCommand, Rollback
from rga.twin.commands.proposals import decision
from rga.twin.hardware.inbox import INBOX
from rga.twin.history import History
from rga.twin.messages.log_text import retold
from rga.twin.repository import Proposal, Repository, RunView, StoredCommand
from rga.twin.repository.faults import InUse
from rga.twin.restore import (
    given_model,
    history_of,
    record_of,
    replay,
    standing_of,
    station_of,
    story_of,
)
from rga.twin.settings import Inference
from rga.twin.state import TwinState
from rga.twin.status import SHOWN, Status
from rga.twin.versions import extended


class Twin:
    """A twin, now or as it stood: its model, its context, its history, and what it answers.

    Nothing but a response changes it; `rollback` asks for one. It reads its repository when it is
    asked, as that stood when the twin was opened, whatever is added meanwhile. It holds no lock:
    `close` it, use it in a `with` block, or leave it to Python.

    Args:
        view: a run of a repository.
        place: of the repository.
        repository: that is closed with the twin; None: it belongs to another.

    Attributes:
        given: the model as it was given.
        station: what is mounted on the structure.
        state: what it holds.
    """

    def __init__(
        self, view: RunView, place: str | Path, repository: Repository | None = None
    ) -> None:
        self._view, self._place, self._repository = view.at_step(view.steps), place, repository
        self.station, self.given = station_of(self._view), given_model(self._view)
        self.state: TwinState = replay(self._view, self.station.channels)

    @classmethod
    def open(cls, place: str | Path, source: str | None = None) -> Self:
        """The twin of the run last acted on in a run's directory, its file, or a database by URL.

        Args:
            place: of the repository.
            source: where the rows of that run come from, such as "live:NAME"; None: from anywhere.

        Raises:
            InputError: there is no repository, or nothing has run in it.
        """
        repository = Repository.open(place, read_only=True)
        try:
            return cls(repository.latest(source), place, repository)
        except BaseException:
            repository.close()
            raise

    def close(self) -> None:
        """Close the connections to its repository; it opens them again where it is asked more."""
        if self._repository is not None:
            self._repository.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def as_of(self, *, row: int | None = None, time: float | str | None = None) -> "Twin":
        """The twin as it stood when the record had reached a row, or a time.

        Args:
            row: number of the row, from 0.
            time: seconds since the first row, or a date as in the record (ISO 8601).

        Raises:
            InputError: a row or time before the record, or a text that is no date.
        """
        elapsed = self._elapsed(time) if isinstance(time, str) else time
        for name, value, given in (("row", row, row), ("time", elapsed, time)):
            if value is not None and not value >= 0:
                raise InputError(
                    f"the {name} {given} is none of the record",
                    name,
                    "give rows, seconds since the first row from 0 on, or a date of the record",
                )
        return Twin(self._view.as_of(row, time=elapsed), self._place)

    def _elapsed(self, moment: str) -> float:
        """Seconds from the first row of the record to a date."""
        station = station_of(self._view)
        if station.time_format != "iso":
            raise InputError(
                f"the record counts seconds, and {moment!r} is a date",
                "time",
                "give seconds since the first row",
            )
        try:
            return seconds(moment) - station.origin
        except ValueError:
            raise InputError(
                f"{moment!r} is no date",
                "time",
                "write it as in the record, such as 2026-03-01T12:00",
            ) from None

    @property
    def version(self) -> int:
        """Number of the model version in force."""
        return self.state.version

    @property
    def model(self) -> Model:
        """The model version in force, without what a calibration has corrected."""
        return extended(self.given, self.state.versions[self.version])

    @property
    def corrected(self) -> Model:
        """The model version in force, its structure as the last calibration has found it."""
        correction = self.state.corrections.get(self.version)
        return self.model if correction is None else correction.corrected(self.model)

    @property
    def inference(self) -> Inference:
        """How contexts are inferred, as the first calibration chose; "auto" before any choice."""
        return standing_of(self._view).inference

    @property
    def context(self) -> Mapping[str, float]:
        """The contexts at which the twin stands."""
        return self.state.context

    @property
    def spread(self) -> dict[str, float]:
        """Standard deviation of each of these contexts."""
        if self.state.row is None:
            return {}
        last = self._view.inferred(self.state.row, self.state.row + 1).spread[0]
        return dict(zip(self.given.context, last.tolist(), strict=True))

    @property
    def record(self) -> Record:
        """The rows that it has taken in."""
        return record_of(self._view)

    @property
    def forgotten(self) -> tuple[tuple[int, int], ...]:
        """First and last row of stretches whose readings were forgotten as asked."""
        return tuple(
            (first, behind - 1) for first, behind in standing_of(self._view).forgotten_rows
        )

    @property
    def _undecided(self) -> str | None:
        proposals = self._view.proposals()
        if not proposals or decision(self._view, proposals[-1]) is not None:
            return None
        return f"proposal {proposals[-1].number}, {proposals[-1].words}"

    def status(self) -> Status:
        """Where the run stands."""
        standing, row = standing_of(self._view), self._view.row
        last = record_of(self._view, max(0, row))
        effects = self.state.versions.get(self.version, {})
        return Status(
            structure=self.given.name,
            stage=standing.stage,
            rows=row + 1,
            time=last.time_label(float(last.time[-1])) if len(last) else None,
            version=self.version,
            causes=tuple(effect_words(one) for one in effects.values()),
            out_of_sync=standing.out_of_sync,
            undecided=self._undecided,
            forgotten=self.forgotten,
            acknowledged_at=self._view.acknowledged_at,
            events=self._view.events()[-SHOWN:],
        )

    def proposals(self) -> tuple[Proposal, ...]:
        """Changes of the model that diagnoses proposed (setting `adopt = "ask"`)."""
        return self._view.proposals()

    def commands(self) -> tuple[StoredCommand, ...]:
        """What people asked for, and what came of it."""
        return self._view.commands()

    def history(self) -> History:
        """What it lived through."""
        return history_of(self._view)

    def log(self) -> list[tuple[int, str, str]]:
        """Row, kinds and words of each exchange of query and response, and of each event."""
        return list(retold(story_of(self._view)))

    def whatif(
        self, settings: Mapping[str, float], add: Mapping[str, Effect] | None = None
    ) -> WhatIf:
        """What a change does to every sensor, from where the twin stands, with intervals.

        Args:
            settings: contexts after the change, and `time` [s] where it matters.
            add: effects that the changed structure has besides.

        Raises:
            InputError: a setting is no context variable, or an effect does not fit.
        """
        record = record_of(self._view, max(0, self._view.rows - 1))
        now = {"time": float(record.origin + record.time[-1])} if len(record) else {}
        answer = whatif(
            self.corrected, settings, add, base={**self.context, **now}, spread=self.spread
        )
        far = self._distance(answer.contexts)
        allowed = standing_of(self._view).distinct
        if far is not None and far > allowed:
            answer.warnings.append(
                f"no simulated or stored context lies near: the nearest is {far:.2g} ranges away, "
                f"neighbours are {allowed:.2g}"
            )
        return answer

    def _distance(self, contexts: Mapping[str, float]) -> float | None:
        """Distance of contexts from all that the repository holds, in shares of the ranges."""
        known = self._view.simulated(version=self.version).contexts
        columns = [list(self.given.context).index(name) for name in self.state.latent]
        if not len(known) or not columns:
            return None
        ranges = np.array([variable.range for variable in self.given.context.values()])
        place = np.array([contexts[name] for name in self.given.context])
        steps = (known - place)[:, columns] / np.ptp(ranges, axis=1)[columns]
        return float(np.linalg.norm(steps, axis=1).min())


def carry_out(place: str | Path, command: AnyCommand, source: str | None = None) -> str:
    """Do what somebody asks a twin for that nothing else is playing.

    Args:
        place: directory of a run, its file, or a database by URL.
        command: of `rga.twin`: Accept, Reject, Rollback, Exclude, Recalibrate, Forget or Note.
        source: of the rows of the run, as of `Twin.open`.

    Returns:
        What came of it, in words.

    Raises:
        InputError: it cannot be done, or the repository is in use.
    """
    from rga.twin.runner import reopened

    try:
        with reopened(place, source) as running:
            return running.carry_out(command)
    except InUse as error:
        if not (Path(place) / INBOX).is_file():
            raise
        remedy = "ask the service or the program that plays it, which carries it out"
        raise InUse(error.what, error.where, remedy) from None


def rollback(place: str | Path, version: int, who: str | None = None, why: str = "") -> Twin:
    """Put an earlier model version in force again: a query Q1, and the twin's response.

    Args:
        place: as of `carry_out`.
        version: its number.
        who: asks for it; None: the user of this machine.
        why: in words.

    Raises:
        InputError: there is no such version, or the repository is in use.
    """
    carry_out(place, Rollback(who=who or getuser(), why=why, version=version))
    return Twin.open(place)
