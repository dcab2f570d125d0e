"""`rga diagnose-many`: many bridges at once."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import CriteriaFile, DaskAddress, JsonTarget, OutputDirectory, Seed, Workers
from rga.errors import InputError

if TYPE_CHECKING:
    from rga.jobs.batch import Summary

ListFile = Annotated[
    Path,
    typer.Argument(
        metavar="LIST",
        help="Bridges (CSV or Parquet): name, model, record and, where wanted, import.",
    ),
]


def diagnose_many(
    bridges: ListFile,
    output: OutputDirectory,
    workers: Workers = 2,
    dask: DaskAddress = None,
    criteria: CriteriaFile = None,
    seed: Seed = 0,
    json: JsonTarget = None,
) -> None:
    """Diagnose many bridges, here or on a Dask cluster; each into DIR/NAME."""
    from dataclasses import asdict

    from rga.cli.output import write_json
    from rga.cli.progress import shown_progress
    from rga.findings.criteria import load_criteria
    from rga.jobs.batch import SUMMARY
    from rga.jobs.batch import diagnose_many as diagnose

    chosen = None if criteria is None else load_criteria(criteria)
    with shown_progress() as progress:
        summaries = diagnose(
            bridges,
            output,
            criteria=chosen,
            seed=seed,
            workers=workers,
            dask=dask,
            progress=progress,
        )
    if json is not None:
        write_json([asdict(one) for one in summaries], json)
    if json != "-":
        _show(summaries)
    if failed := sum(one.error is not None for one in summaries):
        raise InputError(
            f"{failed} of {len(summaries)} bridges could not be diagnosed",
            str(output / SUMMARY),
            "mend what stands there, and diagnose them again",
        )


def _show(summaries: "list[Summary]") -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table("bridge", "verdict", "causes", "gain")
    for one in summaries:
        gain = "" if one.gain is None else f"{one.gain:.3g}"
        cells = (one.name, one.verdict or "error", one.error or one.causes or "", gain)
        table.add_row(*(Text(cell) for cell in cells))
    Console().print(table)
