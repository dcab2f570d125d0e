"""The commands of `rga`, and how their errors reach the user."""

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from importlib.metadata import entry_points
from io import TextIOWrapper
from typing import Annotated

import typer

from rga import __version__
from rga.cli.diagnosis.diagnose import diagnose
from rga.cli.diagnosis.diagnose_many import diagnose_many
from rga.cli.diagnosis.plan import plan
from rga.cli.doctor import doctor
from rga.cli.operation.decide import accept, reject, rollback
from rga.cli.operation.export import export
from rga.cli.operation.feed import feed
from rga.cli.operation.replay import replay
from rga.cli.operation.run import run
from rga.cli.operation.serve import serve
from rga.cli.operation.status import status
from rga.cli.operation.user import user
from rga.cli.preparation.check import check
from rga.cli.preparation.draw import draw
from rga.cli.preparation.example import example
from rga.cli.preparation.free_decay import free_decay
from rga.cli.preparation.import_model import import_model
from rga.cli.preparation.import_record import import_record
from rga.cli.preparation.oma import oma
from rga.cli.schema import schema
from rga.cli.simulation.dataset import dataset
from rga.cli.simulation.modes import modes
from rga.cli.simulation.results import results
from rga.cli.simulation.simulate import simulate
from rga.cli.simulation.verify import verify
from rga.cli.simulation.whatif import whatif
from rga.errors import InputError, MissingPackageError, ReportError, in_a_line
from rga.inputs import protected_inputs
from rga.lazy import needing_extras

app = typer.Typer(
    help="Find what a structure's digital twin gets wrong.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
for command in (
    example, import_model, import_record, free_decay, oma, check, draw, diagnose, diagnose_many,
    plan, run, status, replay, accept, reject, rollback, export, serve, user, feed, simulate,
    results, modes, whatif, dataset, verify, schema, doctor,
):  # fmt: skip
    app.command("import" if command is import_model else None)(command)
# Other packages, as the benchmarks in this wheel, add commands of their own.
for plugin in entry_points(group="rga.commands"):
    app.add_typer(plugin.load(), name=plugin.name)


def _show_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"rga {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    _version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show it.")
    ] = False,
) -> None:
    pass


def run_command(arguments: Sequence[str]) -> None:
    """Run a command and leave with its exit code: 0 done, 2 bad input, 1 fault.

    Args:
        arguments: as typed after `rga`.
    """
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            # Names that the terminal's encoding cannot show are told in its letters.
            stream.reconfigure(errors="backslashreplace")
    try:
        with needing_extras(), _written_out(), protected_inputs():
            app(args=_json_with_target(arguments), prog_name="rga")
    except (InputError, MissingPackageError, ReportError) as error:
        typer.echo(f"error: {_words(error)}", err=True)
        sys.exit(1 if isinstance(error, ReportError) else 2)
    except MemoryError:
        remedy = "give fewer rows or channels, or take a machine with more"
        typer.echo(f"error: there is not enough memory: {remedy}", err=True)
        sys.exit(2)
    except OSError as error:
        # What the system refuses: a name that is too long, an output that takes no more.
        reason, where = (error.strerror or "refused").lower(), error.filename
        if where is None:
            where = "the output"
            # What is left of it would be refused once more when Python ends.
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        typer.echo(f"error: {reason} ({where}): give another file or place", err=True)
        sys.exit(2)


@contextmanager
def _written_out() -> Iterator[None]:
    """What is printed within the block has reached its place behind it, or is an OSError."""
    try:
        yield
    finally:
        if sys.stdout is not None:
            sys.stdout.flush()


def _words(error: Exception) -> str:
    """One line, or the list of several mistakes."""
    return str(error) if isinstance(error, InputError) else in_a_line(str(error))


def _json_with_target(arguments: Sequence[str]) -> list[str]:
    """Arguments in which `--json` without a file has the target "-", the standard output."""
    complete: list[str] = []
    for place, argument in enumerate(arguments):
        complete.append(argument)
        following = arguments[place + 1 : place + 2]
        if argument == "--json" and (not following or following[0][:1] == "-" != following[0]):
            complete.append("-")
    return complete
