"""`rga serve`: twins of structures whose readings go on arriving."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.lazy import importing_much

if TYPE_CHECKING:
    from socket import socket

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
    with importing_much():
        from rga.dashboard.server import listening_socket
        from rga.operation.configuration import read_configuration
        from rga.operation.service_file import only_service

    chosen = read_configuration(configuration)
    if check:
        _check(chosen, wait)
        return
    with only_service(chosen.service.data), listening_socket(chosen.service) as listening:
        _serve(chosen, listening)


def _serve(chosen: "Configuration", listening: "socket") -> None:
    """Run a service until somebody ends it."""
    with importing_much():
        from rga.dashboard.app import app_of
        from rga.dashboard.server import server_of
        from rga.operation.service import Service

    service = Service(chosen, said=lambda line: typer.echo(line, err=True))
    app = app_of(service, lambda: server.should_exit)
    server = server_of(app, chosen.service)
    service.start()
    twins = [f"{name} ({', '.join(one.source_names)})" for name, one in service.twins.items()]
    scheme = "http" if chosen.service.certificate is None else "https"
    typer.echo(f"rga listens at {scheme}://{chosen.service.listen} and serves {', '.join(twins)}")
    try:
        server.run([listening])
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
