"""Data: what became of every packet, what is missing, refused or late, disk and lag."""

from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from rga.dashboard.pages.heading import heading, heading_of_damaged
from rga.dashboard.surroundings import SeenTwin, Surroundings
from rga.errors import InputError
from rga.operation.disk.forecast import MAKE_ROOM, DiskForecast
from rga.operation.inbox.account import Account
from rga.operation.inbox.refused import refused_packets
from rga.operation.packets.packet import EPOCH
from rga.quantities import bytes_in_words, counted, percent

#: gaps in numbers of a stream, and refused packets, that are listed
GAPS, REFUSED = 20, 20
#: letters of a refused packet that are shown
SAMPLE = 120


@dataclass(frozen=True)
class StreamAccount:
    """Numbers of a stream: the next that is expected, how many are missing, and which."""

    name: str
    next: int
    missing: int
    gaps: str


@dataclass(frozen=True)
class SourceAccount:
    """What became of the packets of a source.

    Attributes:
        name: of it.
        total, day: of all packets, and of those of the last 24 hours.
        late: share of the late ones.
        streams: that number their packets.
        latest: the latest time that it has sent.
        fault: what keeps it from going on; empty: nothing does.
    """

    name: str
    total: Account
    day: Account
    late: str
    streams: list[StreamAccount]
    latest: datetime | None
    fault: str


@dataclass(frozen=True)
class RefusedLine:
    """A packet that could not be used: from where, when, why, and how it begins."""

    source: str
    time: datetime
    reason: str
    sample: str


def data_page(seen: SeenTwin) -> dict[str, Any]:
    """What the page of data shows; it can be drawn whatever became of the repository."""
    now = None
    try:
        now = seen.reading.now()
        top = heading(seen, now)
    except InputError as error:
        top = heading_of_damaged(seen, error)
    forecast = seen.forecast()
    return {
        "heading": top,
        "tab": "/data",
        "sources": _sources(seen),
        "refused": [
            RefusedLine(one.source, time_of(one.arrived), one.reason, safe_sample(one.payload))
            for one in refused_packets(seen.served.inbox, REFUSED)
        ],
        "lag": seen.lag(now),
        "rows": seen.served.inbox.rows,
        "disk_free": bytes_in_words(forecast.free),
        "disk_share": percent(100 * forecast.free_share, sign=False),
        "disk_used": bytes_in_words(_size(seen)),
        "year_rows": bytes_in_words(forecast.year.rows),
        "year_packets": bytes_in_words(forecast.year.packets) if forecast.year.packets else "",
        "year_of_all": bytes_in_words(forecast.year_of_all),
        "no_room": "" if forecast.lasts_a_year else _no_room(forecast),
        "faults": {name: words for name, words in seen.faults.items() if name == "rows"},
    }


def _no_room(forecast: DiskForecast) -> str:
    """That there is no room for a year, and for how long there is."""
    return (
        f"There is no room for a year: all twins take about "
        f"{bytes_in_words(forecast.year_of_all)} in one, and what is free lasts for "
        f"{counted(int(forecast.days), 'day')}. What helps: {MAKE_ROOM}."
    )


def time_of(microseconds: int) -> datetime:
    """A time, from microseconds since 1970 (UTC)."""
    return EPOCH + timedelta(microseconds=microseconds)


def safe_sample(payload: bytes) -> str:
    """How a payload begins, in letters that do nothing.

    >>> safe_sample(b"a\\x00b\\xff")
    'a·b·'
    """
    text = payload[:SAMPLE].decode("ascii", "replace")
    shown = "".join(sign if sign.isprintable() and sign.isascii() else "·" for sign in text)
    return shown + ("…" if len(payload) > SAMPLE else "")


def _sources(seen: SeenTwin) -> list[SourceAccount]:
    packets = seen.served.packets
    accounts, latest = packets.account(), packets.latest()
    since = (Surroundings.now() - EPOCH - timedelta(days=1)) // timedelta(microseconds=1)
    found = []
    for name in seen.served.source_names:
        own = [(hour, one) for (source, hour), one in accounts.items() if source == name]
        total = sum((one for _, one in own), Account())
        day = sum((one for hour, one in own if hour >= since), Account())
        share = percent(100 * total.late / total.received, sign=False) if total.received else "–"
        streams = [
            StreamAccount(stream, known.next, known.missing, _gaps(known.gaps))
            for stream, known in seen.served.numbers(name).items()
        ]
        last = latest.get(name)
        moment = None if last is None else time_of(last)
        fault = seen.faults.get(name, "")
        found.append(SourceAccount(name, total, day, share, streams, moment, fault))
    return found


def _gaps(gaps: list[tuple[int, int]]) -> str:
    said = [str(a) if a == b else f"{a} to {b}" for a, b in gaps[:GAPS]]
    more = len(gaps) - len(said)
    return ", ".join(said) + (f" and {more} more" if more > 0 else "")


def _size(seen: SeenTwin) -> int:
    """Bytes of the folder of the twin."""
    return sum(one.stat().st_size for one in seen.served.directory.glob("**/*") if one.is_file())
