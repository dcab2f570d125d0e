"""What there is to tell of a twin: where it stands, and what has happened since a place."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.operator_alarm import OperatorAlarm
from rga.operation.reading.twin_now import TwinNow, moment
from rga.operation.reading.twin_reading import TwinReading
from rga.operation.service_clock import ServiceClock
from rga.operation.telling.told_place import NO_RUN, ToldPlace
from rga.twin.commands.proposals import decision
from rga.twin.repository import Proposal, RunView
from rga.twin.restore import standing_of

#: rows, and changes of alarms, that are told of at a time; others follow
MOST_TOLD = 200


@dataclass(frozen=True)
class TwinMessage:
    """Something to tell.

    Attributes:
        topic: below that of the twin.
        body: content, of names, numbers and times; None: what is retained is not so any more.
        retained: whether who comes later is told too.
    """

    topic: str
    body: object
    retained: bool = True


@dataclass(frozen=True)
class FoundTwin:
    """A twin as it was found at one time.

    Attributes:
        place: of its newest step, row and change of an alarm.
        now: where it stood; None: it had not begun.
        view: its run then.
    """

    place: ToldPlace
    now: TwinNow | None
    view: RunView | None


class TwinMessages:
    """What there is to tell of a twin.

    Args:
        reading: of the twin.
        alarms: of the service.
        clock: of the service.
    """

    def __init__(self, reading: TwinReading, alarms: AlarmBook, clock: ServiceClock) -> None:
        self._reading, self._alarms, self._clock = reading, alarms, clock

    def standing(self) -> FoundTwin:
        """The twin as it stands.

        Raises:
            InputError: its repository, or the file of the service, cannot be read.
        """
        change = self._alarms.last()
        now, view = self._reading.now(), self._reading.view()
        if now is None or view is None:
            return FoundTwin(ToldPlace(NO_RUN, 0, 0, change), None, None)
        then = view.at_step(now.steps)
        own = standing_of(then)
        rows = own.row if own.calibrated else 0
        return FoundTwin(ToldPlace(view.identity.key, now.steps, rows, change), now, then)

    def state(self, found: FoundTwin) -> list[TwinMessage]:
        """Where the twin stands."""
        now, at = found.now, self._clock.now()
        if now is None:
            return []
        body = {
            "at": at,
            "time": now.time,
            "age": None if now.time is None else (at - now.time).total_seconds(),
            "rows": now.rows,
            "version": now.version,
            "stage": now.stage,
            "out_of_sync": now.out_of_sync,
            "gap": now.gap,
        }
        return [TwinMessage("state", body)]

    def every_state(self, found: FoundTwin) -> list[TwinMessage]:
        """All that is so now: for a broker that was told nothing, or has lost it.

        Raises:
            InputError: the repository, or the file of the service, cannot be read.
        """
        open_ = [one for one in self._alarms.open() if one.twin == self._reading.name]
        said = [message for one in open_ for message in _of_alarm(one)]
        if found.view is not None:
            said += self._gaps(found.view, found.place.rows - 1, found.place.rows)
            if found.now is not None and found.now.undecided is not None:
                said += _of_proposal(found.view, found.now.undecided)
        return said

    def since(self, found: FoundTwin, told: ToldPlace) -> tuple[list[TwinMessage], ToldPlace]:
        """What has happened since a place of the same run, and the place up to which it is told.

        Raises:
            InputError: the repository, or the file of the service, cannot be read.
        """
        here = found.place
        changes = self._alarms.transitions(told.change, MOST_TOLD)
        change = changes[-1].number if changes else told.change
        alarms = [self._alarms.of(id) for id in dict.fromkeys(one.alarm for one in changes)]
        own = [one for one in alarms if one.twin == self._reading.name]
        said = [message for one in own for message in _of_alarm(one)]
        rows = max(told.rows, min(here.rows, told.rows + MOST_TOLD))
        if found.view is not None:
            said += self._gaps(found.view, told.rows, rows)
            said += _steps(found.view, told.step)
        return said, ToldPlace(here.run, here.step, rows, change)

    def _gaps(self, view: RunView, first: int, end: int) -> Iterator[TwinMessage]:
        """The gap of every sensor, row by row."""
        first = max(0, first)
        time, twin = view.measured(first, end).time, self._reading.twin
        if not len(time) or twin is None:
            return
        series = self._reading.series(float(time[0]), float(time[-1]) + 1e-3, len(time))
        assert series is not None  # it has begun
        for seconds, gaps in zip(series.gap.time, series.gap.mean, strict=True):
            own = dict(zip(series.sensors, gaps.tolist(), strict=True))
            body = {"time": moment(twin.station.start, float(seconds)), "sensors": own}
            yield TwinMessage("gap", body)


def _steps(view: RunView, told: int) -> Iterator[TwinMessage]:
    """What happened in the steps behind one, and what became of proposals."""
    count = Counter[int]()
    for step, one in view.events_since(told):
        body = {
            # By which a second copy is known.
            "id": f"{step}.{count[step]}",
            "kind": one.kind,
            "row": one.row,
            "time": one.time,
            "words": one.words,
            "sensors": one.sensors,
        }
        count[step] += 1
        yield TwinMessage("event", body, retained=False)
    before = view.at_step(told)
    known = len(before.proposals())
    for proposal in view.proposals():
        ends = _is_open(before, proposal) and not _is_open(view, proposal)
        if proposal.number > known or ends:
            yield from _of_proposal(view, proposal)


def _is_open(view: RunView, proposal: Proposal) -> bool:
    """Whether somebody is still to decide about a proposal: another takes its place."""
    return proposal.number == len(view.proposals()) and decision(view, proposal) is None


def _of_alarm(alarm: OperatorAlarm) -> list[TwinMessage]:
    return _while_it_lasts(f"alarm/{alarm.id}", alarm, lasts=alarm.state != "closed")


def _of_proposal(view: RunView, proposal: Proposal) -> list[TwinMessage]:
    body = {
        "number": proposal.number,
        "row": proposal.row,
        "words": proposal.words,
        "gain": proposal.gain,
        "gain_ci90": proposal.gain_ci90,
        "decided": decision(view, proposal),
    }
    return _while_it_lasts(f"proposal/{proposal.number}", body, lasts=_is_open(view, proposal))


def _while_it_lasts(topic: str, body: object, *, lasts: bool) -> list[TwinMessage]:
    """What is retained while it is so; when it ends, who listens is told, and nothing stays."""
    if lasts:
        return [TwinMessage(topic, body)]
    return [TwinMessage(topic, body, retained=False), TwinMessage(topic, None)]
