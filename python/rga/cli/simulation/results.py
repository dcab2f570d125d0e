"""`rga results`: displacements, reactions, section forces and stresses."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import GivenContexts, ModelFile, OutputFile, settings, whole

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

ContextFile = Annotated[
    Path | None,
    typer.Argument(
        metavar="FILE",
        help="Context variables (CSV or Parquet), a row each, with time where it matters.",
    ),
]
Stations = Annotated[
    int,
    typer.Option(
        "--stations",
        metavar="N",
        parser=whole(),
        help="Places along each member, its ends among them: 2 to 10001.",
    ),
]


def results(
    model: ModelFile,
    output: OutputFile,
    file: ContextFile = None,
    contexts: GivenContexts = None,
    stations: Stations = 11,
) -> None:
    """Write displacements, rotations, reactions, N, V, M and stresses (CSV or Parquet).

    Contexts come from a file or from `--contexts`, or from both: what is given there stands in all
    rows of the file. Those that drive nothing may be left out.
    """
    from rga.model import load_model
    from rga.model.effect import when_all_act
    from rga.quantities import counted
    from rga.records import load_contexts
    from rga.simulation import results as results_of

    structure = load_model(model)
    of_file = load_contexts(file, structure).values if file else {}
    given: dict[str, ArrayLike] = {**of_file, **settings(contexts, "--contexts")}
    found = results_of(structure, given, stations=stations)
    found.write(output)
    begun = when_all_act(structure.effects.values())
    if begun is not None and "time" not in given:
        typer.echo("No time is given: all effects act, those too that begin late.")
    rows = counted(len(found.displacements), "row")
    typer.echo(
        f"{rows} of {len(structure.nodes)} nodes, {len(found.held)} "
        f"reactions and {len(structure.members)} members at {stations} stations are in {output}."
    )
    worst = found.members().drop_nulls("utilisation").sort("utilisation", descending=True)
    if len(worst):
        first = worst.row(0, named=True)
        typer.echo(
            f"The most used member is {first['member']}: {first['utilisation']:.0%} of its yield "
            f"strength, {first['stress min'] / 1e6:.4g} to {first['stress max'] / 1e6:.4g} MPa. "
            "Buckling is not looked at."
        )
