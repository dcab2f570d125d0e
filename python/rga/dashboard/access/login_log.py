"""Who came in, who was refused, and who left."""

import time
from dataclasses import dataclass
from typing import Literal

from sqlalchemy import delete, func, insert, select

from rga.dashboard.access import tables
from rga.dashboard.access.drawn import Clock
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of

#: entries that are kept
MOST = 100_000
LoginOutcome = Literal["in", "refused", "out"]


@dataclass(frozen=True)
class Login:
    """Something that the log holds.

    Attributes:
        at: when [s since 1970, UTC].
        name: of the user; of nobody who is known, "unknown": a password may stand in its place.
        address: that it came from.
        outcome: what came of it.
    """

    at: float
    name: str
    address: str
    outcome: LoginOutcome


class LoginLog:
    """Logins, in the file of a service.

    Args:
        file: of the service.
        clock: seconds since 1970 (UTC).
    """

    def __init__(self, file: TableFile, clock: Clock = time.time) -> None:
        self._file, self._clock = file, clock

    def write(self, name: str | None, address: str, outcome: LoginOutcome) -> None:
        """Keep an entry.

        Args:
            name: of a user; None: nobody who is known.
        """
        c = tables.login.c
        with self._file.writing() as connection:
            number = int(connection.scalar(select(func.max(c.number))) or 0) + 1
            entry = with_checksum(
                number=number,
                at=self._clock(),
                name=name or "unknown",
                address=address,
                outcome=outcome,
            )
            connection.execute(insert(tables.login).values(**entry))
            connection.execute(delete(tables.login).where(c.number <= number - MOST))

    def latest(self, entries: int = 100) -> list[Login]:
        """The latest entries, the newest first."""
        chosen = select(tables.login).order_by(tables.login.c.number.desc()).limit(entries)
        with self._file.reading() as connection:
            found = [values_of(tables.login, one) for one in connection.execute(chosen)]
        return [Login(one["at"], one["name"], one["address"], one["outcome"]) for one in found]
