"""Names of users and tokens: the log shows them, so that each is of one of them."""

from sqlalchemy import Connection, select

from rga.dashboard.access import tables
from rga.errors import InputError

#: letters of a name
LONGEST_NAME = 64


def check_name(name: str, where: str) -> None:
    """Whether people can read a name.

    Raises:
        InputError: they cannot.
    """
    if not name.isprintable() or name != name.strip() or not 1 <= len(name) <= LONGEST_NAME:
        raise InputError("this is no name", where, f"take 1 to {LONGEST_NAME} visible letters")


def check_is_free(connection: Connection, name: str, where: str) -> None:
    """Whether nobody and no token has a name.

    Raises:
        InputError: somebody has.
    """
    for what, table in (("user", tables.user), ("token", tables.token)):
        if connection.execute(select(table.c.name).where(table.c.name == name)).first():
            raise InputError(f"there is a {what} of this name", where, "remove it first")
