"""What pages and forms need of the alarms of a service: `rga.operation.alarms` has it."""

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from typing import Protocol

from rga.errors import InputError

#: how long an alarm may be put on the shelf, in words [h]
SHELVES = {"1 h": 1, "8 h": 8, "1 day": 24, "7 days": 168, "30 days": 720}


class ShownAlarm(Protocol):
    """An alarm.

    Attributes:
        id: number of it.
        twin: None: it is of the service itself.
        kind: class of it.
        state: "raised", "acknowledged", "shelved", "cleared" (and not acknowledged) or "closed".
        words: what is wrong, in a sentence.
        sensors: that show it.
        since: when it began to be wrong; raised_at: when the alarm was raised last.
        cleared_at: when it was well again; None: it is not.
        acknowledged_at, acknowledged_by: when and by whom; None: it is not.
        shelved_until, shelved_by: until when nothing is told of it, and who wants that.
    """

    @property
    def id(self) -> int: ...
    @property
    def twin(self) -> str | None: ...
    @property
    def kind(self) -> str: ...
    @property
    def state(self) -> str: ...
    @property
    def words(self) -> str: ...
    @property
    def sensors(self) -> Sequence[str]: ...
    @property
    def since(self) -> datetime: ...
    @property
    def raised_at(self) -> datetime: ...
    @property
    def cleared_at(self) -> datetime | None: ...
    @property
    def acknowledged_at(self) -> datetime | None: ...
    @property
    def acknowledged_by(self) -> str | None: ...
    @property
    def shelved_until(self) -> datetime | None: ...
    @property
    def shelved_by(self) -> str | None: ...


class AlarmDesk(Protocol):
    """The alarms of a service, and what people do about them."""

    def open(self) -> Sequence[ShownAlarm]:
        """The alarms that are not closed."""

    def all(self, limit: int) -> Sequence[ShownAlarm]:
        """The last so many alarms, open or closed, the newest first."""

    def acknowledge(self, id: int, who: str, why: str = "") -> object:
        """Somebody has seen an alarm."""

    def shelve(self, id: int, until: datetime, who: str, why: str = "") -> object:
        """Somebody wants to hear nothing of an alarm until some time."""

    def unshelve(self, id: int, who: str, why: str = "") -> object:
        """Somebody wants to hear of an alarm again."""


class NoAlarms:
    """The desk of a service that raises none."""

    def open(self) -> Sequence[ShownAlarm]:
        """None."""
        return ()

    def all(self, limit: int) -> Sequence[ShownAlarm]:
        """None."""
        return ()

    def acknowledge(self, id: int, who: str, why: str = "") -> object:
        """There is nothing to acknowledge."""
        raise _missing(id)

    def shelve(self, id: int, until: datetime, who: str, why: str = "") -> object:
        """There is nothing to shelve."""
        raise _missing(id)

    def unshelve(self, id: int, who: str, why: str = "") -> object:
        """There is nothing on a shelf."""
        raise _missing(id)


def alarms_of(desk: AlarmDesk, twin: str | None, closed: int = 0) -> list[ShownAlarm]:
    """The open alarms of a twin, or of the service itself (None); with so many closed ones.

    Those that nobody has acknowledged come first, the newest of each.
    """
    found = [one for one in desk.open() if one.twin == twin]
    order = ("raised", "cleared", "acknowledged", "shelved")
    found.sort(key=lambda one: one.raised_at, reverse=True)
    found.sort(key=lambda one: order.index(one.state) if one.state in order else len(order))
    known = {one.id for one in found}
    others = [one for one in desk.all(10 * closed) if one.twin == twin and one.id not in known]
    return found + others[:closed]


def act(
    desk: AlarmDesk, twin: str | None, id: int, form: Mapping[str, str], who: str, now: datetime
) -> None:
    """Do what a form asks about an alarm.

    Raises:
        InputError: there is no such alarm of this twin, or it cannot be done.
    """
    if not any(one.id == id and one.twin == twin for one in desk.open()):
        raise _missing(id)
    wanted, why = form.get("do", ""), form.get("why", "")
    if wanted == "acknowledge":
        desk.acknowledge(id, who, why)
    elif wanted == "unshelve":
        desk.unshelve(id, who, why)
    elif wanted == "shelve" and form.get("for") in SHELVES:
        desk.shelve(id, now + timedelta(hours=SHELVES[form["for"]]), who, why)
    else:
        raise InputError("this cannot be done about an alarm", f"alarm {id}", "load its page again")


def _missing(id: int) -> InputError:
    return InputError(f"there is no open alarm {id} here", "alarms", "look at the list of alarms")
