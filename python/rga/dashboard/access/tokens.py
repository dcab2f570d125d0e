"""Tokens by which programs call: each for one twin and one purpose."""

import time
from dataclasses import dataclass

from sqlalchemy import delete, insert, select

from rga.dashboard.access import tables
from rga.dashboard.access.drawn import Clock, digest, drawn
from rga.dashboard.access.names import check_is_free, check_name
from rga.dashboard.access.roles import Purpose, Who
from rga.errors import InputError
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of


@dataclass(frozen=True)
class Token:
    """What is known of a token; it itself is shown once.

    Attributes:
        name: by which it is removed, and which the log shows.
        purpose: what it is for.
        twin: that it is for.
        made: when [s since 1970, UTC].
    """

    name: str
    purpose: Purpose
    twin: str
    made: float


class Tokens:
    """Tokens, in the file of a service.

    Args:
        file: of the service.
        clock: seconds since 1970 (UTC).
    """

    def __init__(self, file: TableFile, clock: Clock = time.time) -> None:
        self._file, self._clock = file, clock

    def make(self, name: str, purpose: Purpose, twin: str) -> str:
        """Make a token, and return the secret, which is kept nowhere.

        Raises:
            InputError: there is a user or token of this name, or it is none.
        """
        where = f"token {name!r}"
        check_name(name, where)
        secret = drawn()
        entry = with_checksum(
            sha256=digest(secret), name=name, purpose=purpose, twin=twin, made=self._clock()
        )
        with self._file.writing() as connection:
            check_is_free(connection, name, where)
            connection.execute(insert(tables.token).values(**entry))
        return secret

    def remove(self, name: str) -> None:
        """Let a token in no more.

        Raises:
            InputError: there is no such token.
        """
        with self._file.writing() as connection:
            done = connection.execute(delete(tables.token).where(tables.token.c.name == name))
        if not done.rowcount:
            raise InputError("there is no such token", f"token {name!r}", "look at its letters")

    def all(self) -> list[Token]:
        """What is known of each, in the order in which they were made."""
        chosen = select(tables.token).order_by(tables.token.c.made)
        with self._file.reading() as connection:
            found = [values_of(tables.token, one) for one in connection.execute(chosen)]
        return [Token(one["name"], one["purpose"], one["twin"], one["made"]) for one in found]

    def who_has(self, secret: str) -> Who | None:
        """Who calls with a token; None: nobody does."""
        chosen = select(tables.token).where(tables.token.c.sha256 == digest(secret))
        with self._file.reading() as connection:
            found = connection.execute(chosen).one_or_none()
        if found is None:
            return None
        known = values_of(tables.token, found)
        return Who(known["name"], known["purpose"], known["twin"])
