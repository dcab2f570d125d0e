"""Packets in the inbox: each is kept once, and the account of them balances."""

import random
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rga.operation.inbox.account import Account
from rga.operation.inbox.archive import PacketArchive
from rga.operation.inbox.arrival import Arrival
from rga.operation.inbox.known_packets import IN_INBOX, REMEMBERED
from rga.operation.inbox.packets import HOUR, NEVER, Packets
from rga.operation.packets.packet import Number
from rga.operation.rows.grid import Grid
from rga.twin.hardware.inbox import Inbox

NOON = 1_795_392_000_000_000 + 12 * HOUR
#: rows that wait for ever
PATIENT = Grid(every=HOUR, lateness=10**6 * HOUR)
SOURCES = ("east", "west", "folder")


@pytest.fixture
def packets(tmp_path: Path) -> Packets:
    return Packets(Inbox(tmp_path), PATIENT, SOURCES)


def numbered(sequence: int, moment: int = NOON, **more: object) -> Arrival:
    number = Number("a", sequence)
    known = {"arrived": NOON, "first": moment, "last": moment, "number": number} | more
    return Arrival(b"packet %d" % sequence, "packet", **known)  # type: ignore[arg-type]


def plain(content: str, arrived: int = NOON) -> Arrival:
    return Arrival(content.encode(), "file", arrived, NOON, NOON, sha256=content)


def fates(packets: Packets, source: str, arrivals: list[Arrival]) -> list[str]:
    return [fate for fate, _ in packets.receive(source, arrivals)]


def total(packets: Packets) -> Account:
    return sum(packets.account().values(), Account())


def test_a_packet_is_kept_once(packets: Packets) -> None:
    assert fates(packets, "east", [numbered(0), numbered(2), numbered(0)]) == [
        "waiting", "waiting", "duplicate",
    ]  # fmt: skip
    assert fates(packets, "east", [numbered(2), numbered(1)]) == ["duplicate", "waiting"]
    assert fates(packets, "west", [numbered(2)]) == ["waiting"]
    assert packets.numbers("east")["a"].gaps == []
    assert packets.numbers("west")["a"].gaps == [(0, 1)]
    assert total(packets) == Account(received=6, duplicate=2, waiting=4)
    kept, end = packets.between(NOON, NOON + 1, 2**30)
    assert [one.payload for one in kept] == [b"packet 0", b"packet 2", b"packet 1", b"packet 2"]
    assert end == NOON + 1


def test_a_number_that_comes_again_with_other_times_is_refused(tmp_path: Path) -> None:
    packets = Packets(Inbox(tmp_path), PATIENT, SOURCES)
    assert fates(packets, "east", [numbered(0), numbered(1)]) == ["waiting", "waiting"]
    again = [numbered(0, NOON + HOUR), numbered(0), numbered(2), numbered(2, NOON + 1)]
    assert fates(packets, "east", again) == ["refused", "duplicate", "waiting", "refused"]
    (_, why), _ = packets.receive("east", [numbered(1, NOON + HOUR), numbered(1)])
    assert why is not None
    assert "its number came before with other times" in why
    assert total(packets) == Account(received=8, waiting=3, duplicate=2, refused=3)


def test_a_number_that_comes_again_with_other_content_is_refused(tmp_path: Path) -> None:
    packets = Packets(Inbox(tmp_path), PATIENT, SOURCES)
    one, other = numbered(0, sha256="one"), numbered(0, sha256="other")
    assert fates(packets, "east", [one, one, other]) == ["waiting", "duplicate", "refused"]
    (fate, why), same = packets.receive("east", [other, one])
    assert (fate, why) == ("refused", "stream a, packet 0 came before with other content")
    assert same == ("duplicate", None)
    assert fates(packets, "west", [other]) == ["waiting"]
    # Of what an older rga has kept nobody knows the content.
    assert fates(packets, "east", [numbered(1), numbered(1, sha256="x")]) == [
        "waiting", "duplicate",
    ]  # fmt: skip
    account = total(packets)
    assert account == Account(received=8, waiting=3, duplicate=3, refused=2)
    assert account.difference == 0


def test_what_went_to_the_archive_is_told_from_another_by_its_age(tmp_path: Path) -> None:
    inbox = Inbox(tmp_path)
    packets = Packets(inbox, PATIENT, SOURCES)
    packets.receive("east", [numbered(0)])
    packets.seal(NOON + HOUR, None, [])
    later = NOON + 2 * IN_INBOX
    assert PacketArchive(inbox, tmp_path, None).tidy(later, lambda: True)
    assert fates(packets, "east", [numbered(0, arrived=later)]) == ["duplicate"]
    assert fates(packets, "east", [numbered(0, later, arrived=later)]) == ["refused"]


def test_what_has_no_number_is_known_by_its_content_for_a_day(packets: Packets) -> None:
    later = NOON + REMEMBERED
    assert fates(packets, "east", [plain("x"), plain("x"), plain("y")]) == [
        "waiting", "duplicate", "waiting",
    ]  # fmt: skip
    assert fates(packets, "east", [plain("x", later)]) == ["duplicate"]
    assert fates(packets, "east", [plain("x", later + 1)]) == ["waiting"]
    assert fates(packets, "west", [plain("x")]) == ["waiting"]


