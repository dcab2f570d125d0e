"""`rga modes`: natural frequencies and mode shapes."""

from pathlib import Path
from typing import Annotated

import typer

from rga.cli.options import GivenContexts, JsonTarget, ModelFile, settings, whole

Count = Annotated[
    int,
    typer.Option("--count", metavar="N", parser=whole(), help="How many modes: 1 to 1000."),
]
Shapes = Annotated[
    Path | None,
    typer.Option(
        "--output", "-o", metavar="FILE", help="Write the shapes of all nodes (CSV or Parquet)."
    ),
]


def modes(
    model: ModelFile,
    count: Count = 10,
    contexts: GivenContexts = None,
    output: Shapes = None,
    json: JsonTarget = None,
) -> None:
    """Print the lowest natural frequencies, and what moves in each mode.

    The structure is that of the contexts given; without time all effects act.
    """
    from rga.cli.output import write_json
    from rga.model import load_model
    from rga.simulation import modes as modes_of

    found = modes_of(load_model(model), count, settings(contexts, "--contexts"))
    if json is not None:
        write_json(found.content(), json)
    if output is not None:
        found.write(output)
    if json == "-":
        return
    typer.echo("mode     f [Hz]   mass along x, y, z [%]   moves most")
    for line in found.to_frame().iter_rows(named=True):
        shares = " ".join(f"{100 * line[f'mass {axis}']:7.2f}" for axis in "xyz")
        most = f"{line['most at']} along {line['most along']}"
        typer.echo(f"{line['mode']:4} {line['f']:10.4f}   {shares}   {most}")
    tons = ", ".join(f"{mass / 1000:.4g}" for mass in found.mass)
    typer.echo(f"Mass that moves along x, y, z: {tons} t, that of held nodes included.")
