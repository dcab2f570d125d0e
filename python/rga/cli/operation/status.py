"""`rga status`: where a run stands."""

from dataclasses import asdict

import typer

from rga.cli.operation.replay import Place
from rga.cli.options import JsonTarget


def status(place: Place, json: JsonTarget = None) -> None:
    """Show where a run stands: its rows, what it does next, its model version, what happened."""
    from rga.cli.output import write_json
    from rga.twin import Twin

    with Twin.open(place) as twin:
        found = twin.status()
    if json is not None:
        write_json(asdict(found), json)
    if json == "-":
        return
    typer.echo(found.words())
