"""Contexts of the rows so far by an estimator, and what the twin simulates there."""

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel, stuck_channels
from rga.errors import InputError
from rga.findings.criteria.channels import ChannelCriteria
from rga.model import Model
from rga.twin.archive import Archive
from rga.twin.calibration.blocks import BLOCK
from rga.twin.calibration.channel_noise import noise_of
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.expectation import against_expected, scatter_share
from rga.twin.calibration.memories import Mark, Memories
from rga.twin.hardware.interface import Station
from rga.twin.messages.queries import Q5, sha256
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.rows.recent import RecentRows
from rga.twin.rows.summaries import RowSummaries
from rga.twin.simulation_model import SimulationModel

#: rows before a packet that tell of its contexts which keep their value or change slowly; they
#: are in memory
LEAD = 31 * BLOCK


class FollowedRows:
    """The rows so far, with the contexts that were inferred and what was simulated there.

    Attributes:
        ledger: they.
        summaries: of those that have gone by.
        memories: of effects that look back.
        noise: standard deviation of each channel's noise, float[channels]; NaN for one that is
            not to be looked at.

    Args:
        exchange: takes queries to the twin.
        archive: keeps what was inferred.
        station: what is mounted on the structure.
        model: as it was given.
    """

    def __init__(
        self, exchange: QueryResponse, archive: Archive, station: Station, model: Model
    ) -> None:
        channels, contexts = len(station.channels), len(model.context)
        self.ledger = RecentRows(channels, len(station.measured), contexts, archive.rows)
        self.summaries = RowSummaries(self.ledger, channels, contexts)
        self._exchange, self._archive, self._station = exchange, archive, station
        self._names, self._laws = list(model.context), list(model.context.values())
        self._ranges = np.array([one.range for one in self._laws]).reshape(-1, 2)
        self._stated = [model.sensors[name].noise for name in station.channels]
        self.noise = np.ones(len(station.channels))
        self.memories = Memories()

    def take_up(
        self, rows: int, followed: int, stuck: tuple[str, ...], state: bytes | None
    ) -> None:
        """Go on with the rows of a run.

        Args:
            rows: how many there are.
            followed: how many of them have contexts.
            stuck: channels that stood still in the first calibration.
            state: as `to_bytes` gave it; None: there was no calibration yet.
        """
        self.ledger.take_up(rows, followed)
        self.ledger.leave_out(self._station.channels, stuck)
        if state is not None:
            of_noise = self.noise.nbytes
            self.noise = np.frombuffer(state[:of_noise], dtype="<f8").astype(float)
            self.summaries.restore(state[of_noise:])

    def to_bytes(self) -> bytes:
        """What a run goes on from, beside its rows."""
        return self.noise.astype("<f8").tobytes() + self.summaries.to_bytes()

    def judge_channels(self, criteria: ChannelCriteria) -> list[BrokenChannel]:
        """Channels that stand still in the rows so far, left out from now on; noise of the others.

        Args:
            criteria: when a channel is stuck.

        Raises:
            InputError: all of them stand still.
        """
        channels, readings = self._station.channels, self.ledger.rows(0, len(self.ledger)).readings
        stuck = stuck_channels(channels, readings, np.isfinite(readings), criteria)
        if len(stuck) == len(channels):
            raise InputError(
                "none of the channels works",
                f"record; of {stuck[0].sensor!r}, {stuck[0].why}",
                "check the record and the mapping",
            )
        self.ledger.leave_out(channels, {one.sensor for one in stuck})
        self.noise = noise_of(self._stated, readings, self.ledger.stuck)
        return stuck

    def measured_in_words(self, rows: int) -> str:
        """Which contexts the first so many rows have values of, where none has to be inferred."""
        came = np.isfinite(self.ledger.rows(0, rows).measured).any(axis=0)
        there = {self._station.measured[column] for column in np.flatnonzero(came)}
        lacking = [name for name in self._names if name not in there]
        if not lacking:
            return "all contexts are measured"
        return f"contexts are measured, but no value came of {', '.join(lacking)}"

    def gap(self, first: int, end: int, share: float = 0.0) -> float:
        """Gap of rows over the gap to expect of a model that is off by a share [-]."""
        gaps, simulated = self.ledger.gaps(first, end), self.ledger.rows(first, end).simulated
        return against_expected(gaps, simulated, self.noise, share)

    def scatter_share(self, first: int, end: int) -> float:
        """Share by which the model is off on calibrated rows [-]."""
        gaps, simulated = self.ledger.gaps(first, end), self.ledger.rows(first, end).simulated
        return scatter_share(gaps, simulated, self.noise)

    def known(self, first: int, end: int) -> int:
        """How many of some rows have a gap."""
        return int(np.isfinite(self.ledger.gaps(first, end)).any(axis=1).sum())

    @property
    def latent(self) -> list[int]:
        """Columns of the contexts that are inferred."""
        return [self._names.index(name) for name in self._exchange.twin.state.latent]

    def clock(self, first: int, end: int) -> FloatArray:
        """Clock of rows [s], on the scale of onsets."""
        return self._station.origin + self.ledger.rows(first, end).time

    @property
    def last_clock(self) -> float:
        """Clock of the last row, of the first before there is any [s]."""
        rows = len(self.ledger)
        return float(self.clock(rows - 1, rows)[0]) if rows else self._station.origin

    def follow(self, estimator: ContextEstimator | None, first: int, end: int) -> None:
        """Infer the contexts of rows, and let the twin simulate them (Q5).

        Args:
            estimator: that infers; None: nothing is inferred.
            first, end: of the rows.
        """
        contexts, spread = self._prior(first, end)
        if estimator is not None:
            contexts, spread = self._inferred(estimator, first, end)
        version = self._exchange.twin.state.version
        simulation = self._exchange.twin.simulation(version)
        answer = self._exchange.ask(self._question(simulation, first, end, contexts))
        if answer.memory is not None:
            mark = Mark(end, version, simulation.structure, answer.memory)
            self.memories.keep(first, mark)
        simulated = answer.simulated
        self.ledger.followed(first, contexts, spread, simulated)
        gaps = (self.ledger.rows(first, end).readings - simulated) ** 2
        gaps[:, self.ledger.stuck] = np.nan
        self._archive.keep_rows(first, version, contexts, spread, simulated, gaps)
        self.summaries.followed(first, end)

    def under(
        self, estimator: ContextEstimator, first: int, end: int
    ) -> tuple[FloatArray, FloatArray]:
        """What contexts of rows another estimator infers, and what the twin would simulate there.

        Returns:
            float[rows, contexts], and float[rows, channels] with the twin corrected as it has
            found it, NaN where a measured context is missing.
        """
        contexts, _ = self._inferred(estimator, first, end)
        given = self._exchange.twin.simulation()
        corrected = SimulationModel(given.model, self._station, estimator.correction)
        answer = corrected.follow(self._question(corrected, first, end, contexts))
        return contexts, answer.simulated

    def _inferred(
        self, estimator: ContextEstimator, first: int, end: int
    ) -> tuple[FloatArray, FloatArray]:
        """All contexts of rows and their standard deviations, float[rows, contexts] each."""
        latent = self.latent
        laws = [self._laws[column] for column in latent]
        begin = 0
        if not estimator.remembers and all(one.law != "linear" for one in laws):
            lead = 0 if all(one.law == "independent" for one in laws) else LEAD
            begin = max(0, first - first % BLOCK - lead)
        contexts, spread = self._prior(first, end)
        contexts[:, latent], spread[:, latent] = estimator.infer(
            first - begin,
            self.ledger.rows(begin, end).readings,
            self._prior(begin, end)[0],
            self.clock(begin, end),
            laws,
        )
        return contexts, spread

    def _question(
        self, simulation: SimulationModel, first: int, end: int, contexts: FloatArray
    ) -> Q5:
        """What does the twin simulate at contexts of rows, float[rows, contexts]?"""
        version = self._exchange.twin.state.version
        # A train's direction shows from row to row; more of the past only matters to a memory.
        begin, memory = 0 if simulation.remembers else max(0, first - 1), None
        if simulation.carries:
            begin, memory = self.memories.before(first, version, simulation.structure)
        return Q5(
            row=end - 1,
            version=version,
            first=first,
            rows=end - first,
            sha256=sha256(contexts),
            time=self.clock(first, end),
            contexts=contexts,
            time_before=self.clock(begin, first),
            contexts_before=self.ledger.rows(begin, first).contexts,
            memory=memory,
            unknown=self._unknown(first, end),
        )

    def _prior(self, first: int, end: int) -> tuple[FloatArray, FloatArray]:
        """Contexts as measured, and in the middle of their range where nothing measured them."""
        count = end - first
        contexts = np.tile(self._ranges.mean(axis=1), (count, 1))
        spread = np.tile(np.ptp(self._ranges, axis=1) / np.sqrt(12), (count, 1))
        measured = self._measured
        told = self.ledger.rows(first, end).told
        contexts[:, measured] = np.where(np.isnan(told), contexts[:, measured], told)
        spread[:, measured] = [self._laws[column].noise or 0.0 for column in measured]
        return contexts, spread

    @property
    def _measured(self) -> list[int]:
        return [self._names.index(name) for name in self._station.measured]

    def _unknown(self, first: int, end: int) -> NDArray[np.bool_]:
        """Whether a measured context is missing, bool[rows]."""
        measured = self.ledger.rows(first, end).measured
        return np.asarray(~np.isfinite(measured).all(axis=1))
