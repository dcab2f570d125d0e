"""`rga status`: where a run stands."""

from dataclasses import asdict
from pathlib import Path

import typer

from rga.cli.operation.replay import Place
from rga.cli.options import JsonTarget


def status(place: Place, json: JsonTarget = None) -> None:
    """Show where a run stands: its rows, what it does next, its model version, what happened."""
    from rga.cli.output import write_json
    from rga.errors import InputError
    from rga.jobs.run import FILE
    from rga.twin import Twin

    waiting = _waiting(place)
    if waiting and not Path(place, FILE).exists():
        remedy = "play it, or name the URL of its repository"
        raise InputError("no twin has been played here", place, remedy)
    with Twin.open(place) as twin:
        found = twin.status()
    if json is not None:
        write_json(asdict(found), json)
    if json == "-":
        return
    typer.echo(found.words())
    if waiting:
        typer.echo(waiting)


def _waiting(place: str) -> str:
    """What waits for a twin that goes on, in words; nothing does elsewhere."""
    from rga.errors import InputError
    from rga.jobs.live import LiveTwin
    from rga.quantities import counted
    from rga.twin.hardware.inbox import INBOX
    from rga.twin.repository.faults import Damaged

    if not Path(place, INBOX).is_file():
        return ""
    try:
        with LiveTwin(place) as twin:
            rows, commands = twin.waiting
    except Damaged:
        raise
    except InputError:
        # Where nothing can be written nothing is played, and what was can be shown all the same.
        return ""
    if not rows and not commands:
        return ""
    return f"{counted(rows, 'row')} and {counted(commands, 'command')} wait to be played."
