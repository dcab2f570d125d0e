"""The historical repository as the exchange and the analysis see it."""

import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, replace
from typing import Any, TypeVar

import numpy as np

from rga.arrays import FloatArray
from rga.model import Model
from rga.records import Record
from rga.twin.commands.command import AnyCommand
from rga.twin.commands.exclusion import Excluded, without_excluded
from rga.twin.hardware.interface import Packet, Station
from rga.twin.history import Event
from rga.twin.messages.queries import Q1, Q2, Q4, R1, R2, R3, R4, Message, Response, sha256
from rga.twin.repository import Run, Transaction
from rga.twin.restore import stored_rows
from rga.twin.rows.recent import Stretch
from rga.twin.simulation_model import SimulationModel
from rga.twin.versions import Effects, extended, written

Rows = TypeVar("Rows", Packet, Record, Stretch)


class Archive:
    """A run of the repository, and the step that is open in it.

    Args:
        run: where the history is kept.
        given: the model as it was given.
        station: what is mounted on the structure.
        simulation: the simulation model of a version, by its number.

    Attributes:
        events: that were kept since this archive was opened.
        excluded: readings that are not used.
    """

    def __init__(
        self,
        run: Run,
        given: Model,
        station: Station,
        simulation: Callable[[int], SimulationModel],
    ) -> None:
        self.run = run
        self._given, self._station = given, station
        self._simulation = simulation
        self._step: Transaction | None = None
        self._proposal: Q1 | None = None
        #: by version, as long as no simulation is added
        self._contexts: dict[int, FloatArray] = {}
        self.events: list[Event] = []
        self.excluded: Sequence[Excluded] = ()

    @contextmanager
    def step(self) -> Iterator[None]:
        """One step: all that is logged and kept within it is acknowledged together, or nothing."""
        with self.run.step() as step:
            self._step = step
            try:
                yield
            except BaseException:
                self._contexts.clear()
                raise
            finally:
                self._step = None

    @property
    def _open(self) -> Transaction:
        if self._step is None:
            raise RuntimeError("messages pass within a step")
        return self._step

    def receive(self, packet: Packet) -> None:
        """Keep measured rows."""
        self._open.measured(packet.first, packet.time, packet.readings, packet.contexts)

    def log(self, message: Message) -> None:
        """Write a message into the log."""
        body = message.model_dump(mode="json")
        self._open.message(kind=body.pop("kind"), row=body.pop("row"), body=body)
        if isinstance(message, Q1):
            self._proposal = message

    def take(self, response: Response) -> None:
        """Write a response into the log, and keep what it brings."""
        self.log(response)
        if isinstance(response, R1) and response.adequate:
            self._take_version(response)
        if isinstance(response, R3):
            self._contexts.pop(response.version, None)
            self._open.simulated(
                response.version,
                response.origin,
                response.row,
                response.contexts,
                response.readings,
                response.falling,
            )

    def answer(self, query: Q2 | Q4) -> R2 | R4:
        """What the repository holds."""
        if isinstance(query, Q2):
            box = (np.array(query.box.low), np.array(query.box.high))
            held = self.run.count_simulated(version=query.version, within=box)
            return R2(row=query.row, held=held, missing=max(0, query.wanted - held))
        simulated = self.run.simulated(version=query.version)
        parts = [self.run.measured(first, end) for first, end in query.measured]
        real = np.concatenate([self._used(part.time, part.readings) for part in parts])
        contexts = np.concatenate([part.contexts for part in parts])
        return R4(
            row=query.row,
            simulation=self._simulation(query.version),
            contexts=simulated.contexts,
            readings=simulated.readings,
            falling=simulated.falling,
            real=real,
            real_contexts=contexts,
            simulated_rows=len(simulated),
            measured_rows=len(real),
            sha256=sha256(simulated.contexts, simulated.readings, real, contexts),
        )

    def keep_rows(
        self,
        first: int,
        version: int,
        contexts: FloatArray,
        spread: FloatArray,
        simulated: FloatArray,
        gaps: FloatArray,
    ) -> None:
        """Keep what was inferred and simulated for rows from one on, and their gaps."""
        self._open.inferred(first, contexts, spread, version)
        self._open.gaps(first, simulated, gaps, version)

    def forget(self, first: int, end: int) -> None:
        """Forget readings, simulations and gaps of rows from one to before another."""
        self._open.forget(first, end)

    def rows(self, first: int, end: int) -> Stretch:
        """Rows as they are stored, with what was inferred and simulated last."""
        return self.used(stored_rows(self.run, self._station, self._given, first, end))

    def used(self, rows: Rows) -> Rows:
        """Rows without readings that are not used."""
        return replace(rows, readings=self._used(rows.time, rows.readings))

    def propose(
        self,
        row: int,
        words: str,
        effects: Effects,
        gain: float | None,
        gain_ci90: tuple[float, float] | None,
    ) -> int:
        """Keep a change of the model that somebody has to decide about, and give its number."""
        number = len(self.run.proposals()) + 1
        self._open.proposal(number, row, words, effects, gain, gain_ci90)
        return number

    def keep_command(
        self, command: AnyCommand, body: dict[str, Any], row: int, outcome: str
    ) -> None:
        """Keep what somebody asked for, and what came of it."""
        self._open.command(
            row, command.kind, body, command.who, command.why, command.given_at, outcome
        )

    def keep_novel(
        self, version: int, row: int, contexts: FloatArray, simulated: FloatArray
    ) -> None:
        """T2: keep novel contexts with what the twin simulated there."""
        whole = np.isfinite(simulated).all(axis=1)
        level = np.zeros(int(whole.sum()), dtype=bool)
        self._contexts.pop(version, None)
        self._open.simulated(version, "novel", row, contexts[whole], simulated[whole], level)

    def simulated_contexts(self, version: int) -> FloatArray:
        """Contexts at which a version has been simulated, float[rows, contexts]."""
        if version not in self._contexts:
            self._contexts[version] = self.run.simulated_contexts(version)
        return self._contexts[version]

    def keep_findings(self, row: int, findings: str) -> None:
        """Keep the findings of a diagnosis."""
        self._open.findings(row, findings)

    def keep(self, name: str, data: bytes, row: int) -> None:
        """Keep what is asked for as of a row."""
        self._open.keep(name, data, row)

    def keep_state(self, name: str, data: bytes) -> None:
        """Keep what a run goes on from, in place of what the last step kept."""
        self._open.state(name, data)

    def event(self, event: Event) -> None:
        """Keep what happened to the twin."""
        self._open.event(**asdict(event))
        self.events.append(event)

    def _used(self, time: FloatArray, readings: FloatArray) -> FloatArray:
        station = self._station
        clock = station.origin + time
        return without_excluded(readings, clock, station.channels, self.excluded)

    def _take_version(self, response: R1) -> None:
        """Keep a model version where it is new, and that it is in force."""
        known = {version.number for version in self.run.versions()}
        if response.version not in known:
            text, digest = written(extended(self._given, response.effects))
            proposal = self._proposal
            self._open.version(
                response.version,
                response.row,
                text,
                digest,
                json.dumps(response.effects),
                None if proposal is None else proposal.gain,
                None if proposal is None else proposal.gain_ci90,
                "given" if not response.effects else "extended",
            )
        self._open.in_force(response.version, response.row)
