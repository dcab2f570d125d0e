"""How a twin is, in a word, and how much it needs somebody to look."""

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from rga.dashboard.pages.times import span_words
from rga.findings.phrases import kind_words
from rga.operation.reading.twin_now import TwinNow
from rga.quantities import counted
from rga.report.drawing.places import place_names
from rga.twin.repository import Proposal
from rga.twin.status import NEXT

#: rows that are not played yet, from which on a twin is said to be behind
BEHIND = 50
LEARNS = ("initialise", "gather", "calibrate")


@dataclass(frozen=True)
class TwinHealth:
    """How a twin is.

    Attributes:
        word: that says it.
        style: by which the style sheet gives it a colour.
        sign: a shape beside the word.
        need: of attention; the least comes first.
        words: the same in a sentence.
    """

    word: str
    style: str
    sign: str
    need: int
    words: str


def cause_words(effect: dict[str, Any]) -> str:
    """An effect in words, without its size.

    >>> cause_words({"kind": "support_settlement", "support": "east", "displacement": -0.002})
    'support settlement of east'
    """
    names = [name for _, name in place_names(effect)]
    return f"{kind_words(str(effect['kind']))} of {', '.join(names)}".removesuffix(" of ")


def damaged(words: str) -> TwinHealth:
    """Of a twin whose repository cannot be read."""
    return TwinHealth("damaged", "bad", "✕", 0, f"Its repository cannot be read: {words}")


def state_of(now: TwinNow | None, at: datetime, patience: float, lag: int) -> TwinHealth:
    """How a twin is.

    Args:
        now: where it stands; None before it has begun.
        at: when this is asked.
        patience: after which it counts as silent [s].
        lag: rows that it has not played yet.
    """
    if now is None or now.time is None:
        return TwinHealth("no rows yet", "wait", "○", 5, "It waits for its first rows.")
    proposed = "" if now.undecided is None else _decision_words(now.undecided)
    if now.out_of_sync:
        words = "Readings have left what the model lets expect; the reason is being looked for."
        return TwinHealth("alarm", "bad", "▲", 1, f"{words} {proposed}".strip())
    if proposed:
        return TwinHealth("to decide", "warn", "◆", 2, proposed)
    silence = (at - now.time).total_seconds()
    if silence > 2 * patience and lag == 0:
        words = f"The newest row is {span_words(silence)} old: its sources are silent."
        return TwinHealth("silent", "warn", "◇", 3, words)
    if now.stage in LEARNS:
        come = f"{counted(now.rows, 'row')} {'has' if now.rows == 1 else 'have'} come"
        words = f"{come}; {NEXT[now.stage]}."
        return TwinHealth("learning", "wait", "◌", 5, words)
    if lag > BEHIND:
        return TwinHealth("behind", "warn", "◁", 4, f"{lag} rows wait to be played.")
    extra = f" Version {now.version} of the model is in force." if now.causes else ""
    return TwinHealth("in step", "good", "●", 6, f"Readings are as the model lets expect.{extra}")


def _decision_words(proposal: Proposal) -> str:
    causes = ", ".join(map(cause_words, proposal.effects.values()))
    return f"A cause was found and waits for a decision: {causes or proposal.words}."
