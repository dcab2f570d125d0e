"""`rga plan`: the sensors and load tests that would separate rival explanations."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import JsonTarget, ModelFile, Seed, file_to_write, whole

if TYPE_CHECKING:
    from rga.planning.result import Plan, Telling

FindingsFile = Annotated[
    Path,
    typer.Argument(metavar="FINDINGS", help="findings.json of a diagnosis, or its directory."),
]
Sensors = Annotated[
    int,
    typer.Option("--sensors", metavar="N", parser=whole(), help="Sensors to add, at most."),
]
Positions = Annotated[
    int,
    typer.Option(
        "--positions",
        metavar="N",
        parser=whole(),
        help="Tests, at most: truck positions, set contexts, windows of modes.",
    ),
]
TruckText = Annotated[
    str | None,
    typer.Option(
        "--truck",
        metavar="LOADS@SPACINGS",
        help="Axle loads (kN) and spacings (m), such as 60,100@3.5.",
    ),
]
Paths = Annotated[
    list[str] | None,
    typer.Option("--path", metavar="NODE,NODE,...", help="Where the truck drives; repeatable."),
]
#: chance from which on a measurement by itself is said to tell two explanations apart
LIKELY = 0.5
PlanFile = Annotated[
    Path | None,
    typer.Option(
        "-o", "--output", metavar="FILE", parser=file_to_write, help="File for the plan (JSON)."
    ),
]


def plan(
    model: ModelFile,
    findings: FindingsFile,
    sensors: Sensors = 2,
    positions: Positions = 3,
    truck: TruckText = None,
    path: Paths = None,
    output: PlanFile = None,
    seed: Seed = 0,
    json: JsonTarget = None,
) -> None:
    """Choose the sensors, load tests and modes that best separate a cause from its rivals."""
    from rga.cli.output import check_targets, write_json
    from rga.cli.progress import shown_progress
    from rga.model import load_model

    structure = load_model(model)
    from rga.findings.load import load_findings
    from rga.planning.planner import plan as choose

    read = load_findings(findings)
    check_targets(json, None if output is None else str(output))
    paths = [[node.strip() for node in one.split(",")] for one in path or []]
    with shown_progress() as progress:
        result = choose(
            structure,
            read,
            sensors=sensors,
            positions=positions,
            truck=truck,
            paths=paths,
            seed=seed,
            progress=progress,
        )
    content = result.model_dump(mode="json")
    if output is not None:
        write_json(content, str(output))
    if json is not None:
        write_json(content, json)
    if json != "-":
        _show(result)


def _show(result: "Plan") -> None:
    from rich.console import Console
    from rich.table import Table

    for warning in result.warnings:
        typer.echo(f"warning: {warning}", err=True)
    letters = _letters(result)
    for words, letter in letters.items():
        typer.echo(f"{letter}: {words}")
    if result.truck is not None:
        loads = ", ".join(f"{load:g}" for load in result.truck.loads)
        spacings = ", ".join(f"{spacing:g}" for spacing in result.truck.spacings) or "none"
        paths = "; ".join(f"{path[0]} to {path[-1]}" for path in result.truck.paths)
        what = "Truck: axles of" if result.truck.driven else "Known weights of"
        typer.echo(f"{what} {loads} kN, spacings {spacings} m, shared by the paths {paths}.")
    for number, sensor in enumerate(result.sensors, 1):
        noise = f"{sensor.noise:.3g} {sensor.unit}"
        typer.echo(f"\nSensor {number}: measure {sensor.words} (noise {noise})")
        _show_readings(sensor.tells, letters)
    for number, test in enumerate(result.tests, 1):
        typer.echo(f"\nTest {number}: {test.words}")
        _show_readings(test.tells, letters)
    if result.separations:
        table = Table(
            "apart", "by the record", "d_perp", "expected", "simulated", "d_perp with everything"
        )
        for one in result.separations:
            share = f"{100 * one.simulated.clearly:.0f} % of {one.simulated.draws}"
            both = f"{letters[one.one]} and {letters[one.other]}"
            expected = f"{100 * one.expected:.0f} %"
            record = "" if one.log_odds is None else f"{one.log_odds:.0f} log-odds"
            cells = (record, f"{one.d_perp:.3g}", expected, share, f"{one.d_perp_at_best:.3g}")
            table.add_row(both, *cells)
        Console().print(table)
    if result.ranked:
        table = Table("best of its kind, by itself", "cost", "tells apart (d_perp)")
        for measurement in result.ranked:
            told = [
                f"{letters[pair.one]} and {letters[pair.other]} ({distance:.2g})"
                for pair, distance, chance in zip(
                    result.separations, measurement.d_perp, measurement.expected, strict=True
                )
                if chance >= LIKELY
            ]
            words = f"{measurement.kind}: {measurement.words}"
            table.add_row(words, f"{measurement.cost:g}", ", ".join(told) or "nothing")
        Console().print(table)
    typer.echo(result.sentence)


def _letters(result: "Plan") -> dict[str, str]:
    """A letter for each explanation: A is what the findings name."""
    words = dict.fromkeys(words for one in result.separations for words in (one.one, one.other))
    return {one: chr(ord("A") + number) for number, one in enumerate(words)}


def _show_readings(tells: "list[Telling]", letters: dict[str, str]) -> None:
    for telling in tells:
        typer.echo(f"  {telling.sensor} [{telling.unit}], {telling.change}:")
        for says in telling.says:
            low, high = says.ci90
            value = f"{says.value:+.3g} ({low:+.3g} to {high:+.3g})"
            typer.echo(f"    {letters[says.explanation]}: {value}")
