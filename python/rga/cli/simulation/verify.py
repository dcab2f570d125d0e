"""`rga verify`: finite-element verification cases."""

from pathlib import Path
from typing import Annotated

import typer

from rga.cli.options import JsonTarget
from rga.errors import InputError

Cases = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of verification cases.")]


def verify(cases: Cases, json: JsonTarget = None) -> None:
    """Run the verification cases of a folder; exit code 1 if any fails, 2 if one is no case."""
    from dataclasses import asdict
    from math import isfinite

    from rga.cli.output import write_json
    from rga.simulation.verification import verify_folder

    if not any(cases.glob("*.json")):
        raise InputError("there are no cases", str(cases), "name a folder of case files (.json)")
    results = verify_folder(cases)
    passed = sum(result.passed for result in results)
    if json is not None:
        rows = [
            {**asdict(result), "worst": result.worst if isfinite(result.worst) else None}
            for result in results
        ]
        write_json({"passed": passed == len(results), "cases": rows}, json)
    if json != "-":
        for result in results:
            verdict = "passed" if result.passed else f"FAILED: {result.first_failure}"
            typer.echo(f"{result.name}: {verdict} ({result.count} values)")
        typer.echo(f"{passed} of {len(results)} cases passed.")
    if not all(result.readable for result in results):
        raise typer.Exit(2)
    if passed < len(results):
        raise typer.Exit(1)
