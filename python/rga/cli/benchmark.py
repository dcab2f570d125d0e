"""`rga benchmark`: what rga can do, measured."""

from typing import Annotated

import typer

from rga.cli.options import JsonTarget, Seed

benchmark = typer.Typer(help="Measure what rga can do.", no_args_is_help=True)

Draws = Annotated[int, typer.Option("-n", "--draws", min=1, help="Number of hidden effects.")]
Workers = Annotated[int, typer.Option("--workers", min=1, help="Processes at work.")]
Quick = Annotated[bool, typer.Option("--quick", help="Six draws only.")]
Shorter = Annotated[bool, typer.Option("--quick", help="Fewer rows, and less time for each.")]


@benchmark.callback()
def _benchmarks() -> None:
    """Measure what rga can do."""


@benchmark.command()
def diagnosis(
    draws: Draws = 60,
    seed: Seed = 1,
    workers: Workers = 2,
    quick: Quick = False,
    json: JsonTarget = None,
) -> None:
    """The blind challenge: effects hidden by seed, each beside its null twin."""
    from rga.benchmark.challenge import challenge, score
    from rga.cli.output import write_json
    from rga.cli.progress import shown_progress

    count = 6 if quick else draws
    with shown_progress() as progress:
        outcomes = challenge(
            range(seed, seed + count),
            workers,
            lambda done: progress("blind challenge", done / (2 * count)),
        )
    result = score(outcomes)
    if json is not None:
        write_json(result, json)
    if json == "-":
        return
    typer.echo(
        f"effects with d' of 15 or more: {result['found_at_15']} of {result['hidden_at_15']} found "
        f"(kind and place right, or among the rivals)"
    )
    for kind, (found, hidden) in result["by_kind"].items():
        typer.echo(f"  {kind:22} {found} of {hidden}")
    typer.echo(f"null twins with a cause: {result['nulls_with_causes']} of {result['nulls']}")
    for one in outcomes:
        if (one.named and one.kind == "null") or (one.kind in result["by_kind"] and not one.found):
            named = ", ".join(str(cause["kind"]) for cause in one.named) or "nothing"
            typer.echo(f"  seed {one.seed}, {one.kind} at d' {one.d_prime:.0f}: named {named}")


@benchmark.command()
def solver(quick: Shorter = False, json: JsonTarget = None) -> None:
    """What a simulated sample costs on one core, beside NumPy in the same run."""
    from rga.benchmark.solver import measure
    from rga.cli.output import write_json
    from rga.cli.progress import shown_progress

    with shown_progress() as progress:
        result = measure(quick, lambda done: progress("solver", done))
    if json is not None:
        write_json(result, json)
    if json == "-":
        return
    typer.echo(f"{result['machine']['processor']}, one core, batches of {result['rows']} rows;")
    typer.echo(f"memory bandwidth {result['bandwidth_GB_s']:.3g} GB/s (copy); all paths agree.")
    for figure in result["figures"]:
        line = f"  {figure['name']:48} {figure['value']:10.4g} {figure['unit']:18}"
        if figure["peer"] is not None:
            line += f" {figure['ratio']:8.3g} x {figure['peer']} ({figure['peer_value']:.4g})"
        typer.echo(line)
