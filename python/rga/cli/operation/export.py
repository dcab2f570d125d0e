"""`rga export`: the rows of a run as a record."""

from pathlib import Path
from typing import Annotated

import typer

from rga.cli.operation.replay import Place

RecordFile = Annotated[
    Path, typer.Option("-o", "--output", metavar="FILE", help="Record (CSV or Parquet).")
]


def export(place: Place, output: RecordFile = Path("record.csv")) -> None:
    """Write the rows that a run has taken in as a record, which `rga run` reads again."""
    from rga.quantities import counted
    from rga.twin import Twin

    with Twin.open(place) as twin:
        record, gone = twin.record, twin.forgotten
    record.write(output)
    contexts = f" and {len(record.contexts)} contexts" if record.contexts else ""
    if gone:
        count, last = sum(end + 1 - first for first, end in gone), gone[-1][1]
        words = f"warning: readings of {count} rows from {gone[0][0]} to {last} are forgotten"
        typer.echo(words, err=True)
    typer.echo(
        f"{counted(len(record), 'row')} of {len(record.sensors)} sensors{contexts} are in {output}."
    )
