"""Looks at all twins and the service in turn, and keeps the book of alarms."""

from collections.abc import Callable, Mapping, MutableMapping, Sequence
from functools import partial

from rga.errors import in_short
from rga.operation.alarms.alarm_book import AlarmBook
from rga.operation.alarms.service_watch import ServiceWatch
from rga.operation.alarms.twin_watch import Troubles, TwinWatch
from rga.operation.service_clock import ServiceClock

#: what a fault of the supervision is kept under, and the service in place of a twin
ALARMS, SERVICE = "alarms", ""


class Supervision:
    """Observes twins and the service, again and again.

    A service that was just started says nothing of what is silent: every source has its patience
    before it does, and nothing is taken for well again before that. All else that is wrong is heard
    at once, also what a twin said while the service was away.

    Args:
        book: of alarms.
        twins: that are looked at.
        service: that serves them.
        troubles: of every twin, as the service knows them.
        faults: takes why a twin could not be looked at, in words, by its name and ALARMS.
        clock: of the service.

    Raises:
        InputError: the book cannot be written.
    """

    def __init__(
        self,
        book: AlarmBook,
        twins: Sequence[TwinWatch],
        service: ServiceWatch,
        troubles: Callable[[], Mapping[str, Troubles]],
        faults: MutableMapping[tuple[str, str], str],
        clock: ServiceClock,
    ) -> None:
        self._book, self._twins, self._service = book, tuple(twins), service
        self._troubles, self._faults, self._clock = troubles, faults, clock
        self._begun = clock.monotonic()
        book.clear_others([one.name for one in twins])

    def round(self) -> None:
        """Look at everything once; what fails at one twin keeps no other from being looked at.

        Raises:
            InputError: the file of the service cannot be read.
        """
        up, troubles = self._clock.monotonic() - self._begun, self._troubles()
        for one in self._twins:
            restarted = up < one.patience
            self._try(one.name, partial(self._look_at, one, troubles[one.name], restarted))
        longest = max(one.patience for one in self._twins)
        self._try(SERVICE, partial(self._look_at_service, up < longest))

    def close(self) -> None:
        """Close the connections to the repositories."""
        for one in self._twins:
            one.close()

    def _look_at(self, twin: TwinWatch, troubles: Troubles, restarted: bool) -> None:
        self._book.observe(twin.name, twin.look(troubles, restarted))
        twin.kept()

    def _look_at_service(self, restarted: bool) -> None:
        self._book.end_shelves()
        self._book.observe(None, self._service.look(restarted))

    def _try(self, twin: str, does: Callable[[], None]) -> None:
        try:
            does()
        except Exception as error:  # whatever it is, other twins have alarms too
            self._faults[twin, ALARMS] = in_short(error)
        else:
            self._faults.pop((twin, ALARMS), None)
