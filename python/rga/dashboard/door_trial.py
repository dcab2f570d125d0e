"""What would go wrong with the door of a service: its address, its certificate, who may come in."""

from collections.abc import Iterator

from sqlalchemy import inspect
from starlette.types import Receive, Scope, Send

from rga.checking.finding import Finding, refused
from rga.dashboard.access import tables
from rga.dashboard.access.access import check_is_closed
from rga.dashboard.access.users import Users
from rga.dashboard.server import listening_socket, server_of
from rga.errors import InputError
from rga.operation.configuration import ServiceSettings
from rga.operation.service_file import FILE_NAME
from rga.twin.repository.table_file import TableFile


def door_findings(settings: ServiceSettings) -> Iterator[Finding]:
    """Look at the door; nothing is written, and nobody is answered.

    Args:
        settings: of the service.
    """
    for tried in (_is_closed, _has_certificate, _can_listen):
        try:
            tried(settings)
        except InputError as error:
            yield from refused(error)


def _is_closed(settings: ServiceSettings) -> None:
    check_is_closed(settings, _has_users(settings))


def _has_certificate(settings: ServiceSettings) -> None:
    server_of(_nobody, settings)


def _can_listen(settings: ServiceSettings) -> None:
    listening_socket(settings).close()


def _has_users(settings: ServiceSettings) -> bool:
    path = settings.data / FILE_NAME
    if not path.is_file():
        return False
    with TableFile(path, tables.metadata, read_only=True) as file:
        with file.reading() as connection:
            if not inspect(connection).has_table(tables.user.name):
                return False
        return Users(file).exist


async def _nobody(scope: Scope, receive: Receive, send: Send) -> None:
    """An application that is never called."""
