"""Context capture: simulations, learning, inference, and the twin at the inferred context."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.model.parameter import NORMAL_90
from rga.twin.archive import Archive
from rga.twin.calibration.choice import choose
from rga.twin.calibration.estimator import ContextEstimator, Learn
from rga.twin.calibration.expectation import (
    channels_against_expected,
    of_rows,
    rows_against_expected,
    usual_bound,
)
from rga.twin.calibration.followed_rows import FollowedRows
from rga.twin.calibration.joint_posterior import changes, why_not
from rga.twin.calibration.learning import learn
from rga.twin.calibration.lesson import Lesson
from rga.twin.calibration.states import State
from rga.twin.hardware.interface import Packet, Station
from rga.twin.messages.queries import Q1, Q2, Q3, Q4, Box
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.novelty import beside
from rga.twin.rows.recent import RecentRows
from rga.twin.run_state import Standing
from rga.twin.settings import Inference, Settings

Progress = Callable[[str, float], None]
#: rows by which a state that was kept is tried, at the least
RECALL = 10
#: a context is hardly seen where its interval is this share of what its range alone would give
HARDLY = 0.7


class ContextCapture:
    """What is known of the contexts, and how it comes about.

    Attributes:
        rows: so far, as they were followed.
        learned: what infers contexts now; None before the first calibration, or where none is
            inferred.
        sound: what did so when nothing was in doubt: a new version of the model begins there.
        given: the last such one about the model as it was given.
        inference: the way to infer; "auto" until the first calibration has chosen one.
        optimism: gap of rows that the calibration did not learn from, over that of its own [-].
        draws: seeds drawn so far.
        states: that are kept for when their conditions recur.
        ranges: smallest and largest of each context, float[contexts, 2].

    Args:
        exchange: takes queries to the twin and to the repository.
        archive: keeps what was inferred.
        station: what is mounted on the structure.
        model: as it was given.
        settings: of the run.
        seed: of networks and simulations.
        progress: called with a stage and the share of it that is done.
        own: what learns from lessons, in place of the way that the settings name.
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
        own: Learn | None = None,
    ) -> None:
        self.rows = FollowedRows(exchange, archive, station, model)
        self.learned: ContextEstimator | None = None
        self.sound: ContextEstimator | None = None
        self.given: ContextEstimator | None = None
        self.inference: Inference = settings.inference
        self.optimism = 1.0
        self.draws = 0
        self.states: list[State] = []
        self._own = own
        self._exchange, self._station = exchange, station
        self._settings, self._seed, self._progress = settings, seed, progress
        self._names = list(model.context)
        self._laws = list(model.context.values())
        self.ranges = np.array([v.range for v in self._laws]).reshape(-1, 2)

    def receive(self, packet: Packet) -> None:
        """Take measured rows."""
        self.rows.ledger.append(packet)

    def take_up(
        self,
        rows: int,
        state: bytes | None,
        standing: Standing,
        learned: ContextEstimator | None,
        sound: ContextEstimator | None,
        given: ContextEstimator | None,
        states: list[State],
    ) -> None:
        """Go on where a run stood."""
        followed = standing.row if standing.calibrated else 0
        self.rows.take_up(rows, followed, standing.stuck, state)
        self.draws = standing.draws
        self.inference, self.optimism = standing.inference, standing.optimism
        self.learned, self.sound, self.given = learned, sound, given
        self.states = states

    def read_again(self, standing: Standing) -> None:
        """Other readings are in use now: those in memory are read anew."""
        self.rows.ledger.take_up(len(self.ledger), standing.row if standing.calibrated else 0)

    @property
    def state(self) -> int | None:
        """Number of the kept state that is in force; None: what infers was not kept."""
        own = [number for number, one in enumerate(self.states) if one.estimator is self.learned]
        return own[0] if own else None

    @property
    def ledger(self) -> RecentRows:
        """The rows so far."""
        return self.rows.ledger

    @property
    def latent(self) -> list[int]:
        """Columns of the contexts that are inferred."""
        return self.rows.latent

    @property
    def width(self) -> FloatArray:
        """Of the range of each context that is inferred, float[latent]."""
        return np.asarray(np.ptp(self.ranges, axis=1)[self.latent])

    def follow(self, first: int, end: int) -> None:
        """Infer the contexts of rows, and let the twin simulate them (Q5)."""
        self.rows.follow(self.learned, first, end)

    def usual_gap(self, calibrated: int, rows: int, share: float) -> float:
        """What the gap of so many rows stays below, were they as those of the calibration [-].

        Args:
            calibrated: rows of the first calibration.
            rows: how many.
            share: by which the model was off on these.
        """
        gaps, simulated = self.ledger.gaps(0, calibrated), self.ledger.rows(0, calibrated).simulated
        by_row = rows_against_expected(gaps, simulated, self.rows.noise, share)
        return self.optimism * usual_bound(by_row, rows, self._settings.usual, self._seed)

    def known(self, rows: int) -> list[str]:
        """In words, how well the contexts of the first so many rows are known."""
        columns = self.latent
        if not columns or self.learned is None:
            return []
        spread = self.ledger.rows(0, rows).spread[:, columns]
        half = NORMAL_90 * np.sqrt(np.mean(spread**2, axis=0))
        share = half / (NORMAL_90 * np.ptp(self.ranges[columns], axis=1) / np.sqrt(12))
        units = [self._laws[column].unit for column in columns]
        words = [
            f"{self._names[column]} to {wide:.2g} {unit}".removesuffix(" -")
            + (" (hardly seen)" if hidden > HARDLY else "")
            for column, wide, unit, hidden in zip(columns, half, units, share, strict=True)
        ]
        return [f"known within (90 %): {', '.join(words)}"]

    def told(self, row: int) -> str:
        """The latent contexts of a row, in words."""
        contexts = self.ledger.rows(row, row + 1).contexts[0]
        return ", ".join(
            f"{self._names[column]} {contexts[column]:.3g} {self._laws[column].unit}".removesuffix(
                " -"
            )
            for column in self.latent
        )

    @property
    def corrects(self) -> bool:
        """Whether learning changes the structure, and not what infers contexts alone."""
        return self.learned is not None and self.learned.found is not None

    def novel(self, first: int, end: int) -> bool:
        """Whether most of some rows have contexts that no row before them had."""
        if not first or not self.latent:
            return False
        rows = self.ledger.rows(first, end).contexts[:, self.latent]
        before = self.rows.summaries.contexts_before(first)[:, self.latent]
        return bool(np.mean(beside(rows, before)) > 0.5)

    def changes(self, before: ContextEstimator | None) -> tuple[str, ...]:
        """What structure and sensors have changed by most since an estimator, in words."""
        if self.learned is None or before is None:
            return ()
        return changes(before.found, self.learned.found)

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
                    clock=self.rows.last_clock if row else self._station.origin,
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
            return self.rows.measured_in_words(rows)
        lesson, begun = self._lesson([(0, rows)]), None
        if self._own is not None:
            self._take(self._own(lesson))
            self.trust()
            return "contexts by an estimator of the caller's own"
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
        self.trust()
        return words

    def trust(self) -> None:
        """Nothing is in doubt of what infers now."""
        self.sound, state = self.learned, self._exchange.twin.state
        if not state.versions[state.version]:
            self.given = self.learned

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
            read = np.isfinite(self.ledger.rows(*recent).readings).any()
            rows = recent if read else (0, recent[1])
            lesson = self._lesson([rows])
            if self._own is not None:
                self._take(self._own(lesson))
            else:
                self._take(learn(self.inference, lesson, earlier=earlier))
            self.sound = self.learned

    def restore(self, learned: ContextEstimator | None, sound: ContextEstimator | None) -> None:
        """Take up earlier estimators, and correct the twin as the first of them did."""
        self._take(learned)
        self.sound = sound

    def return_to(self, learned: ContextEstimator | None, first: int, end: int) -> None:
        """Take up an earlier estimator, and follow rows by it again."""
        self.restore(learned, self.sound)
        self.follow(first, end)

    def keep_state(self, first: int, end: int, share: float, doubted: bool) -> None:
        """Keep what infers now, for rows like these, unless it is kept already.

        Args:
            first, end: of the rows.
            share: by which the model was off on the rows of the first calibration [-].
            doubted: the model is in doubt under their conditions.
        """
        ledger = self.ledger
        if self.learned is None or self.state is not None or not self.rows.known(first, end):
            return
        version = self._exchange.twin.state.version
        rows = ledger.rows(first, end)
        gaps = channels_against_expected(
            ledger.gaps(first, end), rows.simulated, self.rows.noise, share
        )
        contexts = rows.contexts.copy()
        self.states.append(State(self.learned, version, (first, end), contexts, gaps, doubted))

    def doubt_states(self, since: int) -> None:
        """States that stand for rows from one on may hide what an alarm is about.

        Args:
            since: first row that the alarm is about.
        """
        self.states = [
            replace(one, doubted=True) if one.rows[1] > since else one for one in self.states
        ]

    def recall(self, first: int, end: int, calibrated: int, share: float) -> State | None:
        """Take up the state that was kept under conditions like those of rows, if there is one.

        It explains these rows as its own, leaves a gap as small as in the first calibration, and a
        smaller one than any other state does. None is taken up where that in force explains them.

        Args:
            first, end: of the rows.
            calibrated: rows of the first calibration.
            share: by which the model was off on these [-].
        """
        known = self.rows.known(first, end)
        if known < RECALL:
            return None
        usual = self.usual_gap(calibrated, known, share)
        version, allowed = self._exchange.twin.state.version, self._settings.usual
        best, least = None, self.rows.gap(first, end, share)
        for state in self.states:
            if state.version != version:
                continue
            contexts, simulated = self.rows.under(state.estimator, first, end)
            squared = (self.ledger.rows(first, end).readings - simulated) ** 2
            gaps = channels_against_expected(squared, simulated, self.rows.noise, share)
            explained = state.explains(contexts, gaps, self.optimism, allowed, self._seed)
            if explained and state.estimator is self.learned:
                return None
            left = float(np.nanmedian(of_rows(gaps))) if explained else np.inf
            if left < least and left <= usual:
                best, least = state, left
        if best is not None:
            self.restore(best.estimator, self.sound if best.doubted else best.estimator)
            self.follow(first, end)
        return best

    def _lesson(self, rows: Sequence[tuple[int, int]]) -> Lesson:
        """All simulations of the version in force, and blocks of measured rows."""
        state, row = self._exchange.twin.state, max(0, len(self.ledger) - 1)
        data = self._exchange.ask(Q4(row=row, version=state.version, measured=tuple(rows)))
        return Lesson(
            data=data,
            latent=state.latent,
            noise=self.rows.noise,
            clock=self.rows.last_clock,
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

    def _draw(self) -> int:
        self.draws += 1
        return int(np.random.SeedSequence([self._seed, self.draws]).generate_state(1)[0])
