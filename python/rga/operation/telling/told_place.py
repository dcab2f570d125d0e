"""Up to where a broker was told of a twin, kept in the file of the service."""

from dataclasses import asdict, dataclass

from sqlalchemy import MetaData, Table, delete, insert, select

from rga.twin.repository.checksum import with_checksum
from rga.twin.repository.columns import checksum, large_number, text
from rga.twin.repository.table_file import TableFile, values_of

#: of a twin that has not begun
NO_RUN = ""
metadata = MetaData()
# Of each source that is a broker: a step of the run, rows, and a change of an alarm.
told = Table(
    "told",
    metadata,
    text("twin", key=True),
    text("source", key=True),
    text("run"),
    large_number("step"),
    large_number("rows"),
    large_number("change"),
    checksum(),
)


@dataclass(frozen=True)
class ToldPlace:
    """Up to where was told.

    Attributes:
        run: key of the run; NO_RUN: none had begun.
        step: of it.
        rows: that have a gap.
        change: number of the newest change of an alarm.
    """

    run: str
    step: int
    rows: int
    change: int


class ToldPlaces:
    """Up to where one broker was told of one twin.

    Args:
        file: of the service.
        twin, source: names.

    Raises:
        InputError: the file cannot be written.
    """

    def __init__(self, file: TableFile, twin: str, source: str) -> None:
        self._file, self._names = file, {"twin": twin, "source": source}
        self._own = (told.c.twin == twin) & (told.c.source == source)
        with file.writing() as connection:
            metadata.create_all(connection)

    def last(self) -> ToldPlace | None:
        """The place that was kept; None: nothing was told before.

        Raises:
            InputError: the file cannot be read.
        """
        with self._file.reading() as connection:
            entry = connection.execute(select(told).where(self._own)).one_or_none()
            if entry is None:
                return None
            values = values_of(told, entry)
        return ToldPlace(**{name: values[name] for name in values if name not in self._names})

    def keep(self, place: ToldPlace) -> None:
        """Keep a place, instead of the one before.

        Raises:
            InputError: the file cannot be written.
        """
        with self._file.writing() as connection:
            connection.execute(delete(told).where(self._own))
            connection.execute(insert(told).values(**with_checksum(**self._names, **asdict(place))))
