"""`rga accept`, `rga reject` and `rga rollback`: what people decide about a twin."""

from getpass import getuser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.operation.replay import Place
from rga.cli.operation.running_service import ServiceClient, is_service
from rga.cli.options import whole

if TYPE_CHECKING:
    from rga.twin.commands.command import AnyCommand

VersionNumber = Annotated[
    int,
    typer.Option("--to", metavar="N", parser=whole(1), help="Model version to put in force again."),
]
Number = Annotated[
    int | None,
    typer.Option(
        "--proposal", metavar="N", parser=whole(1), help="Its number; the last by default."
    ),
]
Who = Annotated[str | None, typer.Option("--who", help="Who decides; the user by default.")]
Why = Annotated[str, typer.Option("--why", help="Why, for the log.")]


def accept(place: Place, proposal: Number = None, who: Who = None, why: Why = "") -> None:
    """Let what a diagnosis proposed (setting adopt = "ask") become a version of the twin."""
    from rga.twin import Accept

    _carry_out(place, Accept(who=who or getuser(), why=why, proposal=proposal))


def reject(place: Place, proposal: Number = None, who: Who = None, why: Why = "") -> None:
    """Leave the twin as it is, whatever a diagnosis proposed."""
    from rga.twin import Reject

    _carry_out(place, Reject(who=who or getuser(), why=why, proposal=proposal))


def rollback(place: Place, to: VersionNumber, who: Who = None, why: Why = "") -> None:
    """Put an earlier model version of the twin in force again."""
    from rga.twin import Rollback

    _carry_out(place, Rollback(who=who or getuser(), why=why, version=to))


def _carry_out(place: str, command: "AnyCommand") -> None:
    from rga.twin import carry_out

    if is_service(place):
        # Who asks is whoever the service lets in.
        sent = command.model_dump(mode="json", exclude={"who", "given_at"}, exclude_none=True)
        if not sent["why"]:
            del sent["why"]
        outcome = ServiceClient(place).outcome_of(sent)
    else:
        outcome = carry_out(place if "://" in place else Path(place), command)
    typer.echo(f"{outcome[0].upper()}{outcome[1:]}.")
