"""The reality gap analysis: calibrates, watches, recalibrates, and asks the diagnosis.

It reaches the twin and the repository through queries alone. Each public method that acts is one
step of a run.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from rga.findings import Findings
from rga.findings.phrases import effect_words
from rga.twin.archive import Archive
from rga.twin.calibration.capture import ContextCapture
from rga.twin.commands.proposals import Proposals
from rga.twin.hardware.interface import Station
from rga.twin.history import Event, Kind
from rga.twin.integration import Integration
from rga.twin.judgement import judged, unsettled
from rga.twin.messages.queries import Q1, R1
from rga.twin.messages.query_bus import QueryResponse
from rga.twin.novelty import spacing
from rga.twin.run_state import Standing
from rga.twin.settings import Pace, Settings
from rga.twin.sync.detector import synchrony
from rga.twin.sync.policy import Policy
from rga.twin.versions import Effects, first_row_under

#: a gap that rises by more than this factor speaks against a new version
WORSE = 1.25
#: of the gap to expect, that may stay after a recalibration whatever the calibration left [-]
LEAST_ALLOWED = 0.1
#: rows that a new version learns from, at the least and at the most
LEAST_LEARNED, MOST_LEARNED = 10, 20_000


class RealityGapAnalysis:
    """The workflow algorithms of the twin.

    Args:
        exchange: takes queries to the twin and to the repository.
        archive: keeps events and findings.
        station: what is mounted on the structure.
        calibration: captures the contexts.
        settings: of the run.
        pace: how many rows it gathers for what.
        label: how the record writes the time of a row.
    """

    def __init__(
        self,
        exchange: QueryResponse,
        archive: Archive,
        station: Station,
        calibration: ContextCapture,
        settings: Settings,
        pace: Pace,
        label: Callable[[int], str | float],
    ) -> None:
        self.standing = Standing()
        self.synchrony = synchrony(station.channels, settings)
        self._exchange, self._archive, self._station = exchange, archive, station
        self._calibration, self._settings = calibration, settings
        self._pace, self._label = pace, label
        self._policy, self._proposals = Policy.of(settings, pace), Proposals(archive)
        self._integration = Integration(exchange, archive, calibration, settings, self.event)

    @property
    def changed(self) -> bool:
        """Whether something seems to have changed since the calibration; at the end, had seemed."""
        if self.standing.stage in ("report", "done"):
            return self.standing.about_change
        return self.standing.doubted or bool(self._exchange.twin.effects)

    def initialise(self) -> R1:
        """Q1: can the twin represent what a calibration needs? Then the design phase is filled."""
        answer = self.ask_twin()
        if answer.adequate:
            if answer.latent:
                self._design()
                stored = self._archive.simulated_contexts(answer.version)
                latent, width = self._calibration.latent, self._calibration.width
                near = spacing(stored[:, latent], width)
                self.standing.distinct = self._settings.distinct or near
            if answer.blind:
                words = (
                    f"no channel sees {', '.join(answer.blind)}: held in the middle of the range"
                )
                self.event("calibration", 0, words)
            self.standing.stage = "gather"
        return answer

    def take_up_version(self) -> None:
        """Learn about a version that was put in force by hand, from the calibration's rows.

        The latest rows are followed by it, which is in doubt where it does not explain them.
        """
        standing, calibration = self.standing, self._calibration
        self._design()
        calibration.learn_version((0, standing.calibrated))
        if standing.row > standing.calibrated:
            first = standing.row - self._pace.settle if standing.since is None else standing.since
            recent = (max(first, standing.calibrated), standing.row)
            calibration.follow(*recent)
            left, rows = calibration.rows.gap(*recent, standing.share), recent[1] - recent[0]
            usual = calibration.usual_gap(standing.calibrated, rows, standing.share)
            standing.doubted = left > usual

    def gather(self) -> None:
        """Wait until enough rows are there for the first calibration."""
        self.standing.row = len(self._calibration.ledger)
        if self.standing.row >= self._pace.calibration_rows:
            self.standing.stage = "calibrate"

    def calibrate(self) -> None:
        """Q4: learn from simulated and measured rows, and measure the gap that is left."""
        standing, calibration = self.standing, self._calibration
        standing.calibrated = standing.row
        stuck = calibration.rows.judge_channels(self._settings.criteria.channels)
        standing.stuck = tuple(one.sensor for one in stuck)
        chosen = calibration.calibrate(standing.row)
        calibration.follow(0, standing.row)
        self._begin_again(0)
        standing.interval = self._policy.interval
        standing.share = calibration.rows.scatter_share(0, standing.row)
        left = calibration.rows.gap(0, standing.row, standing.share)
        words = "; ".join([
            f"calibrated on {standing.row} rows",
            *(f"{one.sensor} is left out: {one.why}" for one in stuck),
            chosen,
            *calibration.known(standing.row),
            *unsettled(left),
            *self.synchrony.warnings,
        ])  # fmt: skip
        after = calibration.rows.gap(0, standing.row)
        self.event("calibration", standing.row - 1, words, after=after)
        self._keep_state(0, standing.row)
        standing.stage = "watch"

    def watch(self) -> None:
        """Infer the new rows' contexts, measure their gap (T1), and store what is novel (T2)."""
        standing, settings = self.standing, self._settings
        first, end = standing.row, len(self._calibration.ledger)
        self._calibration.follow(first, end)
        standing.row = end
        if settings.level != "A":
            self._detect(first, end)
        if settings.level == "C" and (standing.alarm is None or self._recalled()):
            self._integration.integrate(standing.distinct, first, end)
        self._choose_next()

    def end(self) -> None:
        """No more rows will come: what an alarm waits for is done with what there is."""
        self.standing.ended = True
        self._choose_next()
        if self.standing.stage == "watch":
            self.standing.stage = "close"

    def recalibrate(self, first: int | None = None) -> None:
        """T1: learn from the latest rows; what contexts do not explain puts the model in doubt.

        Args:
            first: of these rows; None: as the policy has it.
        """
        standing, settings, calibration = self.standing, self._settings, self._calibration
        first = self._policy.due(standing) if first is None else first
        assert first is not None
        recent = (first, standing.row)
        open_alarm = self._policy.waits(standing)
        usual = calibration.usual_gap(standing.calibrated, recent[1] - recent[0], standing.share)
        gap = calibration.rows.gap
        before, expected = gap(*recent), gap(*recent, standing.share)
        known, learned_from = calibration.learned, recent
        if standing.alarm is not None and expected <= usual:
            # An alarm chooses rows that look odd, be it by chance: those after it tell what is so.
            learned_from = (max(first, standing.alarm + 1), standing.row)
        self._refine(learned_from)
        changes = calibration.changes(known) if calibration.corrects else None
        if learned_from != recent:
            calibration.return_to(known if changes == () else calibration.learned, *recent)
        after, left = gap(*recent), gap(*recent, standing.share)
        rows, novel = f"rows {recent[0]} to {recent[1] - 1}", calibration.novel(*recent)
        inferred = bool(calibration.latent)
        doubted, words = judged(rows, expected, left, usual, changes, novel, inferred=inferred)
        allowed = max(usual - 1.0, LEAST_ALLOWED)
        interval = self._policy.next_interval(standing.interval, expected - left, allowed)
        if interval != standing.interval:
            words += f"; the interval is now {interval} rows"
        standing.interval = interval
        self.event("recalibration", standing.row - 1, words, before=before, after=after)
        standing.doubted = standing.doubted or doubted
        if not standing.doubted and not open_alarm:
            calibration.trust()
        if not doubted and settings.level == "C" and not open_alarm:
            self._integration.integrate(standing.distinct, *recent)
        if left <= usual and not open_alarm:
            self._keep_state(*recent)
        self._begin_again(None)
        if standing.doubted and self._may_ask():
            standing.stage = "diagnose"
        else:
            self._go_on(open_alarm)

    def postpone(self, why: str) -> None:
        """The diagnosis cannot say anything of the rows so far: it is asked again later."""
        self.event("diagnosis", self.standing.row - 1, f"not possible yet: {why}")
        self.standing.diagnosed = self.standing.row
        self._go_on()

    def conclude(self, findings: Findings, effects: Effects, closing: bool) -> None:
        """Take findings over: an extended model becomes a new version of the twin.

        Args:
            findings: of all rows so far, about the model as it was given.
            effects: what the extended model has beyond it.
            closing: no more rows will come.
        """
        standing = self.standing
        standing.about_change = self.changed
        self._archive.keep_findings(standing.row - 1, findings.to_json())
        self.event("diagnosis", standing.row - 1, findings.sentence())
        held, in_force = findings.gap.held_out, self._exchange.twin.effects
        change = self._propose if self._settings.adopt == "ask" else self.adopt
        # What is named leaves a doubt until a version stands that has it.
        standing.diagnosed, standing.doubted = standing.row, not effects or effects != in_force
        if effects and effects != in_force and held.gain > 0:
            change(effects, held.gain, held.gain_ci90)
        elif in_force and not effects:
            change({}, None, None)
        elif words := self._proposals.withdraw(standing.row - 1):
            self.event("proposal", standing.row - 1, words)
        self._go_on()
        if closing:
            standing.stage = "report"

    def adopt(
        self,
        effects: Effects,
        gain: float | None,
        gain_ci90: tuple[float, float] | None,
        first: int | None = None,
    ) -> None:
        """Let effects become a version of the twin; none bring back the model as it was given.

        Args:
            effects: beyond the model as it was given.
            gain, gain_ci90: held-out gain of the diagnosis that names them.
            first: of the latest rows that stand under them; None: as it follows from them.
        """
        if effects:
            self._change_version(first, effects=effects, gain=gain, gain_ci90=gain_ci90)
        else:
            self._change_version(first, restore=1)

    def _propose(
        self, effects: Effects, gain: float | None, gain_ci90: tuple[float, float] | None
    ) -> None:
        row = self.standing.row - 1
        self.standing.proposed = self._under_the_same(effects)
        self.event("proposal", row, self._proposals.add(row, effects, gain, gain_ci90))

    def _detect(self, first: int, end: int) -> None:
        alarm = self.synchrony.alarm(first, end, self._calibration.ledger.residuals)
        if alarm is None or self.standing.alarm is not None:
            return
        self.standing.alarm, self.standing.since = alarm.row, alarm.since
        self._calibration.doubt_states(alarm.since)
        self.event("alarm", alarm.row, alarm.words, alarm.sensors)

    def _recalled(self) -> bool:
        """Whether a state that was kept explains the rows since a change: it is in force then."""
        standing, calibration = self.standing, self._calibration
        if standing.since is None or not self._policy.alarms:
            return False
        rows = standing.since, standing.row
        before = calibration.rows.gap(*rows)
        state = calibration.recall(*rows, standing.calibrated, standing.share)
        if state is None:
            return False
        self._refine(rows)
        if calibration.changes(state.estimator):
            calibration.return_to(state.estimator, *rows)
        after, words = calibration.rows.gap(*rows), state.taken_up(*rows)
        self.event("recall", standing.row - 1, words, before=before, after=after)
        self._begin_again(None)
        if state.doubted and self._may_ask():
            standing.diagnosed = None  # it is asked at once
        standing.doubted = standing.doubted or state.doubted
        standing.alarm = standing.since = None
        return True

    def _keep_state(self, first: int, end: int) -> None:
        standing = self.standing
        if self._settings.level == "C":
            self._calibration.keep_state(first, end, standing.share, standing.doubted)

    def _refine(self, recent: tuple[int, int]) -> None:
        """Learn from the latest rows; where that makes the gap larger, return to what was."""
        if (calibration := self._calibration).learned is None or recent[0] == recent[1]:
            return
        version = self._exchange.twin.state.version
        stored = self._archive.run.simulated(version=version, origin="novel").contexts
        if len(stored):
            around = np.stack([stored.min(axis=0), stored.max(axis=0)], axis=1)
            wanted = self._settings.design_rows // 8
            calibration.supply(around, wanted, requested=True)
        kept, before = calibration.learned, calibration.rows.gap(*recent)
        calibration.recalibrate(self.standing.calibrated, recent)
        calibration.follow(*recent)
        if not calibration.rows.gap(*recent) < before:
            calibration.return_to(kept, *recent)

    def _change_version(self, first: int | None, **change: Any) -> None:
        """Q1 with an update or a rollback; a gap that rises by a quarter takes an update back."""
        standing, calibration = self.standing, self._calibration
        first = self._under_the_same(change.get("effects", {})) if first is None else first
        recent = (max(first, standing.forgotten, standing.row - MOST_LEARNED), standing.row)
        before, old = calibration.rows.gap(*recent), self._exchange.twin.state.version
        kept = calibration.learned, calibration.sound
        answer = self.ask_twin(**change)
        if not answer.adequate:
            words = f"the update of the model was refused: {'; '.join(answer.missing)}"
            self.event("version", standing.row - 1, words)
            return
        self._design()
        calibration.learn_version(recent)
        calibration.follow(*recent)
        standing.changed = standing.row
        after = calibration.rows.gap(*recent)
        causes = ", ".join(effect_words(one) for one in answer.effects.values())
        words = f"version {answer.version} of the model is in force: {causes or 'as it was given'}"
        self.event("version", standing.row - 1, words, before=before, after=after)
        if "restore" not in change and after > WORSE * before:
            self.ask_twin(restore=old)
            calibration.restore(*kept)
            calibration.follow(*recent)
            words = f"the gap rose: version {old} is in force again"
            self.event("rollback", standing.row - 1, words, before=after, after=before)
        else:
            standing.doubted = standing.doubted and "effects" not in change
            self._keep_state(*recent)
        self._begin_again(recent[0])

    def _under_the_same(self, effects: Effects) -> int:
        """First of the latest rows that stand under the structure that effects say."""
        standing = self.standing
        begun = first_row_under(effects, standing.row, self._label)
        first = standing.changed if begun is None else begun
        if standing.alarm is not None:
            first = max(first, standing.alarm)
        return min(first, max(0, standing.row - LEAST_LEARNED))

    def _design(self) -> None:
        """The design phase of the version in force: simulations over the ranges of the contexts."""
        if self._exchange.twin.state.latent:
            self._calibration.supply(self._calibration.ranges, self._settings.design_rows)

    def ask_twin(self, **change: Any) -> R1:
        """Q1, with a change of the model or without."""
        row = max(0, self.standing.row - 1)
        channels, measured = self._station.channels, self._station.measured
        return self._exchange.ask(Q1(row=row, channels=channels, measured=measured, **change))

    def _begin_again(self, first: int | None) -> None:
        if self._settings.level != "A":
            ledger = self._calibration.ledger
            self.synchrony.begin_again(first, len(ledger), ledger.residuals)
        self.standing.synchronised = self.standing.row

    def _choose_next(self) -> None:
        standing = self.standing
        if self._policy.due(standing) is not None:
            standing.stage = "recalibrate"
        elif standing.doubted and standing.alarm is None and self._may_ask():
            standing.stage = "diagnose"

    def _go_on(self, open_alarm: bool = False) -> None:
        if not open_alarm:
            self.standing.alarm = self.standing.since = None
        self.standing.stage = "close" if self.standing.ended else "watch"

    def _may_ask(self) -> bool:
        """The diagnosis is slow: it is asked of a new alarm, or when the record has grown."""
        standing, asked = self.standing, self.standing.diagnosed
        if asked is None or (standing.alarm is not None and standing.alarm >= asked):
            return True
        return standing.row >= self._settings.growth * asked

    def event(
        self,
        kind: Kind,
        row: int,
        words: str,
        sensors: tuple[str, ...] = (),
        before: float | None = None,
        after: float | None = None,
    ) -> None:
        """Keep that something happened to the twin."""
        self._archive.event(Event(kind, row, self._label(row), words, sensors, before, after))
