"""`rga simulate`: contexts in, sensor values out."""

from pathlib import Path
from typing import Annotated

import typer

from rga.cli.options import ModelFile, OutputFile

ContextFile = Annotated[
    Path,
    typer.Argument(
        metavar="CONTEXTS",
        help="Context variables (CSV or Parquet), with time where it matters.",
    ),
]


def simulate(model: ModelFile, contexts: ContextFile, output: OutputFile) -> None:
    """Simulate the sensors for given contexts; the result is a record (CSV or Parquet)."""
    import polars as pl

    from rga.cli.output import whole_file
    from rga.errors import InputError
    from rga.files import wrong_ending
    from rga.model import load_model
    from rga.model.effect import when_all_act
    from rga.quantities import counted
    from rga.records import load_contexts
    from rga.simulation import Simulator

    suffix = output.suffix.lower()
    if suffix not in (".csv", ".parquet"):
        raise wrong_ending(output, "record", (".csv", ".parquet"))
    structure = load_model(model)
    if not structure.sensors:
        raise InputError(
            "the model has no gauges, and what is simulated would be the contexts alone",
            f"model {structure.name!r}, sensors",
            "state sensors; `rga results` gives what moves without any, `rga modes` frequencies",
        )
    given = load_contexts(contexts, structure)
    if "time" not in given.values and when_all_act(structure.effects.values()) is not None:
        typer.echo("warning: without a column time, effects that begin late do not act", err=True)
    readings = Simulator(structure).predict(given.values)
    sensors = [pl.Series(name, readings[:, k]) for k, name in enumerate(structure.sensors)]
    frame = given.frame.with_columns(sensors)
    with whole_file(output) as draft, draft.open("wb") as file:
        if suffix == ".csv":
            frame.write_csv(file)
        else:
            frame.write_parquet(file)
    typer.echo(f"{counted(frame.height, 'row')} of {len(sensors)} sensors are in {output}.")
