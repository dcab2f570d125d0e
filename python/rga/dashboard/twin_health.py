"""How a twin is, in a word, and how much it needs somebody to look.

Pages, the API, metrics and `rga status` say the same of it, which is what stands here.
"""

from dataclasses import dataclass
from typing import Any

from rga.dashboard.pages.times import span_words
from rga.dashboard.surroundings import Feed, SeenTwin
from rga.findings.phrases import kind_words
from rga.operation.reading.twin_now import LEARNS, TwinNow
from rga.quantities import counted
from rga.report.drawing.places import place_names
from rga.twin.repository import Proposal
from rga.twin.status import NEXT

#: rows that are not played yet, from which on a twin is said to be behind
BEHIND = 50
#: all words for how a twin is, the most urgent first
STATES = (
    "damaged", "alarm", "to decide", "not watched", "silent", "behind", "learning", "no rows yet",
    "in step",
)  # fmt: skip
LEFT = "Readings have left what the model lets expect"
UNWATCHED = (
    "Nothing is compared with the model: no sensor that is in use, and was not left out of the "
    "calibration, has sent readings in the latest rows."
)


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


def health_of(seen: SeenTwin, now: TwinNow | None) -> TwinHealth:
    """How a twin of a service is now."""
    return state_of(now, seen.feed(now), alarmed=seen.is_out_of_sync)


def state_of(now: TwinNow | None, feed: Feed, *, alarmed: bool = False) -> TwinHealth:
    """How a twin is: an alarm that is open is hidden by nothing else.

    Args:
        now: where it stands; None before it has begun.
        feed: how its rows come.
        alarmed: whether the alarm is open that says that it is out of sync.
    """
    if now is None or now.time is None:
        return TwinHealth("no rows yet", "wait", "○", 5, "It waits for its first rows.")
    silence = ""
    if feed.silence is not None:
        silence = f"Its sources are silent: nothing has come for {span_words(feed.silence)}."
    proposed = "" if now.undecided is None else _decision_words(now.undecided)
    is_open = now.out_of_sync or alarmed
    if is_open and (now.is_sought or not proposed):
        what = "the reason is being looked for" if now.is_sought else "nothing in force explains it"
        words = _said(f"{LEFT}; {what}.", proposed, silence)
        return TwinHealth("alarm", "bad", "▲", 1, words)
    if proposed:
        words = _said(f"{LEFT}." if is_open else "", proposed, silence)
        return TwinHealth("to decide", "warn", "◆", 2, words)
    if not now.learns and now.recent is None:
        return TwinHealth("not watched", "warn", "□", 2, _said(UNWATCHED, silence))
    if silence:
        return TwinHealth("silent", "warn", "◇", 3, silence)
    if now.learns:
        return TwinHealth("learning", "wait", "◌", 5, _learning_words(now))
    if behind := _behind_words(feed):
        return TwinHealth("behind", "warn", "◁", 4, behind)
    extra = f" Version {now.version} of the model is in force." if now.causes else ""
    return TwinHealth("in step", "good", "●", 6, f"Readings are as the model lets expect.{extra}")


def _learning_words(now: TwinNow) -> str:
    if now.stage not in LEARNS:
        return f"Version {now.version} of the model is in force, and is being learned about."
    come = f"{counted(now.rows, 'row')} {'has' if now.rows == 1 else 'have'} come"
    return f"{come}; {NEXT[now.stage]}."


def _behind_words(feed: Feed) -> str:
    """In words, that a twin sees its bridge as it was some time ago; nothing where it does not."""
    age, waits = span_words(feed.backlog), f"{feed.lag} rows wait to be played."
    late = f"It is catching up: what its sources send is {age} old."
    return _said(late if feed.backlog else "", waits if feed.lag > BEHIND else "")


def _said(*sentences: str) -> str:
    return " ".join(filter(None, sentences))


def _decision_words(proposal: Proposal) -> str:
    causes = ", ".join(map(cause_words, proposal.effects.values()))
    return f"A cause was found and waits for a decision: {causes or proposal.words}."
