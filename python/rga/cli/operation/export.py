"""`rga export`: the rows of a run as a record."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.operation.running_service import ServiceClient, is_service
from rga.cli.options import file_to_write

if TYPE_CHECKING:
    from rga.errors import InputError

Place = Annotated[
    str, typer.Argument(metavar="DIR", help="Directory of a run, or a database by URL.")
]
RecordFile = Annotated[
    Path,
    typer.Option(
        "-o", "--output", metavar="FILE", parser=file_to_write, help="Record (CSV or Parquet)."
    ),
]


def export(place: Place, output: RecordFile = Path("record.csv")) -> None:
    """Write the rows that a run has taken in as a record, which `rga run` reads again."""
    from rga.quantities import counted
    from rga.twin.repository import Repository
    from rga.twin.repository.faults import Damaged
    from rga.twin.restore import standing_of, whole_record

    if is_service(place):
        raise _not_of_a_service(place)
    _check_has_rows(Path(place))
    with Repository.open(place, read_only=True) as repository:
        view = repository.latest()
        record, damaged = whole_record(view)
        gone: tuple[tuple[int, int], ...] = ()
        try:
            gone = standing_of(view).forgotten_rows
        except Damaged as error:
            typer.echo(f"warning: {error}", err=True)
    record.write(output)
    contexts = f" and {len(record.contexts)} contexts" if record.contexts else ""
    if gone:
        count, last = sum(behind - first for first, behind in gone), gone[-1][1] - 1
        words = f"warning: readings of {count} rows from {gone[0][0]} to {last} are forgotten"
        typer.echo(words, err=True)
    if damaged:
        which = ", ".join(f"{first} to {last}" for first, last in damaged)
        typer.echo(f"warning: rows {which} are damaged and left out", err=True)
    typer.echo(
        f"{counted(len(record), 'row')} of {len(record.sensors)} sensors{contexts} are in {output}."
    )


def _check_has_rows(place: Path) -> None:
    """Whether the twin of a directory, if a live one is there, has taken in rows.

    Raises:
        InputError: it has none yet.
    """
    from rga.errors import InputError
    from rga.twin.hardware.inbox import INBOX
    from rga.twin.repository.database import FILE_NAME

    if (place / INBOX).is_file() and not (place / FILE_NAME).is_file():
        what = "the twin has no rows yet"
        raise InputError(what, str(place), "wait until it has taken in its first packet")


def _not_of_a_service(place: str) -> "InputError":
    """A service shows rows as they are looked at: contexts that were measured are not among them.

    Raises:
        InputError: the address names no twin.
    """
    from rga.errors import InputError

    name = ServiceClient(place).twin
    return InputError(
        "a service that runs gives no record",
        place,
        f"name the directory of the twin on its machine, [service] data and {name}, or the URL of "
        f"its database; programs read /api/v1/twins/{name}/series",
    )
