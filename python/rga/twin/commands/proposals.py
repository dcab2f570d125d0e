"""What diagnoses propose, and what was decided about it."""

from typing import TYPE_CHECKING

from rga.errors import InputError
from rga.findings.phrases import effect_words
from rga.twin.commands.command import PLACE, Reject
from rga.twin.repository import Proposal, RunView, StoredCommand
from rga.twin.versions import Effects

if TYPE_CHECKING:
    from rga.twin.archive import Archive

DECISIONS = ("accept", "reject")
#: in whose name a proposal is withdrawn that a later diagnosis does not make again
WITHDRAWS = "rga"
#: what comes of one that is withdrawn
WITHDRAWN = "withdrawn"


class Proposals:
    """The proposals of a run.

    Args:
        archive: keeps them.
    """

    def __init__(self, archive: "Archive") -> None:
        self._archive = archive

    def add(
        self, row: int, effects: Effects, gain: float | None, gain_ci90: tuple[float, float] | None
    ) -> str:
        """Propose effects beyond the model as it was given, and say so in words.

        The very same ones are not proposed twice while nobody has decided.
        """
        last = self._last
        if last is not None and last.effects == effects and self._decided(last) is None:
            return f"proposal {last.number} stands: {last.words}"
        causes = [effect_words(one) for one in effects.values()]
        words = f"a model with {', '.join(causes)}" if causes else "the model as it was given"
        number = self._archive.propose(row, words, effects, gain, gain_ci90)
        return f"proposal {number}: {words}"

    def withdraw(self, row: int) -> str | None:
        """Withdraw the one that is open, and say so in words; None: none is."""
        last = self._last
        if last is None or self._decided(last) is not None:
            return None
        why = "a later diagnosis does not propose it again"
        command = Reject(who=WITHDRAWS, why=why, proposal=last.number)
        self._archive.keep_command(command, {"proposal": last.number}, row, WITHDRAWN)
        return f"proposal {last.number} is withdrawn: {why}"

    def open(self, number: int | None) -> Proposal:
        """The last one, if nobody has decided about it.

        Args:
            number: that it must have; None: any.

        Raises:
            InputError: there is none, another is asked for, or it was decided.
        """
        last = self._last
        if last is None:
            raise InputError("nothing is proposed", PLACE, "wait for a diagnosis")
        if number is not None and number != last.number:
            words = f"proposal {number} is not the last, which is {last.number}"
            raise InputError(words, PLACE, "decide about the last")
        if (decided := self._decided(last)) is not None:
            raise InputError(f"proposal {last.number} was {decided}", PLACE, "wait for another")
        return last

    @property
    def _last(self) -> Proposal | None:
        proposals = self._archive.run.proposals()
        return proposals[-1] if proposals else None

    def _decided(self, proposal: Proposal) -> str | None:
        return decision(self._archive.run, proposal)


def decision(run: RunView, proposal: Proposal) -> str | None:
    """What was decided about a proposal of a run, in words; None: nothing was."""
    found = decisions(run).get(proposal.number)
    return None if found is None else f"decided by {found.who}: {found.kind}"


def decisions(run: RunView) -> dict[int, StoredCommand]:
    """What decided about each proposal of a run, by its number; of those that are open nothing."""
    return {
        one.body["proposal"]: one
        for one in run.commands()
        if one.kind in DECISIONS and list(one.body) == ["proposal"]
    }
