"""`rga dataset`: a synthetic dataset."""

from typing import Annotated

import typer

from rga.cli.options import DaskAddress, ModelFile, OutputFile, Seed, Workers, whole

Rows = Annotated[int, typer.Option("-n", metavar="N", parser=whole(1), help="Number of rows.")]
Noise = Annotated[bool, typer.Option("--noise", help="Add the sensors' noise.")]


def dataset(
    model: ModelFile,
    rows: Rows,
    output: OutputFile,
    seed: Seed = 0,
    noise: Noise = False,
    workers: Workers = 1,
    dask: DaskAddress = None,
) -> None:
    """Draw contexts over their ranges and simulate the sensors (Parquet).

    What was interrupted goes on where it stood.
    """
    from rga.cli.progress import shown_progress
    from rga.errors import InputError
    from rga.model import load_model
    from rga.quantities import counted
    from rga.simulation.dataset import write_dataset

    if output.suffix.lower() != ".parquet":
        raise InputError("a dataset is a Parquet file", str(output), "name a .parquet file")
    structure = load_model(model)
    with shown_progress() as progress:
        write_dataset(
            structure,
            rows,
            output,
            seed=seed,
            noise=noise,
            workers=workers,
            dask=dask,
            progress=progress,
        )
    typer.echo(f"{counted(rows, 'row')} of {len(structure.sensors)} sensors are in {output}.")
