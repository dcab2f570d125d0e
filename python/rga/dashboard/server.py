"""The server of the HTTP door, within bounds that nobody outside can pass."""

import asyncio
import socket

import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol, RequestResponseCycle

from rga.errors import InputError
from rga.operation.configuration import ServiceSettings
from rga.operation.readiness import READY, tell_system

#: connections and calls at once; more are answered by 503
MOST_CALLS = 500
#: how long a connection may be idle, a call may take until its body, at most twice, and the
#: service waits for open calls as it ends [s]
IDLE, SAYING, ENDING = 30, 20.0, 3
#: bytes of what a call says before its body
MOST_HEADERS = 32 * 1024


class BoundedProtocol(H11Protocol):
    """HTTP on connections that are closed where they do not say what they want."""

    #: how often is looked whether they have said something [s]
    look = SAYING

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Wait for calls."""
        super().connection_made(transport)
        self.loop.call_later(self.look, self._close_unless_called, None)

    def _close_unless_called(self, last: RequestResponseCycle | None) -> None:
        """Close the connection where nothing was called since it was last looked at.

        Args:
            last: call that was over then.
        """
        if self.transport.is_closing():
            return
        call: RequestResponseCycle | None = self.cycle
        over = call is None or call.response_complete
        if over and call is last:
            self.transport.close()
        else:
            self.loop.call_later(self.look, self._close_unless_called, call if over else None)


class ToldServer(uvicorn.Server):
    """A server that tells the system when it answers."""

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Listen, and tell."""
        await super().startup(sockets)
        if self.started:
            tell_system(READY)


def listening_socket(settings: ServiceSettings) -> socket.socket:
    """The socket on which a service listens, from now on.

    Raises:
        InputError: there is no such address here, or another program listens there.
    """
    host, port = _address_of(settings)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    try:
        return socket.create_server((host, port), family=family)
    except OSError as error:
        words = (getattr(error, "strerror", None) or str(error)).lower()
        where = f"[service] listen = {settings.listen!r}"
        remedy = "end what listens there, or state another address"
        raise InputError(f"nothing can listen there: {words}", where, remedy) from None


def server_of(app: ASGIApp, settings: ServiceSettings) -> uvicorn.Server:
    """The server of an application.

    Args:
        app: that answers.
        settings: by which certificate it answers.

    Raises:
        InputError: a file of TLS cannot be used.
    """
    config = uvicorn.Config(
        app,
        ssl_certfile=settings.certificate,
        ssl_keyfile=settings.key,
        # Which proxy is believed is decided where the caller is asked for.
        proxy_headers=False,
        server_header=False,
        log_level="warning",
        http=BoundedProtocol,
        ws="none",
        h11_max_incomplete_event_size=MOST_HEADERS,
        limit_concurrency=MOST_CALLS,
        timeout_keep_alive=IDLE,
        timeout_graceful_shutdown=ENDING,
    )
    try:
        config.load()
    except OSError as error:
        where = f"[service] certificate = {str(settings.certificate)!r}"
        words = (error.strerror or str(error)).lower()
        raise InputError(f"TLS cannot begin: {words}", where, "give PEM files") from None
    return ToldServer(config)


def _address_of(settings: ServiceSettings) -> tuple[str, int]:
    host, _, port = settings.listen.rpartition(":")
    return host.strip("[]"), int(port)
