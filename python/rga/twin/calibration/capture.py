"""Context capture: simulations, learning, inference, and the twin at the inferred context."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.model.parameter import NORMAL_90
from rga.twin.archive import Archive
from rga.twin.calibration.channel_noise import noise_of
from rga.twin.calibration.choice import choose
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.expectation import (
    against_expected,
    rows_against_expected,
    scatter_share,
    usual_bound,
)
from rga.twin.calibration.joint_posterior import changes, why_not
from rga.twin.calibration.learning import learn
from rga.twin.calibration.lesson import Lesson
from rga.twin.messages.hardware import Packet, Station
from rga.twin.messages.queries import Q1, Q2, Q3, Q4, Q5, Box, sha256
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.row_buffer import RowBuffer
from rga.twin.run_state import Standing
from rga.twin.settings import Inference, Settings

Progress = Callable[[str, float], None]
#: a context is hardly seen where its interval is this share of what its range alone would give
HARDLY = 0.7
#: share of their spread by which contexts may lie outside all earlier ones and be like them
BESIDE = 0.1


class ContextCapture:
    """What is known of the contexts, and how it comes about.

    Attributes:
        ledger: the rows so far.
        learned: what infers contexts now; None before the first calibration, or where none is
            inferred.
        sound: what did so when nothing was in doubt: a new version of the model begins there.
        inference: the way to infer; "auto" until the first calibration has chosen one.
        optimism: gap of rows that the calibration did not learn from, over that of its own [-].
        draws: seeds drawn so far.
        ranges: smallest and largest of each context, float[contexts, 2].
        noise: standard deviation of each channel's noise, float[channels].

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
        self.learned: ContextEstimator | None = None
        self.sound: ContextEstimator | None = None
        self.inference: Inference = settings.inference
        self.optimism = 1.0
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
        self,
        ledger: RowBuffer,
        standing: Standing,
        learned: ContextEstimator | None,
        sound: ContextEstimator | None,
    ) -> None:
        """Go on where a run stood."""
        self.ledger, self.draws = ledger, standing.draws
        self.inference, self.optimism = standing.inference, standing.optimism
        self.learned, self.sound = learned, sound
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

    def usual_gap(self, calibrated: int, rows: int, share: float) -> float:
        """What the gap of so many rows stays below, were they as those of the calibration [-].

        Args:
            calibrated: rows of the first calibration.
            rows: how many.
            share: by which the model was off on these.
        """
        ledger, first = self.ledger, slice(0, calibrated)
        by_row = rows_against_expected(
            ledger.gaps[first], ledger.simulated[first], self.noise, share
        )
        return self.optimism * usual_bound(by_row, rows, self._settings.usual, self._seed)

    def known(self, rows: int) -> list[str]:
        """In words, how well the contexts of the first so many rows are known."""
        columns = self.latent
        if not columns or self.learned is None:
            return []
        half = NORMAL_90 * np.sqrt(np.mean(self.ledger.spread[:rows, columns] ** 2, axis=0))
        share = half / (NORMAL_90 * np.ptp(self.ranges[columns], axis=1) / np.sqrt(12))
        units = [self._laws[column].unit for column in columns]
        words = [
            f"{self._names[column]} to {wide:.2g} {unit}".removesuffix(" -")
            + (" (hardly seen)" if hidden > HARDLY else "")
            for column, wide, unit, hidden in zip(columns, half, units, share, strict=True)
        ]
        return [f"known within (90 %): {', '.join(words)}"]

    @property
    def corrects(self) -> bool:
        """Whether learning changes the structure, and not what infers contexts alone."""
        return self.learned is not None and self.learned.found is not None

    def novel(self, first: int, end: int) -> bool:
        """Whether most of some rows have contexts that no row before them had."""
        before, rows = (
            self.ledger.contexts[part][:, self.latent]
            for part in (slice(0, first), slice(first, end))
        )
        if not len(before) or not self.latent:
            return False
        low, high = before.min(axis=0), before.max(axis=0)
        beside = BESIDE * (high - low)
        out = ((rows < low - beside) | (rows > high + beside)).any(axis=1)
        return bool(out.mean() > 0.5)

    def changes(self, before: ContextEstimator | None) -> tuple[str, ...]:
        """What structure and sensors have changed by most since an estimator, in words."""
        if self.learned is None or before is None:
            return ()
        return changes(before.found, self.learned.found)

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

    def calibrate(self, rows: int) -> str:
        """Q4: learn for the first time, from all simulations and so many measured rows.

        Returns:
            How contexts are inferred, and why, in words.

        Raises:
            InputError: the way to infer that the settings name cannot be had.
        """
        if not self._exchange.twin.state.latent:
            return "all contexts are measured"
        lesson, begun = self._lesson([(0, rows)]), None
        words = f"contexts by inference {self.inference!r}, as the settings have it"
        if self.inference not in ("auto", "networks") and (reason := why_not(lesson)):
            raise InputError(
                f"the joint posterior cannot be had: {reason}",
                f"setting inference = {self.inference!r}",
                "take 'auto' or 'networks'",
            )
        if self.inference != "networks":
            chosen = choose(lesson)
            begun, self.optimism = chosen.begun, chosen.optimism
            if self.inference == "auto":
                self.inference, words = chosen.inference, chosen.words
        self._take(learn(self.inference, lesson, begun=begun))
        self.sound = self.learned
        return words

    def recalibrate(self, calibrated: int, recent: tuple[int, int]) -> None:
        """Q4: refine what was learned, on the latest rows beside those of the first calibration.

        Args:
            calibrated: rows of the first calibration.
            recent: (first, end) of the latest rows.
        """
        if self.learned is not None:
            lesson = replace(self._lesson([(0, calibrated), recent]), new=calibrated)
            self._take(self.learned.refined(lesson))

    def learn_version(self, recent: tuple[int, int]) -> None:
        """Q4: learn about a version of the model that has come into force.

        Args:
            recent: (first, end) of the rows that stand under it.
        """
        if self._exchange.twin.state.latent:
            earlier = None if self.sound is None else self.sound.found
            read = np.isfinite(self.ledger.readings[slice(*recent)]).any()
            rows = recent if read else (0, recent[1])
            self._take(learn(self.inference, self._lesson([rows]), earlier=earlier))
            self.sound = self.learned

    def restore(self, learned: ContextEstimator | None, sound: ContextEstimator | None) -> None:
        """Take up earlier estimators, and correct the twin as the first of them did."""
        self._take(learned)
        self.sound = sound

    def _lesson(self, rows: Sequence[tuple[int, int]]) -> Lesson:
        """All simulations of the version in force, and blocks of measured rows."""
        state, row = self._exchange.twin.state, max(0, len(self.ledger) - 1)
        data = self._exchange.ask(Q4(row=row, version=state.version, measured=tuple(rows)))
        return Lesson(
            data=data,
            latent=state.latent,
            noise=self.noise,
            clock=float(self.clock(slice(-1, None))[0]),
            seed=self._draw(),
            training=self._settings.training,
            progress=lambda done: self._progress("learning contexts", done),
        )

    def _take(self, learned: ContextEstimator | None) -> None:
        """Infer by an estimator from now on; the twin takes over what it found (Q1)."""
        self.learned = learned
        if learned is None or learned.correction is None:
            return
        station, row = self._station, max(0, len(self.ledger) - 1)
        self._exchange.ask(
            Q1(
                row=row,
                channels=station.channels,
                measured=station.measured,
                correction=learned.correction,
            )
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
