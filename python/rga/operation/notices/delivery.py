"""Sends notices: each at least once, with an id by which one that comes twice is known."""

import logging
from collections.abc import Callable
from contextvars import ContextVar
from datetime import timedelta

from apprise import Apprise

from rga.errors import InputError, in_a_line
from rga.operation.notices.notify_settings import NotifySettings
from rga.operation.notices.outbox import Outbox
from rga.operation.service_clock import ServiceClock

#: after its time, how long the line of a day is still sent: later it would say nothing of it
DAILY_SPAN = timedelta(hours=1)
#: whoever hears what is said of the message that is being sent; it goes along to other threads
_SENDING: ContextVar["_Complaints | None"] = ContextVar("sending", default=None)


class Delivery:
    """Brings one recipient what the outbox has for it.

    Args:
        recipient: who it is.
        outbox: of the service.
        summary: the line of a day, as things are.
        clock: of the service.

    Raises:
        InputError: the file of its address cannot be read, or holds none.
    """

    def __init__(
        self,
        recipient: NotifySettings,
        outbox: Outbox,
        summary: Callable[[], str],
        clock: ServiceClock,
    ) -> None:
        self._recipient, self._outbox = recipient, outbox
        self._summary, self._clock = summary, clock
        self._said = ""
        sender_of(recipient)

    def round(self) -> None:
        """Write the messages that are due, and send them.

        Raises:
            InputError: the file of the service cannot be written.
        """
        name = self._recipient.name
        self._say_all_is_well()
        self._outbox.gather(name)
        for message in self._outbox.due(name):
            fault = self._send(message.title, message.body)
            self._outbox.tried(message, fault)
            if fault is not None:
                return

    def _say_all_is_well(self) -> None:
        at, now = self._recipient.all_is_well, self._clock.now()
        if at is None:
            return
        begin = now.replace(hour=at.hour, minute=at.minute, second=at.second, microsecond=0)
        day = f"{now:%Y-%m-%d}"
        if begin <= now < begin + DAILY_SPAN and day != self._said:
            self._outbox.add_daily(self._recipient.name, day, self._summary())
            self._said = day

    def _send(self, title: str, body: str) -> str | None:
        """Why a message did not arrive; None: it did."""
        try:
            # The file is read anew each time: what is secret in it may change.
            sender = sender_of(self._recipient)
        except InputError as error:
            return str(error)
        with _Complaints() as complaints:
            try:
                arrived = bool(sender.notify(body=body, title=title))
            except Exception as error:  # there are a hundred ways to send, each with its own
                return in_a_line(f"{type(error).__name__}: {error}")
        return None if arrived else complaints.words


class _Complaints(logging.Handler):
    """What apprise says of the message that is sent here, and not of those that others send."""

    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self._logger = logging.getLogger("apprise")
        self.words = "it was not taken"

    def __enter__(self) -> "_Complaints":
        self._token = _SENDING.set(self)
        self._logger.addHandler(self)
        return self

    def __exit__(self, *_: object) -> None:
        self._logger.removeHandler(self)
        _SENDING.reset(self._token)

    def emit(self, record: logging.LogRecord) -> None:
        """Keep the last of them."""
        if _SENDING.get() is self:
            self.words = in_a_line(record.getMessage())


def sender_of(recipient: NotifySettings) -> Apprise:
    """What sends to the addresses of a recipient.

    Raises:
        InputError: their file cannot be read, or holds none.
    """
    where, remedy = str(recipient.url_file), "one address of apprise a line, such as mailto://..."
    try:
        lines = recipient.url_file.read_text("utf-8").split()
    except (OSError, UnicodeDecodeError):
        raise InputError("the address of notices cannot be read", where, remedy) from None
    sender = Apprise()
    if not lines or not sender.add(lines):
        raise InputError("it holds no address that notices can go to", where, remedy)
    return sender
