"""Context capture: simulations, learning, inference, and the twin at the inferred context."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.model import Model
from rga.twin.archive import Archive
from rga.twin.calibration.channel_noise import noise_of
from rga.twin.calibration.data_driven import DataDrivenModel
from rga.twin.calibration.expectation import against_expected, scatter_share
from rga.twin.messages.hardware import Packet, Station
from rga.twin.messages.queries import Q2, Q3, Q4, Q5, Box, sha256
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.row_buffer import RowBuffer
from rga.twin.run_state import Standing
from rga.twin.settings import Settings

Progress = Callable[[str, float], None]


class ContextCapture:
    """What is known of the contexts, and how it comes about.

    Args:
        exchange: takes queries to the twin and to the repository.
        archive: keeps what was inferred.
        station: what is mounted on the structure.
        model: as it was given.
        settings: of the run.
        seed: of networks and simulations.
        progress: called with a stage and the share of it that is done.
    """

    def __init__(
        self,
        exchange: QueryResponse,
        archive: Archive,
        station: Station,
        model: Model,
        settings: Settings,
        seed: int,
        progress: Progress,
    ) -> None:
        self.ledger = RowBuffer.empty(
            len(station.channels), len(station.measured), len(model.context)
        )
        self.learned: DataDrivenModel | None = None
        self.draws = 0
        self._exchange, self._archive, self._station = exchange, archive, station
        self._settings, self._seed, self._progress = settings, seed, progress
        self._names = list(model.context)
        self._laws = list(model.context.values())
        self.ranges = np.array([v.range for v in self._laws]).reshape(-1, 2)
        self._stated = [model.sensors[name].noise for name in station.channels]
        self.noise = np.ones(len(station.channels))

    def receive(self, packet: Packet) -> None:
        """Take measured rows from the middleware."""
        self.ledger.append(packet)

    def recall(
        self, ledger: RowBuffer, standing: Standing, learned: DataDrivenModel | None
    ) -> None:
        """Go on where a run stood."""
        self.ledger, self.draws, self.learned = ledger, standing.draws, learned
        if standing.calibrated:
            self.noise = noise_of(self._stated, ledger.readings[: standing.calibrated])

    @property
    def latent(self) -> list[int]:
        """Columns of the contexts that are inferred."""
        return [self._names.index(name) for name in self._exchange.twin.state.latent]

    def clock(self, rows: slice) -> FloatArray:
        """Clock of rows [s], on the scale of onsets."""
        return self._station.origin + self.ledger.time[rows]

    def estimate_noise(self) -> None:
        """Noise of the channels, from the model or from the rows so far."""
        self.noise = noise_of(self._stated, self.ledger.readings)

    def gap(self, first: int, end: int, share: float = 0.0) -> float:
        """Gap of rows over the gap to expect of a model that is off by a share [-]."""
        rows = slice(first, end)
        return against_expected(
            self.ledger.gaps[rows], self.ledger.simulated[rows], self.noise, share
        )

    def scatter_share(self, first: int, end: int) -> float:
        """Share by which the model is off on calibrated rows [-]."""
        rows = slice(first, end)
        return scatter_share(self.ledger.gaps[rows], self.ledger.simulated[rows], self.noise)

    def supply(self, ends: FloatArray, wanted: int, requested: bool = False) -> None:
        """Q2 and Q3: let simulations be run where the repository lacks them.

        Args:
            ends: smallest and largest of each context, float[contexts, 2].
            wanted: number of simulations in that box.
            requested: they are wanted for a recalibration, not for the design phase.
        """
        state, row = self._exchange.twin.state, max(0, len(self.ledger) - 1)
        box = Box(low=tuple(ends[:, 0].tolist()), high=tuple(ends[:, 1].tolist()))
        held = self._exchange.ask(Q2(row=row, version=state.version, box=box, wanted=wanted))
        if held.missing:
            self._exchange.ask(
                Q3(
                    row=row,
                    version=state.version,
                    box=box,
                    clock=float(self.clock(slice(-1, None))[0]) if row else self._station.origin,
                    rows=max(2, held.missing),
                    origin="requested" if requested else "design",
                    seed=self._draw(),
                )
            )

    def learn(self, rows: Sequence[tuple[int, int]], afresh: bool) -> None:
        """Q4: learn from all simulations of the version in force and from measured rows.

        Args:
            rows: (first, end) of blocks of measured rows.
            afresh: from new networks, not from those in use.
        """
        state = self._exchange.twin.state
        if not state.latent:
            return
        row = max(0, len(self.ledger) - 1)
        data = self._exchange.ask(Q4(row=row, version=state.version, measured=tuple(rows)))
        self.learned = DataDrivenModel.learn(
            data,
            state.latent,
            noise=self.noise,
            settings=self._settings.training,
            seed=self._draw(),
            start=None if afresh else self.learned,
            clock=float(self.clock(slice(-1, None))[0]),
            progress=lambda done: self._progress("learning contexts", done),
        )

    def follow(self, first: int, end: int) -> None:
        """Infer the contexts of rows, and let the twin simulate them (Q5)."""
        rows = slice(first, end)
        contexts, spread = self._prior(rows)
        if self.learned is not None:
            latent = self.latent
            contexts[:, latent], spread[:, latent] = self.learned.infer(
                first,
                self.ledger.readings[:end],
                self._prior(slice(0, end))[0],
                self.clock(slice(0, end)),
                [self._laws[column] for column in latent],
            )
        self.ledger.contexts[rows], self.ledger.spread[rows] = contexts, spread
        self.send(first, end)

    def send(self, first: int, end: int) -> None:
        """Q5: give the twin the contexts of rows, and keep what it simulates there."""
        ledger, rows, past = self.ledger, slice(first, end), slice(0, first)
        version = self._exchange.twin.state.version
        answer = self._exchange.ask(
            Q5(
                row=end - 1,
                version=version,
                first=first,
                rows=end - first,
                sha256=sha256(ledger.contexts[rows]),
                time=self.clock(rows),
                contexts=ledger.contexts[rows],
                time_before=self.clock(past),
                contexts_before=ledger.contexts[past],
            )
        )
        _, complete = self._told()
        ledger.simulated[rows] = np.where(complete[rows, None], answer.simulated, np.nan)
        self._archive.keep_rows(first, end, version, ledger)

    def _prior(self, rows: slice) -> tuple[FloatArray, FloatArray]:
        """Contexts as measured, and in the middle of their range where nothing measured them."""
        count = len(self.ledger.time[rows])
        contexts = np.tile(self.ranges.mean(axis=1), (count, 1))
        spread = np.tile(np.ptp(self.ranges, axis=1) / np.sqrt(12), (count, 1))
        measured = self._measured
        contexts[:, measured] = self._told()[0][rows]
        spread[:, measured] = [self._laws[column].noise or 0.0 for column in measured]
        return contexts, spread

    @property
    def _measured(self) -> list[int]:
        return [self._names.index(name) for name in self._station.measured]

    def _told(self) -> tuple[FloatArray, NDArray[np.bool_]]:
        return self.ledger.last_measured(self.ranges.mean(axis=1)[self._measured])

    def _draw(self) -> int:
        self.draws += 1
        return int(np.random.SeedSequence([self._seed, self.draws]).generate_state(1)[0])
