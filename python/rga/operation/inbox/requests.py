"""Commands of people that are asked for once, however often they are sent."""

from sqlalchemy import Connection, MetaData, Table, insert, select

from rga.errors import InputError
from rga.twin.hardware.inbox import Inbox
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.columns import checksum, large_number, text
from rga.twin.repository.table_file import values_of

metadata = MetaData()
# The command that a key was first sent with.
_request = Table(
    "request",
    metadata,
    text("key", key=True),
    large_number("number"),
    text("command"),
    checksum(),
)


class KeyUsed(InputError):
    """Another command was sent with a key."""


class Requests:
    """The commands of one twin, in the file of its inbox.

    Args:
        inbox: of the twin.

    Raises:
        InputError: the file cannot be written.
    """

    def __init__(self, inbox: Inbox) -> None:
        self._inbox = inbox
        with inbox.writing() as connection:
            metadata.create_all(connection)

    def known(self, key: str, compared: str) -> int | None:
        """Number of the command that a key came with before; None: it is new.

        Args:
            key, compared: as `ask` takes them.

        Raises:
            KeyUsed: the key was sent with another command.
        """
        with self._inbox.reading() as connection:
            return _known(connection, key, compared)

    def ask(self, key: str, command: str, compared: str) -> int:
        """Keep a command on the disk, unless its key has come before.

        Args:
            key: drawn by whoever asks, the same when it is sent again.
            command: as JSON text.
            compared: what of it must be the same when it is sent again.

        Returns:
            Its number, or that of the command that the key was sent with before.

        Raises:
            KeyUsed: the key was sent with another command.
            InputError: nothing can be written.
        """
        with self._inbox.writing() as connection:
            known = _known(connection, key, compared)
            if known is not None:
                return known
            number = self._inbox.ask_within(connection, command)
            entry = with_checksum(key=key, number=number, command=compared)
            connection.execute(insert(_request).values(**entry))
            return number


def _known(connection: Connection, key: str, compared: str) -> int | None:
    found = connection.execute(select(_request).where(_request.c.key == key)).one_or_none()
    if found is None:
        return None
    known = values_of(_request, found)
    if known["command"] != compared:
        raise KeyUsed("another command was sent with this key", "request", "draw a new key")
    return int(known["number"])
