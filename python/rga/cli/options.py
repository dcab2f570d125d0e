"""Arguments and options that several commands share."""

from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from rga.errors import InputError

ModelFile = Annotated[
    Path, typer.Argument(metavar="MODEL", help="Model file (JSON, TOML or YAML).")
]
RecordFiles = Annotated[
    list[Path],
    typer.Argument(
        metavar="RECORD...",
        help="Record: a logger's file, several in time, or a folder with import.toml.",
    ),
]
MappingFile = Annotated[
    Path | None,
    typer.Option(
        "--import",
        metavar="FILE",
        help="How to read the record; left out, import.toml beside it, else beside the model.",
    ),
]
CriteriaFile = Annotated[
    Path | None,
    typer.Option(
        "--criteria",
        metavar="FILE",
        help="What decides a verdict, where not the default (JSON or TOML); `rga schema criteria`.",
    ),
]
OutputDirectory = Annotated[
    Path, typer.Option("-o", "--output", metavar="DIR", help="Directory for the results.")
]
OutputFile = Annotated[
    Path, typer.Option("-o", "--output", metavar="FILE", help="File for the result.")
]
JsonTarget = Annotated[
    str | None,
    typer.Option(
        "--json", metavar="[FILE]", help="Write the result as JSON; without FILE to the output."
    ),
]
PrintPdf = Annotated[
    bool,
    typer.Option(
        "--pdf", help="Write report.pdf too: by a browser that is installed, else WeasyPrint."
    ),
]
GivenContexts = Annotated[
    list[str] | None,
    typer.Option(
        "--contexts",
        metavar="NAME=VALUE,...",
        help="Values of context variables, and of time; repeatable.",
    ),
]
Workers = Annotated[
    int, typer.Option("--workers", min=1, help="Processes at work on this machine.")
]
DaskAddress = Annotated[
    str | None,
    typer.Option(
        "--dask",
        metavar="ADDRESS",
        help="Scheduler of a Dask cluster, whose workers do the work instead.",
    ),
]
Seed = Annotated[int, typer.Option("--seed", min=0, help="Seed of all that is random.")]


def setting(text: str, option: str) -> tuple[str, float]:
    """A name with its number, as NAME=VALUE; a time may be a date.

    Raises:
        InputError: no number is given.

    >>> setting("temperature=35", "--set")
    ('temperature', 35.0)
    """
    name, _, value = text.rpartition("=")
    try:
        if name.strip() == "time":
            from rga.model.effect import seconds

            with suppress(ValueError):
                return "time", float(value)
            return "time", seconds(value.strip())
        return name.strip(), float(value)
    except ValueError:
        raise InputError(
            f"{text!r} sets no number", option, f"write {option} name=value, such as temperature=35"
        ) from None


def settings(texts: list[str] | None, option: str) -> dict[str, float]:
    """Names with their numbers, of texts as NAME=VALUE,NAME=VALUE.

    Raises:
        InputError: one gives no number.

    >>> settings(["snow=2, air=0", "wind=3"], "--contexts")
    {'snow': 2.0, 'air': 0.0, 'wind': 3.0}
    """
    pairs = [pair for text in texts or [] for pair in text.split(",") if pair.strip()]
    return dict(setting(pair, option) for pair in pairs)
