"""What would go wrong with the door of a service: its address, its certificate, who may come in."""

import errno
import socket
from collections.abc import Iterator

from sqlalchemy import inspect
from starlette.types import Receive, Scope, Send

from rga.checking.finding import Finding, refused
from rga.dashboard.access import tables
from rga.dashboard.access.access import check_is_closed
from rga.dashboard.access.users import Users
from rga.dashboard.server import server_of
from rga.errors import InputError
from rga.operation.configuration import ServiceSettings
from rga.operation.service_file import FILE_NAME
from rga.twin.repository.table_file import TableFile


def door_findings(settings: ServiceSettings) -> Iterator[Finding]:
    """Look at the door; nothing is written, and nobody is answered.

    Args:
        settings: of the service.
    """
    try:
        check_is_closed(settings, _has_users(settings))
        server_of(_nobody, settings)
    except InputError as error:
        yield from refused(error)
    if (why := _taken(settings.listen)) is not None:
        where = f"[service] listen = {settings.listen!r}"
        remedy = "end what listens there (perhaps this service itself), or choose another address"
        yield Finding("error", where, why, remedy)


def _has_users(settings: ServiceSettings) -> bool:
    path = settings.data / FILE_NAME
    if not path.is_file():
        return False
    with TableFile(path, tables.metadata, read_only=True) as file:
        with file.reading() as connection:
            if not inspect(connection).has_table(tables.user.name):
                return False
        return Users(file).exist


def _taken(listen: str) -> str | None:
    """Why a service cannot listen at an address; None: it can."""
    host, _, port = listen.rpartition(":")
    try:
        found = socket.getaddrinfo(
            host.strip("[]"), int(port), type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )
        family, kind, protocol, _, address = found[0]
        with socket.socket(family, kind, protocol) as tried:
            # As the server does: a port that was let go of a moment ago is free.
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            tried.bind(address)
            tried.listen(1)
    except (OSError, OverflowError) as error:
        if isinstance(error, OSError) and error.errno == errno.EADDRINUSE:
            return "the port is taken"
        return f"nobody can listen there: {getattr(error, 'strerror', None) or error}"
    return None


async def _nobody(scope: Scope, receive: Receive, send: Send) -> None:
    """An application that is never called."""
