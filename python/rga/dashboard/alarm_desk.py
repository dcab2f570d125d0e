"""What pages show of the alarms of a service, and what their forms do about them."""

from collections.abc import Mapping
from datetime import datetime, timedelta

from rga.errors import InputError
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.operator_alarm import OperatorAlarm

#: how long an alarm may be put on the shelf, in words [h]
SHELVES = {"1 h": 1, "8 h": 8, "1 day": 24, "7 days": 168, "30 days": 720}
#: states of open alarms that nobody has acknowledged, or put on a shelf
UNSEEN = ("raised", "cleared")


def alarms_of(book: AlarmBook, twin: str | None, closed: int = 0) -> list[OperatorAlarm]:
    """The open alarms of a twin, or of the service itself (None); with so many closed ones.

    Those that nobody has acknowledged come first, the newest of each.
    """
    found = [one for one in book.open() if one.twin == twin]
    order = (*UNSEEN, "acknowledged", "shelved")
    found.sort(key=lambda one: one.raised_at, reverse=True)
    found.sort(key=lambda one: order.index(one.state))
    known = {one.id for one in found}
    others = [one for one in book.all(10 * closed) if one.twin == twin and one.id not in known]
    return found + others[:closed]


def act(
    book: AlarmBook, twin: str | None, id: int, form: Mapping[str, str], who: str, now: datetime
) -> None:
    """Do what a form asks about an alarm.

    Raises:
        InputError: there is no such alarm of this twin, or it cannot be done.
    """
    if not any(one.id == id and one.twin == twin for one in book.open()):
        raise _missing(id)
    wanted, why = form.get("do", ""), form.get("why", "")
    if wanted == "acknowledge":
        book.acknowledge(id, who, why)
    elif wanted == "unshelve":
        book.unshelve(id, who, why)
    elif wanted == "shelve" and form.get("for") in SHELVES:
        book.shelve(id, now + timedelta(hours=SHELVES[form["for"]]), who, why)
    else:
        raise InputError("this cannot be done about an alarm", f"alarm {id}", "load its page again")


def _missing(id: int) -> InputError:
    return InputError(f"there is no open alarm {id} here", "alarms", "look at the list of alarms")
