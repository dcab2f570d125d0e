"""Packets of long ago leave the inbox for files, and nothing of them is lost on the way."""

from functools import partial
from pathlib import Path

import polars as pl
import pytest

from rga.operation.inbox import archive
from rga.operation.inbox.account import Account
from rga.operation.inbox.archive import DAY, PacketArchive
from rga.operation.inbox.arrival import Arrival
from rga.operation.inbox.known_packets import IN_INBOX
from rga.operation.inbox.packets import HOUR, Packets
from rga.operation.packets.packet import Number
from rga.operation.rows.grid import Grid
from rga.twin.hardware.inbox import Inbox

#: 2026-11-23T00:00:00Z, a Monday
MONDAY = 1_795_392_000_000_000
NEXT_WEEK = MONDAY + IN_INBOX + DAY


@pytest.fixture
def inbox(tmp_path: Path) -> Inbox:
    return Inbox(tmp_path)


@pytest.fixture
def packets(inbox: Inbox) -> Packets:
    return Packets(inbox, Grid(every=HOUR, lateness=100 * DAY), ["logger"])


def arrive(
    packets: Packets,
    sequence: int,
    moment: int,
    refused: str | None = None,
    arrived: int | None = None,
) -> None:
    number, payload = Number("s", sequence), b"packet %d" % sequence
    one = Arrival(
        payload, "packet", arrived or moment, moment, moment, number=number, refused=refused
    )
    packets.receive("logger", [one])


def always() -> bool:
    return True


def contents(files: list[Path]) -> list[bytes]:
    return [one for file in files for one in pl.read_parquet(file)["payload"]]


def total(packets: Packets) -> Account:
    return sum(packets.account().values(), Account())


def test_a_day_leaves_when_it_is_a_week_old(packets: Packets, inbox: Inbox, tmp_path: Path) -> None:
    for hour in range(48):
        arrive(packets, hour, MONDAY + hour * HOUR, "unreadable" if hour == 5 else None)
    packets.seal(MONDAY + 48 * HOUR, None, [])
    before = total(packets)
    tidy = partial(PacketArchive(inbox, tmp_path, None).tidy, has_room=always)
    assert tidy(NEXT_WEEK - 1) == []
    files = tidy(NEXT_WEEK)
    assert [one.name for one in files] == [
        "packet-2026-11-23-001.parquet",
        "refused-2026-11-23-001.parquet",
    ]
    assert contents(files[:1]) == [b"packet %d" % k for k in range(24) if k != 5]
    assert contents(files[1:]) == [b"packet 5"]
    assert pl.read_parquet(files[1])["reason"].to_list() == ["unreadable"]
    kept, _ = packets.between(MONDAY, NEXT_WEEK, 2**30)
    assert [one.payload for one in kept] == [b"packet %d" % k for k in range(24, 48)]
    # What is known of them stays.
    assert total(packets) == before
    arrive(packets, 3, MONDAY + 3 * HOUR, arrived=NEXT_WEEK)
    assert total(packets).duplicate == 1
    assert tidy(NEXT_WEEK) == []


def test_what_waits_stays(packets: Packets, inbox: Inbox, tmp_path: Path) -> None:
    arrive(packets, 0, MONDAY)
    arrive(packets, 1, MONDAY + HOUR)
    packets.seal(MONDAY + HOUR, None, [])
    assert PacketArchive(inbox, tmp_path, None).tidy(NEXT_WEEK, always) == []
    packets.seal(MONDAY + 2 * HOUR, None, [])
    assert contents(PacketArchive(inbox, tmp_path, None).tidy(NEXT_WEEK, always)) == [
        b"packet 0", b"packet 1",
    ]  # fmt: skip


def test_a_large_day_makes_several_files(
    packets: Packets, inbox: Inbox, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(archive, "MOST_BYTES", 20)
    for hour in range(5):
        arrive(packets, hour, MONDAY + hour * HOUR)
    packets.seal(MONDAY + DAY, None, [])
    files = PacketArchive(inbox, tmp_path, None).tidy(NEXT_WEEK, always)
    assert [len(pl.read_parquet(one)) for one in files] == [2, 2, 1]
    assert contents(files) == [b"packet %d" % k for k in range(5)]


def test_what_was_written_before_a_kill_is_written_again(
    packets: Packets, inbox: Inbox, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    arrive(packets, 0, MONDAY)
    packets.seal(MONDAY + HOUR, None, [])

    def killed(path: Path) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(archive, "_put_on_disk", killed)
        with pytest.raises(KeyboardInterrupt):
            PacketArchive(inbox, tmp_path, None).tidy(NEXT_WEEK, always)
    assert len(packets.between(MONDAY, NEXT_WEEK, 2**30)[0]) == 1
    files = PacketArchive(inbox, tmp_path, None).tidy(NEXT_WEEK, always)
    assert contents(files) == [b"packet 0"]
    assert sorted((tmp_path / "archive").iterdir()) == files


def test_files_are_removed_when_they_are_old(
    packets: Packets, inbox: Inbox, tmp_path: Path
) -> None:
    for day in range(3):
        arrive(packets, day, MONDAY + day * DAY)
    packets.seal(MONDAY + 3 * DAY, None, [])
    tidy = partial(PacketArchive(inbox, tmp_path, 30).tidy, has_room=always)
    assert len(tidy(MONDAY + 31 * DAY - 1)) == 3
    tidy(MONDAY + 31 * DAY)
    names = sorted(one.name for one in (tmp_path / "archive").iterdir())
    assert names == ["packet-2026-11-24-001.parquet", "packet-2026-11-25-001.parquet"]


def test_days_wait_for_room_and_what_is_old_makes_it(
    packets: Packets, inbox: Inbox, tmp_path: Path
) -> None:
    for day in range(3):
        arrive(packets, day, MONDAY + day * DAY)
        arrive(packets, 10 + day, MONDAY + day * DAY, "unreadable")
    packets.seal(MONDAY + 3 * DAY, None, [])
    archive, before = PacketArchive(inbox, tmp_path, 30), total(packets)
    # It is asked before each file: there is room for that of Monday's packets alone.
    asked = iter([True, False])
    (monday,) = archive.tidy(MONDAY + 20 * DAY, lambda: next(asked))
    assert monday.name == "packet-2026-11-23-001.parquet"
    assert archive.tidy(MONDAY + 31 * DAY, lambda: False) == []
    assert not monday.exists()
    kept, _ = packets.between(MONDAY, NEXT_WEEK, 2**30)
    assert [one.payload for one in kept] == [b"packet 1", b"packet 2"]
    names = [one.name for one in archive.tidy(MONDAY + 20 * DAY, always)]
    assert names == [
        "refused-2026-11-23-001.parquet",
        "packet-2026-11-24-001.parquet",
        "refused-2026-11-24-001.parquet",
        "packet-2026-11-25-001.parquet",
        "refused-2026-11-25-001.parquet",
    ]
    assert total(packets) == before
