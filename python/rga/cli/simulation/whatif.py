"""`rga whatif`: what an added effect, or a change of contexts, does to every sensor."""

from math import isclose
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rga.cli.operation.running_service import ServiceClient, is_service
from rga.cli.options import JsonTarget, once

if TYPE_CHECKING:
    from rga.model import Effect
    from rga.simulation.whatif import WhatIf

#: share of a change below which its interval is that of an exact answer
WIDTH = 1e-3

Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="NAME=VALUE", help="A context variable, or time (s); repeatable."
    ),
]
Additions = Annotated[
    list[Path] | None,
    typer.Option("--add", metavar="EFFECT.json", help="An effect to add; repeatable."),
]


Source = Annotated[
    str,
    typer.Argument(
        metavar="MODEL|DIR",
        help="Model file, or a run (directory, or http://host:port/twin): then as its twin stands.",
    ),
]


def whatif(
    model: Source, settings: Settings = None, add: Additions = None, json: JsonTarget = None
) -> None:
    """Show every sensor before and after a change, with intervals where something is not sure.

    With --add the structure without and with the effect is compared at the same contexts, those
    that are set among them; without it, the contexts as they stand with those that are set.
    Contexts that are not set stand at mid-range, or where the twin of a run stands.
    """
    from rga.cli.output import write_json
    from rga.simulation.whatif import read_effects

    given = once(settings or [], "--set")
    effects = {name: effect for path in add or [] for name, effect in read_effects(path).items()}
    result = _answer(model, given, effects)
    for warning in result.warnings:
        typer.echo(f"warning: {warning}", err=True)
    if json is not None:
        write_json(_content(result), json)
    if json != "-":
        typer.echo(_contexts(result))
        _show(result)


def _answer(source: str, settings: dict[str, float], add: "dict[str, Effect]") -> "WhatIf":
    if is_service(source):
        return _asked(source, settings, add)
    if "://" in source or Path(source).is_dir() or Path(source).suffix == ".sqlite":
        from rga.twin import Twin

        with Twin.open(source) as twin:
            return twin.whatif(settings, add)
    from rga.model import load_model
    from rga.simulation.whatif import whatif as compare

    return compare(load_model(source), settings, add)


def _asked(source: str, settings: dict[str, float], add: "dict[str, Effect]") -> "WhatIf":
    """What a twin of a service answers."""
    import numpy as np

    from rga.simulation.whatif import WhatIf

    effects = {name: one.model_dump(mode="json", exclude_none=True) for name, one in add.items()}
    found = ServiceClient(source).post("/whatif", {"settings": settings, "add": effects})
    sensors = found["sensors"]

    def column(key: str) -> Any:
        values = [one[key] for one in sensors.values()]
        return None if None in values else np.array(values, dtype=float)

    return WhatIf(
        tuple(sensors),
        tuple(one["unit"] for one in sensors.values()),
        column("before"),
        column("after"),
        column("after_ci90"),
        column("change_ci90"),
        found["contexts_before"],
        found["contexts"],
        found["warnings"],
    )


def _content(result: "WhatIf") -> dict[str, Any]:
    sensors: dict[str, Any] = {
        name: {"unit": unit, "before": float(before), "after": float(after)}
        for name, unit, before, after in zip(
            result.sensors, result.units, result.before, result.after, strict=True
        )
    }
    for key, table in (("after_ci90", result.after_ci90), ("change_ci90", result.change_ci90)):
        if table is not None:
            for name, interval in zip(result.sensors, table.tolist(), strict=True):
                sensors[name][key] = interval
    return {
        "contexts_before": result.contexts_before,
        "contexts": result.contexts,
        "sensors": sensors,
        "warnings": result.warnings,
    }


def _contexts(result: "WhatIf") -> str:
    """At which contexts the two sides are compared."""

    def listed(contexts: dict[str, float]) -> str:
        return ", ".join(f"{name} = {value:.4g}" for name, value in contexts.items())

    if not result.contexts:
        return "No context drives the model."
    if result.contexts_before == result.contexts:
        return f"Without and with the change, at {listed(result.contexts)}."
    moved = {
        name: value
        for name, value in result.contexts.items()
        if value != result.contexts_before[name]
    }
    return f"Before: {listed(result.contexts_before)}. After: {listed(moved)}."


def _show(result: "WhatIf") -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table("sensor", "unit")
    unsure = result.change_ci90
    titles = ("before", "after", "change") + (("90 % interval",) if unsure is not None else ())
    for title in titles:
        table.add_column(title, justify="right")
    for row, name in enumerate(result.sensors):
        before, after = result.before[row], result.after[row]
        # What is left of the arithmetic's last digits is no change.
        change = after - before if not isclose(after, before, rel_tol=1e-9) else 0.0
        cells = [f"{before:.4g}", f"{after:.4g}", f"{change:+.4g}"]
        if unsure is not None:
            low, high = unsure[row]
            known = isclose(low, high, rel_tol=WIDTH)
            cells.append("-" if known else f"{low:+.3g} to {high:+.3g}")
        table.add_row(Text(name), Text(result.units[row]), *cells)
    Console().print(table)
    if unsure is not None:
        typer.echo(
            "Intervals are of what is not sure of contexts and of estimated effects; without one "
            "(-) all of these are taken as exact. What scatters as built is not in them."
        )
