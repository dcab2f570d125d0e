"""Notices in words."""

from collections.abc import Mapping, Sequence
from datetime import datetime

from rga.operation.alarms.operator_alarm import AlarmTransition, OperatorAlarm
from rga.operation.service_clock import in_minutes
from rga.quantities import counted

#: notices that a message spells out; it counts the others
MOST_TOLD = 20
#: sensors that are named; others are counted
MOST_NAMED = 8
#: what is said of the service itself, in place of the name of a twin
SERVICE = "service"


def notice_words(alarm: OperatorAlarm, transition: AlarmTransition) -> str:
    """What is told of a transition: what is wrong, with which sensors, since when, and who said so.

    >>> from datetime import UTC
    >>> noon = datetime(2026, 11, 27, 12, tzinfo=UTC)
    >>> alarm = OperatorAlarm(
    ...     3, "east", "quality", "silent", "D1", "D1 sends nothing", ("D1",), 0, noon, noon
    ... )
    >>> notice_words(alarm, AlarmTransition(7, 3, "raised", noon, None, "", alarm.words))
    'alarm 3 (quality) raised: D1 sends nothing; since 2026-11-27 12:00 UTC'
    """
    words = f"alarm {alarm.id} ({alarm.kind}) {transition.change}"
    if transition.who is not None:
        words += f" by {transition.who}"
    if transition.change == "shelved" and alarm.shelved_until is not None:
        words += f" until {in_minutes(alarm.shelved_until)}"
    if transition.why:
        words += f" ({transition.why})"
    words += f": {alarm.words}"
    unnamed = [one for one in alarm.sensors if one not in alarm.words]
    if unnamed:
        words += f"; sensors {_named(unnamed)}"
    return f"{words}; since {in_minutes(alarm.since)}"


def title_of(twin: str | None, notices: Sequence[str]) -> str:
    """What a message is headed with.

    >>> title_of("east", ["alarm 3 (quality) raised: D1 sends nothing"])
    'east: alarm 3 (quality) raised'
    >>> title_of(None, ["one", "another"])
    'service: 2 notices of alarms'
    """
    name = SERVICE if twin is None else twin
    if len(notices) == 1:
        return f"{name}: {notices[0].partition(':')[0]}"
    return f"{name}: {counted(len(notices), 'notice')} of alarms"


def body_of(notices: Sequence[str], held_back: int, link: str, id: str) -> str:
    """What a message says.

    Args:
        notices: in words, in their order.
        held_back: how many of them had to wait for others to be few enough.
        link: address of the alarms.
        id: of the message, by which one that comes twice is known.
    """
    more = len(notices) - MOST_TOLD
    lines = list(notices[:MOST_TOLD])
    if more > 0:
        lines.append(f"... and {more} more")
    if held_back:
        lines.append(f"{held_back} of these had been held back, as there were too many messages")
    return "\n".join([*lines, link, f"notice {id}"])


def all_is_well(alarms: Sequence[OperatorAlarm], rows: Mapping[str, datetime | None]) -> str:
    """The line of every day: that there is somebody to tell, whatever there is.

    Args:
        alarms: that are open.
        rows: until when the rows of each twin are final; None: it has none.

    >>> all_is_well([], {"east": None})
    'All is well: no alarm is open. Newest row: east none.'
    """
    active = [one for one in alarms if one.is_active]
    said = "All is well: no alarm is open."
    if active:
        verb = "is" if len(active) == 1 else "are"
        said = f"{counted(len(active), 'alarm')} {verb} open, the latest: {active[-1].words}."
    newest = [f"{name} {in_minutes(until) if until else 'none'}" for name, until in rows.items()]
    return f"{said} Newest row: {', '.join(newest)}."


def _named(sensors: Sequence[str]) -> str:
    more = len(sensors) - MOST_NAMED
    named = ", ".join(sensors[:MOST_NAMED])
    return f"{named} and {more} more" if more > 0 else named
