"""Who calls a service, and whether anybody may."""

import time
from getpass import getuser
from urllib.parse import urlsplit

from starlette.requests import HTTPConnection

from rga.dashboard.access import tables
from rga.dashboard.access.drawn import Clock
from rga.dashboard.access.failures import Failures
from rga.dashboard.access.login_log import LoginLog
from rga.dashboard.access.proxies import CallOrigin, is_loopback, origin_of
from rga.dashboard.access.roles import Who
from rga.dashboard.access.sessions import Sessions
from rga.dashboard.access.tokens import Tokens
from rga.dashboard.access.users import Users
from rga.errors import InputError
from rga.operation.configuration import ServiceSettings
from rga.operation.service_file import service_file

#: name of the cookie of a session
COOKIE = "rga_session"


class Access:
    """Users, sessions and tokens of a service.

    Args:
        settings: of the service.
        clock: seconds since 1970 (UTC).

    Attributes:
        users, sessions, tokens, failures, logins: in the file of the service.

    Raises:
        InputError: anybody could come in: it listens beyond this machine without users or TLS.
    """

    def __init__(self, settings: ServiceSettings, clock: Clock = time.time) -> None:
        self._settings = settings
        self._file = service_file(settings.data, tables.metadata)
        self.users = Users(self._file)
        self.sessions, self.tokens = Sessions(self._file, clock), Tokens(self._file, clock)
        self.failures, self.logins = Failures(self._file, clock), LoginLog(self._file, clock)
        self._is_local = is_loopback(settings.listen.rpartition(":")[0])
        check_is_closed(settings, self.users.exist)

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def origin_of(self, call: HTTPConnection) -> CallOrigin:
        """Where a call comes from."""
        settings = self._settings
        return origin_of(call, settings.trusted_proxies, settings.user_header)

    def who_calls(self, call: HTTPConnection) -> Who | None:
        """Who calls; None: nobody who is known."""
        scheme, _, secret = call.headers.get("authorization", "").partition(" ")
        if scheme.casefold() == "bearer":
            return self.tokens.who_has(secret.strip())
        origin = self.origin_of(call)
        if not self.users.exist:
            return self._local_person(call, origin)
        if origin.user is not None:
            role = self.users.role_of(origin.user)
            return None if role is None else Who(origin.user, role)
        user = self.sessions.user_of(call.cookies.get(COOKIE, ""))
        role = None if user is None else self.users.role_of(user)
        return None if user is None or role is None else Who(user, role, session=True)

    def _local_person(self, call: HTTPConnection, origin: CallOrigin) -> Who | None:
        """Whoever sits at this machine, as long as nobody has added users."""
        # A page of another host whose name leads here, or a proxy, would let others in.
        host = urlsplit(f"//{call.headers.get('host', '')}").hostname or ""
        if not self._is_local or origin.forwarded or not is_loopback(host):
            return None
        return Who(getuser(), "admin")

    def log_in(self, name: str, password: str, origin: CallOrigin) -> str | float:
        """Begin a session, if the password is right.

        Returns:
            The secret that the browser keeps; or how long to wait before another try [s], 0 if it
            may be at once.
        """
        wait = self.failures.begin(name, origin.address)
        if wait > 0:
            return wait
        if not self.users.knows(name, password):
            known = name if self.users.role_of(name) else None
            self.logins.write(known, origin.address, "refused")
            return 0.0
        self.failures.succeeded(name, origin.address)
        self.logins.write(name, origin.address, "in")
        return self.sessions.begin(name)

    def log_out(self, secret: str, origin: CallOrigin) -> None:
        """End a session, if it has not ended."""
        user = self.sessions.user_of(secret)
        self.sessions.end(secret)
        if user is not None:
            self.logins.write(user, origin.address, "out")


def check_is_closed(settings: ServiceSettings, has_users: bool) -> None:
    """Whether only those who may can come in.

    Raises:
        InputError: anybody could: it listens beyond this machine without users or TLS.
    """
    where = f"[service] listen = {settings.listen!r}"
    is_local = is_loopback(settings.listen.rpartition(":")[0])
    if is_local and not settings.trusted_proxies:
        return
    if not has_users:
        raise InputError(
            "others than this machine could call, and there are no users",
            where,
            "add one by `rga user CONFIG add NAME --role admin`",
        )
    if not is_local and settings.certificate is None and not settings.trusted_proxies:
        raise InputError(
            "passwords would cross the network in plain text",
            where,
            "give certificate and key, or name the proxy that has them in trusted_proxies",
        )
