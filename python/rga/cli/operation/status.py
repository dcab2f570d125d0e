"""`rga status`: where a run stands."""

from dataclasses import asdict
from pathlib import Path

import typer

from rga.cli.operation.replay import Place
from rga.cli.operation.running_service import ServiceClient, is_service
from rga.cli.options import JsonTarget


def status(place: Place, json: JsonTarget = None) -> None:
    """Show where a run stands: its rows, what it does next, its model version, what happened."""
    from rga.cli.output import write_json
    from rga.errors import InputError
    from rga.twin import Twin
    from rga.twin.repository.database import FILE_NAME

    if is_service(place):
        _show_served(place, json)
        return
    waiting = _waiting(place)
    if waiting and not Path(place, FILE_NAME).exists():
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


def _show_served(place: str, json: str | None) -> None:
    """Show where a twin of a service stands."""
    from rga.cli.output import write_json
    from rga.quantities import counted
    from rga.twin.status import NEXT

    client = ServiceClient(place)
    found = client.get()
    if json is not None:
        write_json(found, json)
    if json == "-":
        return
    now = found["now"]
    if now is None:
        typer.echo(f"{client.twin} waits for its first rows.")
    else:
        last = f", the last of {now['time']}" if now["time"] else ""
        causes = f" with {', '.join(now['causes'])}" if now["causes"] else ""
        typer.echo(f"{client.twin}: {counted(now['rows'], 'row')}{last}; {NEXT[now['stage']]}.")
        typer.echo(f"Model version {now['version']}{causes} is in force.")
        typer.echo(f"State: {found['state']}. {found['words']}")
        if now["undecided"] is not None:
            typer.echo(f"Undecided: proposal {now['undecided']['number']}, ", nl=False)
            typer.echo(f"{now['undecided']['words']}.")
    typer.echo(_alarms_in_words([one["state"] for one in client.get("/alarms")]))
    if found["lag"]:
        typer.echo(f"{counted(found['lag'], 'row')} wait to be played.")
    for what, words in found["faults"].items():
        typer.echo(f"{what}: {words}")


def _alarms_in_words(states: list[str]) -> str:
    """How many alarms are open, by the state of each.

    >>> _alarms_in_words(["raised", "acknowledged"]), _alarms_in_words([])
    ('2 alarms are open, 1 to acknowledge.', 'No alarm is open.')
    """
    from rga.quantities import counted

    if not states:
        return "No alarm is open."
    unseen = sum(one in ("raised", "cleared") for one in states)
    is_open = "is open" if len(states) == 1 else "are open"
    return f"{counted(len(states), 'alarm')} {is_open}, {unseen or 'none'} to acknowledge."


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
