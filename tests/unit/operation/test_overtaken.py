"""Packets that others of their stream overtake are waited for, and those that are lost are not."""

from pathlib import Path

import pytest

from rga.operation.inbox.arrival import Arrival
from rga.operation.inbox.packets import Packets
from rga.operation.packets.packet import MICROSECONDS, Number
from rga.operation.rows.grid import Grid
from rga.operation.rows.overtaken import LONGEST, Overtaken
from rga.twin.hardware.inbox import Inbox
from served.service_times import SetClock


class Sender:
    """Numbers of a stream, a second of time each, and how far rows may go by them."""

    def __init__(self, folder: Path) -> None:
        self.clock = SetClock()
        grid = Grid(every=MICROSECONDS, lateness=0)
        self.packets = Packets(Inbox(folder), grid, ["logger"])
        self.start()

    def start(self) -> None:
        """As a service that is started again."""
        self.overtaken = Overtaken(self.packets, ["logger"], self.clock)

    def send(self, *numbers: int) -> None:
        for number in numbers:
            at = number * MICROSECONDS
            payload = str(number).encode()
            arrival = Arrival(payload, "packet", at, at, at, Number("s", number))
            self.packets.receive("logger", [arrival])

    @property
    def known(self) -> tuple[int | None, bool]:
        """The number up to which rows may go, and whether one before it is waited for."""
        latest, waits = self.overtaken.latest()
        moment = latest["logger"]
        return None if moment is None else moment // MICROSECONDS, waits


@pytest.fixture
def sender(tmp_path: Path) -> Sender:
    return Sender(tmp_path)


def test_what_was_overtaken_is_waited_for(sender: Sender) -> None:
    assert sender.known == (None, False)
    sender.send(0, 1)
    assert sender.known == (1, False)
    sender.send(5)
    assert sender.known == (1, True)
    sender.send(2, 3)
    assert sender.known == (1, True)
    sender.send(4)
    assert sender.known == (5, False)


def test_what_is_lost_is_not_waited_for_long(sender: Sender) -> None:
    sender.send(0, 1)
    assert sender.known == (1, False)
    sender.send(3)
    assert sender.known == (1, True)
    sender.clock.pass_by(LONGEST + 0.1)
    assert sender.known == (3, False)


def test_losses_one_after_the_other_hold_rows_up_by_no_more(sender: Sender) -> None:
    sender.send(0)
    held = []
    for number in range(2, 40, 2):
        assert sender.known[0] is not None
        sender.send(number)
        sender.clock.pass_by(1.0)
        held.append(number - (sender.known[0] or 0))
    assert max(held) <= 2 * (LONGEST + 2)


def test_losses_of_former_days_hold_nothing_up(sender: Sender) -> None:
    sender.send(0, 1, 7)
    sender.start()
    assert sender.known == (7, False)
    sender.send(8)
    assert sender.known == (8, False)


def test_what_came_before_a_stream_was_first_heard_is_not_waited_for(sender: Sender) -> None:
    sender.send(40, 41)
    assert sender.known == (41, False)
