"""What a process does that raises alarms and tells of them until it is killed."""

from itertools import count
from pathlib import Path

from rga.operation.alarms import tables
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.alarm_settings import AlarmSettings
from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.notices.delivery import Delivery
from rga.operation.notices.notify_settings import NotifySettings
from rga.operation.notices.outbox import Outbox
from rga.operation.service_file import service_file
from served.service_times import SetClock


def main(folder: Path, rounds: int) -> None:
    """Let a condition come and go, and time pass.

    Args:
        folder: of the service.
        rounds: -1: until it is killed.
    """
    clock, file = SetClock(), service_file(folder, tables.metadata)
    recipient = NotifySettings.model_validate(
        {"url_file": folder / "mail.secret", "at_most": "9999 an hour"}
    )
    outbox = Outbox(file, [recipient], "http://bridge", clock)
    book = AlarmBook(file, AlarmSettings().delays, clock, outbox.add)
    delivery = Delivery(recipient, outbox, str, clock)
    # The time goes on where it was.
    known = book.transitions(0, 10**6)
    clock.at = max([clock.at, *(one.at for one in known)])
    for k in count() if rounds < 0 else range(rounds):
        key = ConditionKey("east", "gap", "alarm", "twin")
        there = Condition(key, f"{clock.now()}", clock.now())
        judged = frozenset({key.kind})
        book.observe("east", Observation((there,) if k % 2 else (), judged))
        clock.pass_by(61)
        delivery.round()
