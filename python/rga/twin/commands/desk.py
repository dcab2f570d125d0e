"""Carries out what people ask a twin for, and writes it down."""

from datetime import datetime
from typing import Any

from rga.errors import InputError
from rga.model.effect import seconds
from rga.quantities import counted
from rga.twin.analysis import RealityGapAnalysis
from rga.twin.archive import Archive
from rga.twin.calibration.capture import ContextCapture
from rga.twin.commands.command import (
    PLACE,
    Accept,
    AnyCommand,
    Command,
    Exclude,
    Forget,
    Note,
    Reject,
    Rollback,
)
from rga.twin.commands.exclusion import leaves_none
from rga.twin.commands.proposals import Proposals
from rga.twin.hardware.interface import Station
from rga.twin.repository import Proposal
from rga.twin.settings import Pace, Settings


class CommandDesk:
    """Carries out commands, each within the step that is open.

    Args:
        analysis: changes the twin.
        archive: keeps proposals and commands.
        calibration: reads the rows.
        station: what is mounted on the structure.
        settings: of the run.
        pace: how many rows a recalibration learns from.
    """

    def __init__(
        self,
        analysis: RealityGapAnalysis,
        archive: Archive,
        calibration: ContextCapture,
        station: Station,
        settings: Settings,
        pace: Pace,
    ) -> None:
        self._analysis, self._archive = analysis, archive
        self._proposals = Proposals(archive)
        self._calibration, self._station, self._pace = calibration, station, pace
        # A diagnosis analyses so many, and a recalibration learns from them.
        learned = pace.calibration_rows + pace.settle + pace.packet
        self._least_kept = max(settings.criteria.record.most_rows, learned)

    def carry_out(self, command: AnyCommand) -> str:
        """Do what is asked, and keep it with what came of it.

        Returns:
            What came of it, in words.

        Raises:
            InputError: it cannot be done.
        """
        self._check_seen(command.version_seen)
        body = _body(command)
        if isinstance(command, Accept | Reject):
            body["proposal"] = self._proposals.open(command.proposal).number
        outcome = self._done(command)
        self._keep(command, body, outcome)
        return outcome

    def refuse(self, command: AnyCommand, why: str) -> None:
        """Keep that a command could not be carried out."""
        self._keep(command, _body(command) | {"refused": True}, f"refused: {why}")

    def _done(self, command: AnyCommand) -> str:
        if isinstance(command, Accept):
            return self._accept(self._proposals.open(command.proposal))
        if isinstance(command, Reject):
            return f"proposal {self._proposals.open(command.proposal).number} is rejected"
        if isinstance(command, Rollback):
            return self._roll_back(command.version)
        if isinstance(command, Exclude):
            return self._exclude(command)
        if isinstance(command, Forget):
            return self._forget(command.keep)
        if isinstance(command, Note):
            return "noted"
        return self._recalibrate()

    def _accept(self, proposal: Proposal) -> str:
        self._check_calibrated()
        first, before = self._analysis.standing.proposed, self._archive.run.version_in_force()
        self._analysis.adopt(proposal.effects, proposal.gain, proposal.gain_ci90, first)
        outcome = f"proposal {proposal.number} is accepted: {proposal.words}"
        if self._archive.run.version_in_force() == before:
            outcome += ", but did not come into force"
        return outcome

    def _roll_back(self, version: int) -> str:
        """Put an earlier version in force again; what it needs is learned in a step of its own."""
        before = self._archive.run.version_in_force()
        answer = self._analysis.ask_twin(restore=version)
        if not answer.adequate:
            raise InputError("; ".join(answer.missing), PLACE, "rga replay lists the versions")
        stays = before is not None and before.number == version
        words = f"version {version} {'stays in force' if stays else 'is in force again'}, as asked"
        self._analysis.event("rollback", self._row, words)
        return words

    def _recalibrate(self) -> str:
        standing = self._analysis.standing
        self._check_calibrated()
        if standing.stage != "watch":
            raise InputError("no rows are watched now", PLACE, "ask again later")
        self._analysis.recalibrate(max(0, standing.row - self._pace.settle))
        return "recalibrated"

    def _exclude(self, command: Exclude) -> str:
        standing, clock = self._analysis.standing, self._calibration.rows.last_clock
        if command.sensor not in self._station.channels:
            known = ", ".join(self._station.channels)
            raise InputError(
                f"there is no sensor {command.sensor!r}", PLACE, f"name one of {known}"
            )
        self._check_moments(command.since, command.until)
        since = clock if command.since is None else seconds(command.since)
        until = None if command.until is None else seconds(command.until)
        if until is not None and not until > since:
            raise InputError("it ends before it begins", PLACE, "give a later time to end it")
        excluded = (*standing.excluded, (command.sensor, since, until))
        if leaves_none(self._station.channels, excluded):
            raise InputError("no sensor would be left", PLACE, "leave one of them in use")
        standing.excluded = self._archive.excluded = excluded
        self._calibration.read_again(standing)
        begin = "now" if command.since is None else str(command.since)
        end = "on" if command.until is None else f"to {command.until}"
        words = f"{command.sensor} is not used from {begin} {end}"
        return f"{words}; rows that were followed stay as they are" if since < clock else words

    def _forget(self, keep: int | None) -> str:
        if keep is not None and keep < self._least_kept:
            raise InputError(
                f"{keep} rows are fewer than the {self._least_kept} that the twin learns from "
                "and a diagnosis analyses",
                PLACE,
                "keep more",
            )
        learned = self._calibration.learned
        if keep is not None and learned is not None and learned.remembers:
            raise InputError("what infers contexts looks at all rows", PLACE, "keep all of them")
        self._analysis.standing.keep = keep
        return (
            "all readings are kept from now on"
            if keep is None
            else f"readings are kept of the latest {counted(keep, 'row')} and of the calibration"
        )

    def _check_moments(self, *moments: float | str | None) -> None:
        """Whether times are written as the rows write theirs.

        Raises:
            InputError: one is not.
        """
        dated = self._station.time_format == "iso"
        if wrong := [one for one in moments if one is not None and isinstance(one, str) != dated]:
            written = "dates" if dated else "seconds"
            raise InputError(
                f"the rows are written in {written}, and {wrong[0]!r} is none",
                PLACE,
                f"give {written} as in the rows",
            )
        zoned = dated and datetime.fromisoformat(str(self._station.start)).tzinfo is not None
        for one in moments:
            if isinstance(one, str) and (datetime.fromisoformat(one).tzinfo is not None) != zoned:
                has = "have a time zone" if zoned else "have no time zone"
                raise InputError(f"the rows {has}, unlike {one!r}", PLACE, "write it as they do")

    @property
    def _row(self) -> int:
        return max(0, self._analysis.standing.row - 1)

    def _keep(self, command: AnyCommand, body: dict[str, Any], outcome: str) -> None:
        self._archive.keep_command(command, body, self._row, outcome)
        why = f" ({command.why})" if command.why else ""
        words = f"{command.who} asked to {command.kind}{why}: {outcome}"
        self._analysis.event("command", self._row, words)

    def _check_seen(self, version: int | None) -> None:
        """Whether the version that somebody has seen is still in force.

        Raises:
            InputError: another has come into force meanwhile.
        """
        now = self._archive.run.version_in_force()
        if version is not None and now is not None and now.number != version:
            what = f"version {now.number} has come into force meanwhile in place of {version}"
            raise InputError(what, PLACE, "look at it, and ask again")

    def _check_calibrated(self) -> None:
        if not self._analysis.standing.calibrated:
            raise InputError("the twin is not calibrated yet", PLACE, "wait for its calibration")


def _body(command: AnyCommand) -> dict[str, Any]:
    """What a command is about, without who gave it, and why and when."""
    return command.model_dump(mode="json", exclude=set(Command.model_fields) | {"kind"})
