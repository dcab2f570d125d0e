"""Browsers that are logged in."""

import time

from sqlalchemy import delete, insert, select, update

from rga.dashboard.access import tables
from rga.dashboard.access.drawn import Clock, digest, drawn
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of

#: after which an idle session ends [s]
IDLE = 12 * 3600.0
#: how often it is written that a session is in use [s]
NOTED = 60.0


class Sessions:
    """Sessions, in the file of a service.

    Args:
        file: of the service.
        clock: seconds since 1970 (UTC).
    """

    def __init__(self, file: TableFile, clock: Clock = time.time) -> None:
        self._file, self._clock = file, clock

    def begin(self, user: str) -> str:
        """Begin a session, and return the secret that the browser keeps."""
        secret, now = drawn(), self._clock()
        entry = with_checksum(sha256=digest(secret), user=user, used=now)
        with self._file.writing() as connection:
            connection.execute(delete(tables.session).where(tables.session.c.used < now - IDLE))
            connection.execute(insert(tables.session).values(**entry))
        return secret

    def user_of(self, secret: str) -> str | None:
        """Whose session it is; None: it has ended, or never was."""
        now, which = self._clock(), tables.session.c.sha256 == digest(secret)
        with self._file.reading() as connection:
            found = connection.execute(select(tables.session).where(which)).one_or_none()
            known = None if found is None else values_of(tables.session, found)
        if known is None or now - known["used"] > IDLE:
            return None
        if now - known["used"] > NOTED:
            with self._file.writing() as connection:
                entry = with_checksum(**known | {"used": now})
                connection.execute(update(tables.session).where(which).values(**entry))
        return str(known["user"])

    def end(self, secret: str) -> None:
        """End a session, if it has not ended."""
        with self._file.writing() as connection:
            connection.execute(
                delete(tables.session).where(tables.session.c.sha256 == digest(secret))
            )
