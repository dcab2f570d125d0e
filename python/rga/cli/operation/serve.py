"""`rga serve`: twins of structures whose readings go on arriving."""

from pathlib import Path
from typing import Annotated

import typer

ConfigurationFile = Annotated[
    Path, typer.Argument(metavar="CONFIG", help="What is served (TOML); `rga schema serve`.")
]


def serve(configuration: ConfigurationFile) -> None:
    """Take in what loggers send, play the twins, and show them to people and programs."""
    import uvicorn

    from rga.dashboard.app import app_of
    from rga.operation.configuration import read_configuration
    from rga.operation.service import Service

    chosen = read_configuration(configuration)
    host, _, port = chosen.service.listen.rpartition(":")
    service = Service(chosen)
    service.start()
    typer.echo(f"rga serves {', '.join(service.twins)} at http://{chosen.service.listen}")
    try:
        uvicorn.run(app_of(service), host=host.strip("[]"), port=int(port), log_level="warning")
    finally:
        service.stop()
