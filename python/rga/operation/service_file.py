"""The file of a service: what it knows beside its twins, such as alarms, notices and users."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import MetaData

from rga.files import made_directory
from rga.one_writer import only_writer
from rga.twin.repository.table_file import TableFile

#: name of the file in the folder of a service
FILE_NAME = "service.sqlite"


def service_file(data: Path, metadata: MetaData) -> TableFile:
    """The file of a service, with the tables of one of its parts.

    Args:
        data: folder of the service, which is made.
        metadata: of the tables.

    Raises:
        InputError: the folder or the file cannot be written.
    """
    return TableFile(made_directory(data) / FILE_NAME, metadata)


@contextmanager
def only_service(data: Path) -> Iterator[None]:
    """Be the one service of a folder for the time of the block.

    Args:
        data: folder of the service, which is made.

    Raises:
        Held: another service is there.
        InputError: the folder cannot be written.
    """
    with only_writer(made_directory(data) / FILE_NAME, stays=True):
        yield
