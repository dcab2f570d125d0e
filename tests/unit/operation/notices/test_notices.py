"""Notices: each arrives, none is told twice without its id, and not more than anybody wants."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.operation.alarms import tables
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.alarm_settings import AlarmSettings
from rga.operation.alarms.condition import AlarmKind, Condition, ConditionKey, Observation
from rga.operation.notices.delivery import Delivery
from rga.operation.notices.notify_settings import NotifySettings
from rga.operation.notices.outbox import Outbox
from rga.operation.service_file import service_file
from served.notice_server import NoticeServer, notice_server
from served.service_times import NOON, SetClock

KINDS: frozenset[AlarmKind] = frozenset({"gap", "quality", "source", "service", "proposal"})
HOUR, DAY = 3600.0, 86_400.0


class Office:
    """A book of alarms with its outbox, and one recipient."""

    def __init__(self, folder: Path, url: str, **settings: Any) -> None:
        self.clock = SetClock()
        self.address = folder / "mail.secret"
        self.address.write_text(f"{url}\n", "utf-8")
        self.recipient = NotifySettings.model_validate({"url_file": self.address} | settings)
        self._folder = folder
        self.start()

    def start(self, *recipients: NotifySettings) -> None:
        """Begin, or begin again as after a kill."""
        self.file = service_file(self._folder, tables.metadata)
        whom = recipients or (self.recipient,)
        self.outbox = Outbox(self.file, whom, "http://bridge", self.clock)
        delays = AlarmSettings().delays | {"quality": (0.0, 0.0), "service": (0.0, 0.0)}
        self.book = AlarmBook(self.file, delays, self.clock, self.outbox.add)
        self.delivery = Delivery(self.recipient, self.outbox, lambda: "All is well", self.clock)

    def see(self, *wrong: tuple[str, str], twin: str | None = "east") -> None:
        """Causes and subjects of sensors, or of the service, that are wrong now."""
        kind: AlarmKind = "service" if twin is None else "quality"
        conditions = tuple(
            Condition(
                ConditionKey(twin, kind, cause, subject), f"{subject} is {cause}", NOON, (subject,)
            )
            for cause, subject in wrong
        )
        self.book.observe(twin, Observation(conditions, KINDS))

    def wait(self, seconds: float) -> None:
        self.clock.pass_by(seconds)
        self.delivery.round()


@pytest.fixture
def server() -> Iterator[NoticeServer]:
    with notice_server() as found:
        yield found


@pytest.fixture
def office(tmp_path: Path, server: NoticeServer) -> Office:
    return Office(tmp_path, server.url)


def test_transitions_of_a_twin_are_told_together_in_words(
    office: Office, server: NoticeServer
) -> None:
    office.see(("silent", "D1"), ("stuck", "D2"))
    office.clock.pass_by(30)
    office.book.acknowledge(1, "Ada", "cut")
    office.wait(29)
    assert server.bodies == []
    office.wait(1)
    assert len(server.taken) == 1
    ((title, body),) = server.taken.values()
    assert title == "east: 3 notices of alarms"
    assert body.splitlines()[:-1] == [
        "alarm 1 (quality) raised: D1 is silent; since 2026-11-27 12:00 UTC",
        "alarm 2 (quality) raised: D2 is stuck; since 2026-11-27 12:00 UTC",
        "alarm 1 (quality) acknowledged by Ada (cut): D1 is silent; since 2026-11-27 12:00 UTC",
        "http://bridge/alarms",
    ]
    office.wait(HOUR)
    assert sum(server.sent.values()) == 1


def test_a_single_one_names_its_alarm(office: Office, server: NoticeServer) -> None:
    office.see(("disk", "data"), twin=None)
    office.wait(60)
    ((title, body),) = server.taken.values()
    assert title == "service: alarm 1 (service) raised"
    assert "http://bridge/alarms#alarm-1" in body


def test_where_nothing_is_wrong_nothing_is_told(office: Office, server: NoticeServer) -> None:
    for _ in range(100):
        office.see()
        office.wait(60)
    assert server.sent == {}


@pytest.mark.parametrize(
    ("on", "told"), [(["quality"], 2), (["silent"], 1), (["alarm", "source"], 0), (["disk"], 1)]
)
def test_only_what_is_asked_for_is_told(
    on: list[str], told: int, tmp_path: Path, server: NoticeServer
) -> None:
    office = Office(tmp_path, server.url, on=on)
    office.see(("silent", "D1"), ("stuck", "D2"))
    office.see(("disk", "data"), twin=None)
    office.wait(60)
    lines = [line for body in server.bodies for line in body.splitlines()]
    assert sum(line.startswith("alarm") for line in lines) == told


def test_no_more_is_sent_than_anybody_wants(tmp_path: Path, server: NoticeServer) -> None:
    office = Office(tmp_path, server.url, at_most="2 an hour")
    for k in range(30):
        office.see(("silent", f"D{k}"))
        office.wait(61)
    assert len(server.taken) == 2
    office.wait(HOUR)
    assert len(server.taken) == 3
    lines = server.bodies[-1].splitlines()
    told = sum(body.count("raised") + body.count("cleared") for body in server.bodies[:-1])
    # Of one alarm after the other each is raised, and all but the last are cleared.
    assert lines[-4:-2] == [
        f"... and {59 - told - 20} more",
        f"{59 - told} of these had been held back, as there were too many messages",
    ]


def test_a_message_is_sent_until_it_arrives(office: Office, server: NoticeServer) -> None:
    server.mood = "fails"
    office.see(("silent", "D1"))
    office.wait(60)
    office.wait(9)
    assert sum(server.sent.values()) == 1
    office.wait(1)
    office.wait(19)
    assert sum(server.sent.values()) == 2
    assert office.outbox.failing() == {}
    office.wait(1)
    (known,) = office.outbox.undelivered()
    assert (known.tries, known.fate) == (3, "waiting")
    assert office.outbox.failing() == {"mail.secret": known.fault}
    assert "500" in known.fault
    server.mood = "takes"
    office.wait(40)
    assert list(server.taken) == [known.id]
    assert server.sent == {known.id: 4}
    assert office.outbox.failing() == {}
    assert office.outbox.undelivered() == []


def test_after_a_day_it_is_given_up_and_stays_on_the_list(
    office: Office, server: NoticeServer
) -> None:
    server.mood = "fails"
    office.see(("silent", "D1"))
    for _ in range(200):
        office.wait(600)
    tries = sum(server.sent.values())
    assert 24 <= tries <= 40
    (known,) = office.outbox.undelivered()
    assert known.fate == "undelivered"
    assert list(office.outbox.failing()) == ["mail.secret"]
    server.mood = "takes"
    office.see(("silent", "D1"), ("silent", "D2"))
    office.wait(60)
    assert len(server.taken) == 1
    assert office.outbox.failing() == {}
    assert office.outbox.undelivered() == [known]


def test_a_server_that_hangs_is_one_that_fails(office: Office, server: NoticeServer) -> None:
    server.mood = "hangs"
    office.see(("silent", "D1"))
    office.wait(60)
    assert office.outbox.undelivered()[0].tries == 1
    server.mood = "takes"
    office.wait(10)
    assert len(server.taken) == 1


def test_what_arrives_twice_has_one_id(office: Office, server: NoticeServer) -> None:
    server.mood = "takes and fails"
    office.see(("silent", "D1"))
    office.wait(60)
    server.mood = "takes"
    office.wait(10)
    assert list(server.sent.values()) == [2]
    assert len(server.taken) == 1


def test_a_kill_at_any_time_loses_nothing(office: Office, server: NoticeServer) -> None:
    office.see(("silent", "D1"))
    office.start()
    office.clock.pass_by(60)
    office.outbox.gather("mail.secret")
    office.start()
    # It was sent, and nobody could write that down.
    (message,) = office.outbox.due("mail.secret")
    assert office.delivery._send(message.title, message.body) is None
    office.start()
    office.delivery.round()
    assert server.sent == {message.id: 2}
    office.start()
    office.wait(HOUR)
    assert server.sent == {message.id: 2}


def test_a_clock_that_is_set_back_holds_no_message(office: Office, server: NoticeServer) -> None:
    server.mood = "fails"
    office.see(("silent", "D1"))
    office.wait(60)
    office.clock.pass_by(-30 * DAY)
    server.mood = "takes"
    office.delivery.round()
    office.see(("silent", "D1"), ("silent", "D2"))
    office.wait(61)
    assert len(server.taken) == 2


def test_every_day_there_is_a_line_once(tmp_path: Path, server: NoticeServer) -> None:
    office = Office(tmp_path, server.url, all_is_well="13:00")
    for _ in range(3 * 24):
        office.start()
        office.wait(HOUR / 2)
        office.wait(HOUR / 2)
    assert [title for title, _ in server.taken.values()] == [
        f"rga, 2026-11-{day}" for day in (27, 28, 29)
    ]
    assert server.bodies[0].startswith("All is well")
    assert set(server.sent.values()) == {1}


def test_what_is_for_somebody_who_is_gone_is_given_up(office: Office, server: NoticeServer) -> None:
    server.mood = "fails"
    office.see(("silent", "D1"))
    office.wait(60)
    other = office.recipient.model_copy(update={"url_file": office.address.with_name("b.secret")})
    office.start(other)
    (known,) = office.outbox.undelivered()
    assert (known.fate, known.fault) == ("undelivered", "it is no longer configured")
    assert office.outbox.failing() == {}


@pytest.mark.parametrize("content", ["", "nothing", "json://127.0.0.1:9\nnothing", None])
def test_what_is_no_address_is_refused(office: Office, content: str | None) -> None:
    if content is None:
        office.address.unlink()
    else:
        office.address.write_text(content, "utf-8")
    with pytest.raises(InputError, match=r"mail\.secret"):
        office.start()


def test_an_address_that_is_lost_later_is_a_fault(office: Office, server: NoticeServer) -> None:
    office.see(("silent", "D1"))
    office.address.unlink()
    office.wait(60)
    assert "cannot be read" in office.outbox.undelivered()[0].fault
    office.address.write_text(server.url, "utf-8")
    office.wait(10)
    assert len(server.taken) == 1
