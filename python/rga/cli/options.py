"""Arguments and options that several commands share."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, TypeVar

import typer

from rga.errors import InputError
from rga.files import as_file
from rga.quantities import plain

Number = TypeVar("Number", int, float)


def whole(least: int | None = None, most: int | None = None) -> Callable[[str | int], int]:
    """What reads a whole number of an option, within bounds.

    >>> whole(1)("10")
    10
    """
    return _reading(int, "whole number", least, most)


def decimal(least: float | None = None) -> Callable[[str | float], float]:
    """What reads a number of an option, from a bound on.

    >>> decimal()("2.5")
    2.5
    """
    return _reading(float, "number", least, None)


def _reading(
    kind: Callable[[str], Number], words: str, least: float | None, most: float | None
) -> Callable[[str | Number], Number]:
    def read(given: str | Number) -> Number:
        try:
            number = kind(plain(str(given)))
        except ValueError:
            raise typer.BadParameter(f"{given!r} is no {words}") from None
        if least is not None and not number >= least:
            raise typer.BadParameter(f"{given} is less than {least}")
        if most is not None and not number <= most:
            raise typer.BadParameter(f"{given} is more than {most}")
        return number

    return read


def file_to_write(given: str | Path) -> Path:
    """The file of an option that something is written to.

    >>> file_to_write("plan.json").name
    'plan.json'
    """
    try:
        return as_file(given)
    except InputError as error:
        raise typer.BadParameter(f"{error.what}: {error.remedy}") from None


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
RecordFilesIfAny = Annotated[
    list[Path] | None,
    typer.Argument(
        metavar="[RECORD...]",
        help="Record: a logger's file, several in time, or a folder with import.toml.",
    ),
]
ModalFile = Annotated[
    Path | None,
    typer.Option(
        "--modal",
        metavar="FILE",
        help="Natural frequencies and mode shapes in windows of time, beside a record or alone.",
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
    Path,
    typer.Option(
        "-o", "--output", metavar="FILE", parser=file_to_write, help="File for the result."
    ),
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
    int,
    typer.Option(
        "--workers", metavar="N", parser=whole(1), help="Processes at work on this machine."
    ),
]
DaskAddress = Annotated[
    str | None,
    typer.Option(
        "--dask",
        metavar="ADDRESS",
        help="Scheduler of a Dask cluster, whose workers do the work instead.",
    ),
]
Seed = Annotated[
    int, typer.Option("--seed", metavar="N", parser=whole(0), help="Seed of all that is random.")
]


def setting(text: str, option: str) -> tuple[str, float]:
    """A name with its number, as NAME=VALUE; a time may be a date.

    Raises:
        InputError: no number is given.

    >>> setting("temperature=35", "--set")
    ('temperature', 35.0)
    """
    name, _, value = text.rpartition("=")
    try:
        plain(value)
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
        InputError: one gives no number, or a name has two.

    >>> settings(["snow=2, air=0", "wind=3"], "--contexts")
    {'snow': 2.0, 'air': 0.0, 'wind': 3.0}
    """
    return once([pair for text in texts or [] for pair in text.split(",") if pair.strip()], option)


def once(texts: Sequence[str], option: str) -> dict[str, float]:
    """Names with their numbers, of texts as NAME=VALUE.

    Raises:
        InputError: one gives no number, or a name has two.
    """
    given: dict[str, float] = {}
    for text in texts:
        name, value = setting(text, option)
        if name in given:
            raise InputError(f"{name!r} is set twice", option, "set it once")
        given[name] = value
    return given
