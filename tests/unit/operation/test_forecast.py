"""What a year takes of a disk, against a calculation by hand."""

from pathlib import Path

import pytest

from rga.operation.configuration import TwinSettings
from rga.operation.disk.forecast import YearlyGrowth, disk_forecast, yearly_growth
from rga.operation.inbox.arrival import Arrival
from rga.operation.inbox.flow import bytes_a_second
from rga.operation.inbox.packets import HOUR, Packets
from rga.operation.packets.packet import Number
from rga.operation.rows.grid import Grid
from rga.twin.hardware.inbox import Inbox

#: 2026-11-23T00:00:00Z
MONDAY = 1_795_392_000_000_000
MINUTE = HOUR // 60


def settings(**changed: object) -> TwinSettings:
    given = {"name": "east", "model": "m", "settings": "s", "rows": {"every": "10 min"}}
    return TwinSettings.model_validate(given | {"source": [{"kind": "http"}]} | changed)


@pytest.mark.parametrize(
    ("changed", "packets"),
    [
        # 365.25 days of 86 400 s, of 100 bytes each.
        ({}, 3_155_760_000),
        ({"retention": {"raw": "90 d"}}, 777_600_000),
        ({"retention": {"raw": "4000 d"}}, 3_155_760_000),
    ],
)
def test_a_year_is_as_calculated_by_hand(changed: dict[str, object], packets: float) -> None:
    # 52 596 rows of ten minutes; 11 sensors and 3 contexts of 44 bytes are 616, and a tenth of a
    # step 400.
    assert yearly_growth(settings(**changed), 14, 10, 100.0) == YearlyGrowth(53_437_536, packets)


@pytest.mark.parametrize(
    ("free", "lasts", "days"), [(1_000, True, 365.25), (999, False, 364.884_75)]
)
def test_room_is_for_all_twins(free: int, lasts: bool, days: float) -> None:
    found = disk_forecast(free, 0.5, YearlyGrowth(300, 100), [YearlyGrowth(500, 100)])
    assert (found.year.total, found.year_of_all, found.lasts_a_year) == (400, 1000, lasts)
    assert found.days == pytest.approx(days, rel=1e-12)


def arrive(packets: Packets, source: str, sequence: int, moment: int, size: int) -> None:
    number = Number(source, sequence)
    packets.receive(source, [Arrival(b"x" * size, "packet", moment, moment, moment, number=number)])


def test_what_sources_send_is_as_calculated_by_hand(tmp_path: Path) -> None:
    inbox = Inbox(tmp_path)
    packets = Packets(inbox, Grid(every=HOUR, lateness=100 * HOUR), ["fast", "slow"])
    assert bytes_a_second(inbox) == 0.0
    arrive(packets, "fast", 0, MONDAY, 5_000)
    assert bytes_a_second(inbox) == 0.0
    # 120 bytes a minute after the first, and 7 200 bytes in two hours.
    for minute in range(1, 11):
        arrive(packets, "fast", minute, MONDAY + minute * MINUTE, 120)
    for hour in (0, 2):
        arrive(packets, "slow", hour, MONDAY + hour * HOUR, 7_200)
    assert bytes_a_second(inbox) == pytest.approx(2.0 + 1.0, rel=1e-12)
    # What comes late is of another time.
    packets.seal(MONDAY, None, [])
    arrive(packets, "slow", 3, MONDAY - 1_000 * HOUR, 7_200)
    assert bytes_a_second(inbox) == pytest.approx(3.0, rel=1e-12)
