"""Whoever guesses passwords waits, and longer each time."""

import time

from sqlalchemy import Connection, delete, insert, select, update

from rga.dashboard.access import tables
from rga.dashboard.access.drawn import Clock, digest
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of

#: failures without a delay: of one name, and of one address, which several people may share
OF_A_NAME, OF_AN_ADDRESS = 5, 20
#: the longest delay, and after which failures are forgotten [s]
LONGEST, FORGOTTEN = 300.0, 86_400.0


class Failures:
    """Logins that failed one after the other, in the file of a service.

    Args:
        file: of the service.
        clock: seconds since 1970 (UTC).
    """

    def __init__(self, file: TableFile, clock: Clock = time.time) -> None:
        self._file, self._clock = file, clock

    def begin(self, name: str, address: str) -> float:
        """Begin a login: it counts as failed until it succeeds, so that many at once gain nothing.

        Returns:
            How long to wait before it may be tried [s]; 0: it may be now.
        """
        now = self._clock()
        keys = ((_of(name), OF_A_NAME), (f"address {address}", OF_AN_ADDRESS))
        with self._file.writing() as connection:
            old = tables.failure.c.last < now - FORGOTTEN
            connection.execute(delete(tables.failure).where(old))
            known = [_count(connection, key) for key, _ in keys]
            waits = [
                last + delay_after(count, allowed) - now
                for (count, last), (_, allowed) in zip(known, keys, strict=True)
            ]
            if max(waits) > 0:
                return max(waits)
            for (key, _), (count, _) in zip(keys, known, strict=True):
                _keep(connection, key, count + 1, now)
        return 0.0

    def succeeded(self, name: str, address: str) -> None:
        """The login that was begun was right: its name has no failures, its address one less."""
        with self._file.writing() as connection:
            connection.execute(delete(tables.failure).where(tables.failure.c.key == _of(name)))
            count, last = _count(connection, f"address {address}")
            _keep(connection, f"address {address}", max(0, count - 1), last)


def delay_after(count: int, allowed: int) -> float:
    """How long to wait after so many failures [s].

    >>> [delay_after(count, 5) for count in (4, 5, 6, 7, 100)]
    [0.0, 1.0, 2.0, 4.0, 300.0]
    """
    return 0.0 if count < allowed else min(LONGEST, 2.0 ** min(count - allowed, 20))


def _of(name: str) -> str:
    # A password may have been typed where the name should be.
    return f"name {digest(name)}"


def _count(connection: Connection, key: str) -> tuple[int, float]:
    chosen = select(tables.failure).where(tables.failure.c.key == key)
    found = connection.execute(chosen).one_or_none()
    if found is None:
        return 0, 0.0
    known = values_of(tables.failure, found)
    return int(known["count"]), float(known["last"])


def _keep(connection: Connection, key: str, count: int, last: float) -> None:
    entry, which = with_checksum(key=key, count=count, last=last), tables.failure.c.key == key
    if not connection.execute(update(tables.failure).where(which).values(**entry)).rowcount:
        connection.execute(insert(tables.failure).values(**entry))
