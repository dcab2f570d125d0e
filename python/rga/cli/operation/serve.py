"""`rga serve`: twins of structures whose readings go on arriving."""

from pathlib import Path
from typing import Annotated

import typer

ConfigurationFile = Annotated[
    Path, typer.Argument(metavar="CONFIG", help="What is served (TOML); `rga schema serve`.")
]


def serve(configuration: ConfigurationFile) -> None:
    """Take in what loggers send, play the twins, and show them to people and programs."""
    from rga.dashboard.app import app_of
    from rga.dashboard.server import server_of
    from rga.operation.configuration import read_configuration
    from rga.operation.service import Service

    chosen = read_configuration(configuration)
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
