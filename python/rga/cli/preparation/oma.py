"""`rga oma`: natural frequencies and mode shapes of a structure that wind and traffic move."""

from pathlib import Path
from typing import Annotated

import typer

from rga.cli.options import decimal, file_to_write
from rga.cli.preparation.free_decay import Begin, Columns, End, Highest, Raw

Minutes = Annotated[
    float,
    typer.Option(
        "--minutes", metavar="MIN", parser=decimal(0.0), help="Length of a window, in minutes."
    ),
]
Written = Annotated[
    Path,
    typer.Option(
        "-o",
        "--output",
        metavar="FILE",
        parser=file_to_write,
        help="Write the modal record (CSV or Parquet).",
    ),
]


def oma(
    file: Raw,
    highest: Highest,
    output: Written,
    minutes: Minutes = 10.0,
    begin: Begin = 0.0,
    end: End = None,
    column: Columns = None,
) -> None:
    """Find modes in windows of measured accelerations, by pyOMA2, and write a modal record.

    Sensors are of one kind; steps in time are even.
    """
    from rga.files import write_table
    from rga.quantities import counted
    from rga.records.modal.decay_files import decay_of
    from rga.records.modal.operational import operational_modes, operational_table, windows_of

    windows = windows_of(decay_of(file, begin, end, column), 60.0 * minutes)
    modes = [operational_modes(one.motion, one.step, highest) for one in windows]
    table = operational_table(windows, modes, file)
    write_table(table.frame, output)
    for window, own in zip(windows, modes, strict=True):
        found = ", ".join(f"{one.frequency:.3f}" for one in own)
        typer.echo(f"{window.middle}: {found or 'no mode'}{' Hz' if own else ''}")
    typer.echo(f"{counted(table.frame.height, 'mode')} found in {counted(len(windows), 'window')}.")
