"""`rga whatif`: what a change does to every sensor."""

from math import isclose
from pathlib import Path
from typing import Annotated

import typer

from rga.cli.options import JsonTarget, ModelFile
from rga.errors import InputError

Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="NAME=VALUE", help="A context variable, or time [s]; repeatable."
    ),
]
Additions = Annotated[
    list[Path] | None,
    typer.Option("--add", metavar="EFFECT.json", help="An effect to add; repeatable."),
]


def whatif(
    model: ModelFile, settings: Settings = None, add: Additions = None, json: JsonTarget = None
) -> None:
    """Show every sensor before and after a change; contexts not set stand at mid-range."""
    from rich.console import Console
    from rich.table import Table

    from rga.cli.output import write_json
    from rga.model import load_model
    from rga.simulation.whatif import read_effects, whatif

    given = dict(_setting(text) for text in settings or [])
    effects = {name: effect for path in add or [] for name, effect in read_effects(path).items()}
    result = whatif(load_model(model), given, effects)
    for warning in result.warnings:
        typer.echo(f"warning: {warning}", err=True)
    rows = list(zip(result.sensors, result.units, result.before, result.after, strict=True))
    if json is not None:
        sensors = {
            name: {"unit": unit, "before": float(before), "after": float(after)}
            for name, unit, before, after in rows
        }
        content = {"contexts": result.contexts, "sensors": sensors, "warnings": result.warnings}
        write_json(content, json)
    if json == "-":
        return
    table = Table("sensor", "unit")
    for title in ("before", "after", "change"):
        table.add_column(title, justify="right")
    for name, unit, before, after in rows:
        # What is left of the arithmetic's last digits is no change.
        change = after - before if not isclose(after, before, rel_tol=1e-9) else 0.0
        table.add_row(name, unit, f"{before:.4g}", f"{after:.4g}", f"{change:+.4g}")
    Console().print(table)


def _setting(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return name.strip(), float(value)
    except ValueError:
        raise InputError(
            f"{text!r} sets no number", "--set", "write --set name=value, such as temperature=35"
        ) from None
