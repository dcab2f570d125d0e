"""`rga free-decay`: frequencies and mode shapes after a train or truck has left."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import decimal, file_to_write

if TYPE_CHECKING:
    from rga.records.modal.free_decay import DecayingMode

Raw = Annotated[
    Path,
    typer.Argument(metavar="FILE", help="A logger's file with a reading many times a second."),
]
Highest = Annotated[
    float,
    typer.Option("--highest", metavar="HZ", parser=decimal(0.0), help="Highest frequency, in Hz."),
]
Begin = Annotated[
    float,
    typer.Option(
        "--from", metavar="S", parser=decimal(0.0), help="Seconds from the first row to its begin."
    ),
]
End = Annotated[
    float | None,
    typer.Option(
        "--until",
        metavar="S",
        parser=decimal(0.0),
        help="Seconds to its end; left out, the last row.",
    ),
]
Columns = Annotated[
    list[str] | None,
    typer.Option(
        "--column",
        metavar="NAME[=POINT]",
        help="A column that is looked at, and the point of the model at which it measures; "
        "left out, all columns. Can be repeated.",
    ),
]
Written = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        metavar="FILE",
        parser=file_to_write,
        help="Write the modes that stand out of the noise as a modal record (CSV or Parquet).",
    ),
]

#: sensors of a shape that are printed
SHOWN = 8


def told(modes: "list[DecayingMode]", columns: list[str]) -> str:
    """The modes of a decay, a line each."""
    from rga.quantities import number

    lines = ["  f [Hz]  scatter [Hz]  damping [%]  found [%]  shape"]
    for one in modes:
        parts = list(zip(columns, one.shape, strict=True))
        shape = ", ".join(f"{name} {number(float(part), 2)}" for name, part in parts[:SHOWN])
        shape += ", ..." if len(parts) > SHOWN else ""
        line = f"{one.frequency:8.3f}  {one.scatter:12.3f}  {100 * one.damping:11.2f}"
        line += f"  {100 * one.found:9.0f}  {shape}"
        lines.append(line + ("; noise may look the same" if one.in_doubt else ""))
    return "\n".join(lines)


def free_decay(
    file: Raw,
    highest: Highest,
    begin: Begin = 0.0,
    end: End = None,
    column: Columns = None,
    output: Written = None,
) -> None:
    """Print natural frequencies and mode shapes of a structure that swings freely.

    Begin where nothing moves it any more, such as a second after the last axle has left.
    """
    from rga.files import write_table
    from rga.records.modal.decay_files import decay_of, modal_table
    from rga.records.modal.free_decay import decaying_modes

    decay = decay_of(file, begin, end, column)
    found = decaying_modes(decay.motion, decay.step, highest)
    if not found:
        typer.echo("No mode is found: what is read is noise, or it does not decay.")
    else:
        typer.echo(told(found, list(decay.points)))
    clear = [one for one in found if not one.in_doubt]
    if output is not None and clear:
        write_table(modal_table(decay, clear), output)
    elif output is not None:
        typer.echo(f"Nothing stands out of the noise; {output} is not written.")
