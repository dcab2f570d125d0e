"""The users of a service."""

from sqlalchemy import delete, func, insert, select, update

from rga.dashboard.access import tables
from rga.dashboard.access.names import check_is_free, check_name
from rga.dashboard.access.passwords import hashed, matches, nobodys
from rga.dashboard.access.roles import Role
from rga.errors import InputError
from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.table_file import TableFile, values_of


class Users:
    """Names, roles and passwords, in the file of a service.

    Args:
        file: of the service.
    """

    def __init__(self, file: TableFile) -> None:
        self._file = file

    @property
    def exist(self) -> bool:
        """Whether there is any."""
        with self._file.reading() as connection:
            return bool(connection.scalar(select(func.count()).select_from(tables.user)))

    def all(self) -> dict[str, Role]:
        """Role of each, by name."""
        with self._file.reading() as connection:
            found = [values_of(tables.user, one) for one in connection.execute(select(tables.user))]
        return {one["name"]: one["role"] for one in found}

    def role_of(self, name: str) -> Role | None:
        """Role of a user; None: there is no such user."""
        return self.all().get(name)

    def add(self, name: str, role: Role, password: str) -> None:
        """Let somebody in from now on.

        Raises:
            InputError: there is such a user or token, or the name or the password is none.
        """
        where = f"user {name!r}"
        check_name(name, where)
        entry = with_checksum(name=name, role=role, hash=hashed(password, name))
        with self._file.writing() as connection:
            check_is_free(connection, name, where)
            connection.execute(insert(tables.user).values(**entry))

    def check_is_new(self, name: str) -> None:
        """Whether somebody of this name can be added.

        Raises:
            InputError: there is such a user or token, or this is no name.
        """
        where = f"user {name!r}"
        check_name(name, where)
        with self._file.reading() as connection:
            check_is_free(connection, name, where)

    def check_is_there(self, name: str) -> None:
        """Whether there is a user of this name.

        Raises:
            InputError: there is none.
        """
        if self.role_of(name) is None:
            raise InputError("there is no such user", f"user {name!r}", "look at its letters")

    def remove(self, name: str) -> None:
        """Let somebody in no more; open sessions end.

        Raises:
            InputError: there is no such user.
        """
        with self._file.writing() as connection:
            done = connection.execute(delete(tables.user).where(tables.user.c.name == name))
            if not done.rowcount:
                raise InputError("there is no such user", f"user {name!r}", "look at its letters")
            connection.execute(delete(tables.session).where(tables.session.c.user == name))

    def change_password(self, name: str, password: str) -> None:
        """Give a user another password; open sessions end.

        Raises:
            InputError: there is no such user, or the password is none.
        """
        kept = hashed(password, name)
        with self._file.writing() as connection:
            which = tables.user.c.name == name
            found = connection.execute(select(tables.user).where(which)).one_or_none()
            if found is None:
                raise InputError("there is no such user", f"user {name!r}", "look at its letters")
            entry = with_checksum(**values_of(tables.user, found) | {"hash": kept})
            connection.execute(update(tables.user).where(which).values(**entry))
            connection.execute(delete(tables.session).where(tables.session.c.user == name))

    def knows(self, name: str, password: str) -> bool:
        """Whether somebody is who they say, by a password."""
        with self._file.reading() as connection:
            found = connection.execute(
                select(tables.user).where(tables.user.c.name == name)
            ).one_or_none()
        kept = nobodys() if found is None else str(values_of(tables.user, found)["hash"])
        return matches(password, kept) and found is not None
