"""`rga benchmark`: what rga can do, measured."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from rga.cli.options import DaskAddress, JsonTarget, Seed, Workers
from rga.errors import InputError

benchmark = typer.Typer(help="Measure what rga can do.", no_args_is_help=True)

Draws = Annotated[
    int, typer.Option("-n", "--draws", min=1, help="Hidden effects; each beside its null twin.")
]
Minutes = Annotated[
    float | None, typer.Option("--minutes", min=0.0, help="Begin no further draw after these.")
]
KeptIn = Annotated[
    Path | None,
    typer.Option(
        "-o",
        "--output",
        metavar="DIR",
        help="Keeps outcomes, tables and plots; what it holds is not done again.",
    ),
]
WrittenTo = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="DIR", help="Takes the table and a figure."),
]
CaseName = Annotated[
    str | None,
    typer.Option(
        "--case", metavar="ID", help="Only draw this case, and write it to the directory."
    ),
]
Generator = Annotated[
    str,
    typer.Option(
        "--generator",
        metavar="NAME",
        help="What makes the cases: bridges, or field (other structures, welded, tared, broken).",
    ),
]
Splits = Annotated[int, typer.Option("--splits", min=1, help="Random splits of the full gap.")]
Quick = Annotated[bool, typer.Option("--quick", help="Eight draws only.")]
Shorter = Annotated[bool, typer.Option("--quick", help="Fewer rows, and less time for each.")]
Fewer = Annotated[bool, typer.Option("--quick", help="Few streams, with many false alarms.")]
Least = Annotated[bool, typer.Option("--quick", help="One split, few methods and drifts.")]
Stored = Annotated[
    str,
    typer.Option(
        "--repository",
        metavar="KIND",
        help="What level C stores: measured (rows and states) or paper (simulated rows).",
    ),
]
Fewest = Annotated[bool, typer.Option("--quick", help="18 broken records of 100 rows.")]
Broken = Annotated[int, typer.Option("-n", "--draws", min=1, help="Records with broken channels.")]
Foreign = Annotated[
    Path | None,
    typer.Option(
        "--data",
        metavar="DIR",
        help="Records of others beside the drawn ones: practice/NN, rdso45m/record_40kmh.txt.",
    ),
]
CrossingModel = Annotated[
    Path, typer.Option("--crossing", metavar="MODEL", help="Model file of the crossing in --data.")
]
Few = Annotated[bool, typer.Option("--quick", help="One short stream of each sort only.")]


@benchmark.callback()
def _benchmarks() -> None:
    """Measure what rga can do."""


@benchmark.command()
def diagnosis(
    draws: Draws = 3000,
    generator: Generator = "bridges",
    seed: Seed = 1,
    workers: Workers = 2,
    dask: DaskAddress = None,
    quick: Quick = False,
    minutes: Minutes = None,
    output: KeptIn = None,
    case: CaseName = None,
    json: JsonTarget = None,
) -> None:
    """The blind challenge: effects hidden by seed, each beside its null twin."""
    from dataclasses import asdict

    from rga.cli.output import whole_directory, whole_file, write_json
    from rga.cli.progress import shown_progress
    from rga_bench.diagnosis import design, field_design

    if case is not None:
        drawn = field_design.draw_of(case)
        if output is None:
            raise InputError("there is no place for the case", "--case", "give a directory with -o")
        with whole_directory(output) as draft:
            drawn.case().write(draft)
        typer.echo(f"{case} is in {output}.")
        return

    from rga_bench.diagnosis.figures import figures
    from rga_bench.diagnosis.plots import plot
    from rga_bench.diagnosis.run import run
    from rga_bench.diagnosis.tables import tables
    from rga_bench.ledger import versions

    if generator not in field_design.GENERATORS:
        remedy = f"give one of {', '.join(field_design.GENERATORS)}"
        raise InputError(f"there is no generator {generator!r}", "--generator", remedy)
    kind = field_design.GENERATORS[generator]
    chosen = design.draws(seed, design.QUICK if quick else draws, kind)
    with shown_progress() as progress:
        outcomes = run(
            chosen,
            folder=output,
            workers=workers,
            dask=dask,
            minutes=minutes,
            progress=lambda done: progress("blind challenge", done),
        )
    if not outcomes:
        raise InputError("no draw was finished", "--minutes", "give more of them")
    told = tables(outcomes)
    if output is not None:
        with whole_file(output / "tables.txt") as draft:
            draft.write_text(told, encoding="utf-8")
        plot(outcomes, output)
    if json is not None:
        content = {
            "seed": seed,
            "generator": generator,
            "versions": versions(),
            "figures": [{**asdict(one), "judged": one.judged} for one in figures(outcomes)],
            "outcomes": [asdict(one) for one in outcomes],
        }
        write_json(content, json)
    if json != "-":
        typer.echo(told, nl=False)


@benchmark.command()
def solver(
    quick: Shorter = False, seed: Seed = 0, output: WrittenTo = None, json: JsonTarget = None
) -> None:
    """What a simulated sample costs, beside other solvers on the same structures."""
    import os

    # CHOLMOD asks for four threads, however many are allowed, and on one core these wait for each
    # other; OpenMP reads its limit when it is loaded.
    os.environ["OMP_THREAD_LIMIT"] = "1"
    from dataclasses import asdict

    from rga.cli.measured import measured
    from rga_bench.solver import table
    from rga_bench.solver.run import SolverResult, measure
    from rga_bench.solver.setting import SolverSetting, shorter

    def draw(result: SolverResult, folder: Path) -> None:
        from rga_bench.solver.plot import plot

        plot(result, folder / "solver.png")

    setting = shorter(seed) if quick else SolverSetting(seed=seed)
    measured(
        "solver",
        _command("solver", quick, seed),
        lambda progress: measure(setting, progress),
        table,
        draw,
        asdict,
        output=output,
        json=json,
    )


@benchmark.command()
def policies(
    quick: Few = False,
    seed: Seed = 0,
    workers: Workers = 2,
    output: WrittenTo = None,
    json: JsonTarget = None,
) -> None:
    """What each policy of synchronisation costs, and what gap it leaves."""
    from dataclasses import asdict

    from rga.cli.measured import measured
    from rga_bench.machine import machine, versions
    from rga_bench.policies import table
    from rga_bench.policies.run import compare
    from rga_bench.policies.setting import PolicySetting, shorter
    from rga_bench.policies.twin_run import PolicyResult

    def draw(played: Sequence[PolicyResult], folder: Path) -> None:
        from rga_bench.policies.plot import plot

        plot(played, folder / "policies.png")

    def content(played: Sequence[PolicyResult]) -> dict[str, Any]:
        told = {"machine": machine(), "versions": versions(), "seed": seed}
        return {**told, "played": [asdict(one) for one in played]}

    setting = shorter(seed) if quick else PolicySetting(seed=seed)
    measured(
        "policies",
        _command("policies", quick, seed),
        lambda progress: compare(setting, workers=workers, progress=progress),
        table,
        draw,
        content,
        output=output,
        json=json,
    )


@benchmark.command()
def detector(
    quick: Fewer = False,
    seed: Seed = 0,
    workers: Workers = 2,
    output: WrittenTo = None,
    json: JsonTarget = None,
) -> None:
    """How soon a change is seen, at which rate of false alarms, beside the optimum."""
    from dataclasses import asdict

    from rga.cli.measured import measured
    from rga_bench.detection import table
    from rga_bench.detection.result import DetectionResult
    from rga_bench.detection.run import measure
    from rga_bench.detection.setting import DetectionSetting, shorter

    def draw(result: DetectionResult, folder: Path) -> None:
        from rga_bench.detection.plot import plot

        plot(result, folder)

    def content(result: DetectionResult) -> dict[str, Any]:
        verdicts = [{**asdict(one), "verdict": one.verdict} for one in result.judged]
        return {**asdict(result), "judged": verdicts}

    setting = shorter(seed) if quick else DetectionSetting(seed=seed)
    measured(
        "detector",
        _command("detector", quick, seed),
        lambda progress: measure(setting, workers=workers, progress=progress),
        table,
        draw,
        content,
        output=output,
        json=json,
    )


@benchmark.command()
def faults(
    draws: Broken = 340,
    quick: Fewest = False,
    data: Foreign = None,
    crossing: CrossingModel = Path("examples/rdso45m/model.json"),
    seed: Seed = 1,
    workers: Workers = 2,
    dask: DaskAddress = None,
    minutes: Minutes = None,
    output: KeptIn = None,
    json: JsonTarget = None,
) -> None:
    """What a diagnosis makes of records in which channels are broken, as loggers show it."""
    from dataclasses import asdict

    from rga.cli.measured import measured
    from rga.cli.output import write_json
    from rga_bench.faults import base, table, trial
    from rga_bench.faults.comparison import comparisons
    from rga_bench.faults.run import FaultsResult, measure

    def content(result: FaultsResult) -> dict[str, Any]:
        compared = [asdict(one) for one in comparisons(result.outcomes)]
        return {**asdict(result), "comparisons": compared}

    rows = trial.QUICK_ROWS if quick else trial.ROWS
    model = crossing if crossing.is_file() else None
    given = [] if data is None else base.foreign(data, model, rows)
    chosen = trial.trials(seed, trial.QUICK if quick else draws, rows, given)
    option = "" if quick else f" --draws {draws}"
    option += "" if data is None else " --data DIR"
    measured(
        "faults",
        _command("faults", quick, seed) + option,
        lambda progress: measure(
            chosen, folder=output, workers=workers, dask=dask, minutes=minutes, progress=progress
        ),
        table,
        lambda result, folder: write_json(content(result), str(folder / "faults.json")),
        content,
        output=output,
        json=json,
    )


@benchmark.command()
def loi(
    quick: Least = False,
    repository: Stored = "measured",
    splits: Splits = 10,
    seed: Seed = 0,
    workers: Workers = 2,
    dask: DaskAddress = None,
    output: KeptIn = None,
    json: JsonTarget = None,
) -> None:
    """Ways to infer contexts, at every level of integration: the paper's table."""
    from dataclasses import asdict, replace

    from rga.cli.measured import measured
    from rga_bench.contexts.floors import FLOORS
    from rga_bench.contexts.rows import QUICK
    from rga_bench.contexts.run import ContextsResult, measure
    from rga_bench.contexts.setting import REPOSITORIES, ContextsSetting, shorter
    from rga_bench.contexts.tables import table

    if repository not in REPOSITORIES:
        remedy = f"give one of {', '.join(REPOSITORIES)}"
        raise InputError(f"there is no repository {repository!r}", "--repository", remedy)

    def draw(result: ContextsResult, folder: Path) -> None:
        from rga_bench.contexts.tables.plot import plot

        plot(result, folder)

    setting = (
        shorter(seed, (*FLOORS, *QUICK)) if quick else ContextsSetting(seed=seed, splits=splits)
    )
    sizes = replace(setting.sizes, repository=repository)
    setting = replace(setting, sizes=sizes)
    option = "" if repository == "measured" else f" --repository {repository}"
    option += "" if quick or splits == ContextsSetting.splits else f" --splits {splits}"
    measured(
        "loi",
        _command("loi", quick, seed) + option,
        lambda progress: measure(
            setting, folder=output, workers=workers, dask=dask, progress=progress
        ),
        table,
        draw,
        asdict,
        output=output,
        json=json,
    )


def _command(name: str, quick: bool, seed: int) -> str:
    """That makes the same again."""
    return f"rga benchmark {name}{' --quick' if quick else ''} --seed {seed}"