def test_what_cannot_be_used_is_kept_aside_and_its_number_has_come(packets: Packets) -> None:
    refused = numbered(0, refused="its clock is 2 h ahead")
    assert fates(packets, "east", [refused, refused]) == ["refused", "duplicate"]
    assert packets.numbers("east")["a"].whole == 1
    assert packets.between(NEVER, NOON + 1, 2**30)[0] == []
    assert total(packets) == Account(received=2, refused=1, duplicate=1)


def test_numbers_that_leave_too_many_gaps_are_refused(packets: Packets) -> None:
    packets.receive("east", [numbered(2 * one + 1) for one in range(10_000)])
    assert fates(packets, "east", [numbered(30_000)]) == ["refused"]
    assert fates(packets, "east", [numbered(4)]) == ["waiting"]


def test_what_is_late_hangs_on_what_came_before_it_alone(tmp_path: Path) -> None:
    packets = Packets(Inbox(tmp_path), Grid(every=HOUR, lateness=HOUR // 2), ("east", "west"))

    def send(source: str, hours: float) -> str:
        one = plain(f"{source} {hours}")
        moment = NOON + round(hours * HOUR)
        return fates(packets, source, [replace(one, first=moment, last=moment)])[0]

    assert send("east", 0.1) == "waiting"
    assert send("east", 3.4) == "waiting"
    # Rows wait for a source that has sent nothing yet.
    assert send("east", 0.2) == "waiting"
    assert send("west", 3.4) == "waiting"
    # Both are half an hour past 2:00, and no row was made yet.
    assert send("east", 1.9) == "late"
    assert send("east", 2.0) == "waiting"
    assert total(packets) == Account(received=6, late=1, waiting=5)


def test_a_source_reads_on_where_it_was(packets: Packets) -> None:
    assert packets.cursor("folder") == {}
    packets.receive("folder", [plain("x")], cursor={"a": {"offset": 3}})
    packets.receive("folder", [plain("y")])
    packets.receive("folder", [], cursor={"a": {"offset": 5}, "b": [1]})
    assert packets.cursor("folder") == {"a": {"offset": 5}, "b": [1]}
    assert packets.cursor("other") == {}
    assert packets.latest() == {"east": None, "west": None, "folder": NOON}


def test_payload_is_bounded_by_cutting_the_time(packets: Packets) -> None:
    packets.receive("east", [numbered(k, NOON + k) for k in range(10)])
    kept, end = packets.between(NOON, NOON + 10, 3 * len(b"packet 0"))
    assert ([one.payload[-1:] for one in kept], end) == ([b"0", b"1", b"2"], NOON + 3)
    kept, end = packets.between(NOON, NOON + 10, 1)
    assert (len(kept), end) == (1, NOON + 1)


@settings(max_examples=20)
@given(
    st.lists(
        st.tuples(
            st.sampled_from(["east", "west"]),
            st.integers(0, 12),
            st.integers(-3, 3),
            st.booleans(),
            st.booleans(),
        ),
        max_size=30,
    ),
    st.integers(0, 2**32),
)
def test_the_account_balances(
    tmp_path_factory: pytest.TempPathFactory,
    sent: list[tuple[str, int, int, bool, bool]],
    seed: int,
) -> None:
    packets = Packets(Inbox(tmp_path_factory.mktemp("inbox")), PATIENT, SOURCES)
    draw, until = random.Random(seed), NEVER
    expected: Counter[str] = Counter()
    known: dict[object, int | None] = {}
    moments: list[int] = []
    for source, name, hours, has_number, refused in sent:
        moment = NOON + hours * HOUR
        reason = "no packet" if refused else None
        one = numbered(name, moment, arrived=NOON + draw.randrange(3) * HOUR, refused=reason)
        if not has_number:
            one = Arrival(b"x", "file", one.arrived, moment, moment, None, str(name), reason)
        fate = fates(packets, source, [one])[0]
        key = (source, has_number, name)
        if key in known and (has_number or not refused):
            is_another = has_number and not refused and known[key] != moment
            assert fate == ("refused" if is_another else "duplicate")
        elif refused:
            assert fate == "refused"
        else:
            assert fate == ("late" if moment < until else "waiting")
            moments += [moment] if fate == "waiting" else []
        if has_number or not refused:
            known.setdefault(key, None if refused else moment)
        expected.update(["received"] if fate == "waiting" else ["received", fate])
        if draw.random() < 0.2:
            until = max(until, NOON + draw.randrange(-3, 3) * HOUR)
            packets.seal(until, None, [])
        expected["used"] = sum(one < until for one in moments)
        account = total(packets)
        assert account == Account(**expected, waiting=len(moments) - expected["used"])
        assert all(one.difference == 0 for one in packets.account().values())
