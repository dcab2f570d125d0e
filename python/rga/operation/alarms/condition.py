"""What is wrong, as it is observed."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Literal, NamedTuple

from sqlalchemy import Connection

#: classes of alarms: the twin's monitor, its sensors, its sources, the service, and what it asks
AlarmKind = Literal["gap", "quality", "source", "service", "proposal"]


class ConditionKey(NamedTuple):
    """By which a condition is known from all others.

    Attributes:
        twin: None: the service itself.
        kind: class of the alarm that it raises.
        cause: what is wrong, in a word, such as "silent".
        subject: what it is wrong with, such as a sensor.
    """

    twin: str | None
    kind: AlarmKind
    cause: str
    subject: str


@dataclass(frozen=True)
class Condition:
    """Something that is wrong.

    Attributes:
        key: by which it is known.
        words: what is wrong, in a sentence that stays the same while it is.
        since: when it began (UTC).
        sensors: that show it.
        size: that raises the alarm anew where it has doubled, as more packets are missing; 0: it
            has none.
        is_renewed: its words change while it is there: its alarm says the newest of them.
        is_again: when it occurred it was there already: it is found again, not anew.
    """

    key: ConditionKey
    words: str
    since: datetime
    sensors: tuple[str, ...] = ()
    size: int = 0
    is_renewed: bool = False
    is_again: bool = False


@dataclass(frozen=True)
class Ending:
    """How a condition came to its end.

    Attributes:
        words: what came of it, in a sentence.
        who: has ended it, and knows of its alarm by that; None: nobody did.
        why: as they gave it.
    """

    words: str
    who: str | None = None
    why: str = ""


@dataclass(frozen=True)
class Observation:
    """What was seen of a twin, or of the service, at one time.

    Attributes:
        conditions: that are there now.
        judged: classes of which all is known: what is not among the conditions is well.
        occurred: what began since the last observation, of which each raises an alarm, whether or
            not it is still there; what is found again raises one only where it shows at more
            sensors.
        endings: of conditions that are not there any more, where more is known of them than that.
        keep: writes up to where it was looked, with the alarms or not at all; None: nothing is to
            be written.
    """

    conditions: tuple[Condition, ...]
    judged: frozenset[AlarmKind]
    occurred: tuple[Condition, ...] = ()
    endings: Mapping[ConditionKey, Ending] = field(default_factory=dict)
    keep: Callable[[Connection], None] | None = None
