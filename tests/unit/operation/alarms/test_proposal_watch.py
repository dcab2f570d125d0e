"""What waits for a decision, and what came of what did: one thing to decide, one condition."""

from datetime import timedelta
from typing import Any

import pytest

from rga.operation.alarms.proposal_watch import proposed
from rga.twin.repository import Proposal, RunView, StoredCommand
from served.service_times import NOON


class Run:
    """A run, as far as its proposals go: a number proposes, other entries decide about the last."""

    def __init__(self, *story: int | str) -> None:
        self._proposals: list[Proposal] = []
        self._commands: list[StoredCommand] = []
        for one in story:
            if isinstance(one, int):
                self._proposals.append(Proposal(one, 10 * one, f"model {one}", {}, None, None))
            else:
                self._decide(*one.split())

    def _decide(self, kind: str, who: str, outcome: str = "done") -> None:
        body: dict[str, Any] = {"proposal": self._proposals[-1].number}
        if outcome == "refused":
            body["refused"] = True
        self._commands.append(StoredCommand(0, kind, body, who, "so it is", "", outcome))

    def proposals(self) -> tuple[Proposal, ...]:
        return tuple(self._proposals)

    def commands(self) -> tuple[StoredCommand, ...]:
        return tuple(self._commands)


def seen(*story: int | str) -> tuple[str | None, dict[str, str]]:
    """Subject and words of what waits, and words of the endings by their subject."""
    view: RunView = Run(*story)  # type: ignore[assignment]
    waiting, endings = proposed("east", view, lambda row: NOON + timedelta(minutes=row))
    told = None if waiting is None else f"{waiting.key.subject}: {waiting.words.split(':')[0]}"
    return told, {key.subject: one.words for key, one in endings.items()}


WITHDRAWN = "reject rga withdrawn"


@pytest.mark.parametrize(
    ("story", "waiting", "ended"),
    [
        ((), None, ()),
        ((1,), "1: proposal 1 waits for a decision", ()),
        ((1, 2, 3), "1: proposal 3 waits for a decision", ()),
        ((1, 2, "accept Ada"), None, ("1",)),
        ((1, 2, "accept Ada", 3, 4), "3: proposal 4 waits for a decision", ("1",)),
        ((1, "accept Ada refused", 2), "1: proposal 2 waits for a decision", ()),
        ((1, WITHDRAWN), None, ("1",)),
        ((1, WITHDRAWN, 2), "1: proposal 2 waits for a decision", ("1",)),
        ((1, "reject Ada", 2, WITHDRAWN), None, ("1", "2")),
    ],
)
def test_a_person_who_decides_ends_it_and_nobody_else(
    story: tuple[int | str, ...], waiting: str | None, ended: tuple[str, ...]
) -> None:
    told, endings = seen(*story)
    assert told == waiting
    assert tuple(endings) == ended


def test_words_say_what_came_of_it() -> None:
    assert seen(1, 2, "accept Ada")[1] == {"1": "proposal 2 was accepted by Ada: model 2"}
    assert seen(1, "reject Bo")[1] == {"1": "proposal 1 was rejected by Bo: model 1"}
    (words,) = seen(1, WITHDRAWN)[1].values()
    assert words.startswith("proposal 1 is withdrawn")
    # A user may have any name.
    assert seen(1, "reject rga")[1] == {"1": "proposal 1 was rejected by rga: model 1"}
