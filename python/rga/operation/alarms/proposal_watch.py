"""What a twin proposes: what waits for a decision, and what came of what did."""

from collections.abc import Callable
from datetime import datetime

from rga.operation.alarms.condition import Condition, ConditionKey, Ending
from rga.twin.commands.proposals import WITHDRAWN, decisions
from rga.twin.repository import Proposal, RunView, StoredCommand

#: what somebody did who decided
DID = {"accept": "accepted", "reject": "rejected"}


def proposed(
    twin: str, view: RunView, at: Callable[[int], datetime]
) -> tuple[Condition | None, dict[ConditionKey, Ending]]:
    """The proposal that waits for a decision, and how it ended with those before it.

    A proposal that takes the place of another, or comes after one that was withdrawn, goes on with
    the same condition: nobody has decided yet, and there is one thing to decide.

    Args:
        twin: name of it.
        view: its run.
        at: gives the time of a row.
    """
    decided = decisions(view)
    endings: dict[ConditionKey, Ending] = {}
    last: tuple[ConditionKey, Proposal] | None = None
    for one in view.proposals():
        if last is None or _by_a_person(decided.get(last[1].number)):
            last = ConditionKey(twin, "proposal", "proposal", str(one.number)), one
        else:
            last = last[0], one
        if one.number in decided:
            endings[last[0]] = _ending(one, decided[one.number])
    if last is None or last[1].number in decided:
        return None, endings
    return _waiting(*last, at), endings


def _waiting(key: ConditionKey, proposal: Proposal, at: Callable[[int], datetime]) -> Condition:
    words = f"proposal {proposal.number} waits for a decision: {proposal.words}"
    if proposal.gain is not None:
        words += f" (gain {proposal.gain:.2g} on rows held out)"
    return Condition(key, words, at(proposal.row), is_renewed=True)


def _by_a_person(decision: StoredCommand | None) -> bool:
    return decision is not None and decision.outcome != WITHDRAWN


def _ending(proposal: Proposal, decision: StoredCommand) -> Ending:
    name = f"proposal {proposal.number}"
    if not _by_a_person(decision):
        return Ending(f"{name} is withdrawn, for {decision.why}: {proposal.words}")
    words = f"{name} was {DID[decision.kind]} by {decision.who}: {proposal.words}"
    return Ending(words, decision.who, decision.why)
