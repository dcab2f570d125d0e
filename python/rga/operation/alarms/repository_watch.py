"""What a twin says of itself: it is out of sync, or proposes a cause."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import partial

from rga.model import Model
from rga.operation.alarms.alarm_rate import rate_words
from rga.operation.alarms.condition import Condition, ConditionKey, Ending
from rga.operation.alarms.proposal_watch import proposed
from rga.operation.reading.twin_now import moment
from rga.operation.reading.twin_reading import TwinReading
from rga.twin.history import Event
from rga.twin.repository import RunView
from rga.twin.restore import standing_of, station_of
from rga.twin.run_state import Standing
from rga.twin.settings import Settings

#: of a twin that has not begun
NO_RUN = ""


@dataclass(frozen=True)
class RunPlace:
    """Up to where the run of a twin was looked at.

    Attributes:
        run: key of the run; NO_RUN: none had begun.
        step: the last one that was seen.
    """

    run: str
    step: int


@dataclass(frozen=True)
class SeenRun:
    """What was seen of the run of a twin.

    Attributes:
        conditions: that are there now.
        occurred: alarms of the monitor since the last look.
        place: up to where it was looked.
        rows: that the twin has taken in.
        endings: what came of its proposals.
    """

    conditions: tuple[Condition, ...]
    occurred: tuple[Condition, ...]
    place: RunPlace
    rows: int
    endings: Mapping[ConditionKey, Ending] = field(default_factory=dict)


class RepositoryWatch:
    """Looks at the run of a twin as it goes on.

    Args:
        reading: of the twin.
        settings: of its run.
        every: length of a row [s].
        model: as it was given.
        place: up to where it was looked at before; None: never, and what lies in the past raises
            no alarm unless it goes on.
    """

    def __init__(
        self,
        reading: TwinReading,
        settings: Settings,
        every: float,
        model: Model,
        place: RunPlace | None,
    ) -> None:
        self._reading, self._name, self._place = reading, reading.name, place
        self._rate = rate_words(settings, every, model)
        self._view: RunView | None = None
        self._seen: SeenRun | None = None

    def look(self) -> SeenRun:
        """What there is to see now; what occurred is seen again until it is `kept`.

        Raises:
            InputError: the repository cannot be read.
        """
        try:
            return self._look()
        except BaseException:
            self._view = self._seen = None
            raise

    def kept(self) -> None:
        """The alarms of what occurred up to the last look are kept."""
        if self._seen is not None:
            self._place, self._seen = self._seen.place, replace(self._seen, occurred=())

    def _look(self) -> SeenRun:
        if self._view is None:
            self._view = self._reading.view()
        if self._view is None:
            return SeenRun((), (), RunPlace(NO_RUN, 0), 0)
        view, here = self._view, RunPlace(self._view.identity.key, self._view.steps)
        if self._seen is None or self._seen.place != here:
            # As it stood then: steps that are taken meanwhile are looked at the next time.
            self._seen = self._look_at(view.at_step(here.step), here)
        if not self._seen.occurred:
            self._place = here
        return self._seen

    def _look_at(self, view: RunView, here: RunPlace) -> SeenRun:
        before = here if self._place is None else self._place
        since = before.step if before.run == here.run else 0
        occurred = tuple(
            self._gap(view, step, event)
            for step, event in view.events_since(since)
            if event.kind == "alarm"
        )
        standing = standing_of(view)
        conditions = []
        if standing.out_of_sync:
            conditions.append(occurred[-1] if occurred else self._lasting(view, standing))
        waiting, endings = proposed(self._name, view, partial(_at, view))
        if waiting is not None:
            conditions.append(waiting)
        return SeenRun(tuple(conditions), occurred, here, view.rows, endings)

    def _gap(self, view: RunView, step: int, event: Event) -> Condition:
        """What an alarm of the monitor says, in the run as it stood at that step."""
        then, before = view.at_step(step), standing_of(view.at_step(step - 1))
        standing = standing_of(then)
        row = event.row if standing.since is None else standing.since
        words = f"{event.words}; {self._rate}" if self._rate else event.words
        since, again = _at(then, row), before.out_of_sync
        return Condition(self._key, words, since, event.sensors, is_again=again)

    def _lasting(self, view: RunView, standing: Standing) -> Condition:
        """A gap that an alarm was raised of before, or that shows without one."""
        row = standing.row if standing.since is None else standing.since
        return Condition(
            self._key, "no contexts explain the latest rows: the model is in doubt", _at(view, row)
        )

    @property
    def _key(self) -> ConditionKey:
        return ConditionKey(self._name, "gap", "alarm", "twin")


def _at(view: RunView, row: int) -> datetime:
    """The time of a row; that of the last step where it was not taken in."""
    time = view.measured(row, row + 1).time
    if not len(time):
        return datetime.fromisoformat(view.acknowledged_at).astimezone(UTC)
    return moment(station_of(view).start, float(time[0])).astimezone(UTC)
