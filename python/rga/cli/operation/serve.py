"""`rga serve`: twins of structures whose readings go on arriving."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from rga.operation.configuration import Configuration

ConfigurationFile = Annotated[
    Path, typer.Argument(metavar="CONFIG", help="What is served (TOML); `rga schema serve`.")
]
Check = Annotated[
    bool, typer.Option("--check", help="Say what would go wrong, and neither serve nor write.")
]
Wait = Annotated[
    float, typer.Option(min=0.1, max=600, help="How long --check listens to the sources [s].")
]


def serve(configuration: ConfigurationFile, check: Check = False, wait: Wait = 5.0) -> None:
    """Take in what loggers send, play the twins, and show them to people and programs.

    The exit code of --check is 2 where there is an error; warnings and notes leave it 0.
    """
    from rga.operation.configuration import read_configuration

    chosen = read_configuration(configuration)
    if check:
        _check(chosen, wait)
    else:
        _serve(chosen)


def _serve(chosen: "Configuration") -> None:
    from rga.dashboard.app import app_of
    from rga.dashboard.server import server_of
    from rga.operation.service import Service

    service = Service(chosen)
    app = app_of(service, lambda: server.should_exit)
    server = server_of(app, chosen.service)
    service.start()
    scheme = "http" if chosen.service.certificate is None else "https"
    typer.echo(f"rga serves {', '.join(service.twins)} at {scheme}://{chosen.service.listen}")
    try:
        server.run()
    finally:
        service.stop()


def _check(chosen: "Configuration", wait: float) -> None:
    from rga.dashboard.door_trial import door_findings
    from rga.operation.trial.service_trial import service_findings
    from rga.quantities import counted

    found = [*door_findings(chosen.service), *service_findings(chosen, wait)]
    for one in found:
        typer.echo(str(one))
    errors = sum(one.severity == "error" for one in found)
    typer.echo(f"{counted(errors, 'error')}: mend what it says" if errors else "It can be served.")
    if errors:
        raise typer.Exit(2)
