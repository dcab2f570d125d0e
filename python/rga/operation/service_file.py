"""The file of a service: what it knows beside its twins, such as alarms, notices and users."""

from pathlib import Path

from sqlalchemy import MetaData

from rga.files import made_directory
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
