"""`rga benchmark`: what rga can do, measured."""

import os
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from inspect import Parameter, Signature, signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Protocol, TypeVar

import typer

from rga.cli.options import DaskAddress, JsonTarget, Seed, Workers, decimal, whole
from rga.cli.output import whole_directory, write_json
from rga.cli.progress import shown_progress
from rga.errors import InputError
from rga_bench.experiment import Execution, Experiment

if TYPE_CHECKING:
    from rga_bench.synthetic import Case

Result = TypeVar("Result")
Build = Callable[..., Experiment[Any]]

#: of a table, in a terminal that is narrower and in a file
WIDTH = 140

benchmark = typer.Typer(help="Measure what rga can do.", no_args_is_help=True)

Draws = Annotated[
    int,
    typer.Option(
        "-n",
        "--draws",
        metavar="N",
        parser=whole(1),
        help="Hidden effects; each beside its null twin.",
    ),
]
Minutes = Annotated[
    float | None,
    typer.Option(
        "--minutes", metavar="M", parser=decimal(0.0), help="Begin no further draw after these."
    ),
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
Splits = Annotated[
    int,
    typer.Option("--splits", metavar="N", parser=whole(1), help="Random splits of the full gap."),
]
Quick = Annotated[bool, typer.Option("--quick", help="Eight draws only.")]
FewDraws = Annotated[bool, typer.Option("--quick", help="Four draws only.")]
Shorter = Annotated[bool, typer.Option("--quick", help="Fewer rows, and less time for each.")]
FewStreams = Annotated[bool, typer.Option("--quick", help="One stream of each sort.")]
Fewer = Annotated[bool, typer.Option("--quick", help="Few streams, with many false alarms.")]
Least = Annotated[bool, typer.Option("--quick", help="One split, few methods and drifts.")]
Fewest = Annotated[bool, typer.Option("--quick", help="18 broken records of 100 rows.")]
Broken = Annotated[
    int,
    typer.Option(
        "-n", "--draws", metavar="N", parser=whole(1), help="Records with broken channels."
    ),
]
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
Small = Annotated[bool, typer.Option("--quick", help="100 rows of 12 sensors only.")]
Smallest = Annotated[bool, typer.Option("--quick", help="200 rows of 12 sensors only.")]
Short = Annotated[bool, typer.Option("--quick", help="One run of 3 000 rows only.")]
Once = Annotated[bool, typer.Option("--quick", help="Few packets, and one kill of each sort.")]
Few = Annotated[bool, typer.Option("--quick", help="One short stream of each sort only.")]


class Drawn(Protocol):
    """A draw of a blind challenge."""

    def case(self) -> "Case":
        """The case itself."""


def _shared(name: str, kind: object, default: object) -> Parameter:
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=kind)


WORKERS = _shared("workers", Workers, 2)
DASK = _shared("dask", DaskAddress, None)
MINUTES = _shared("minutes", Minutes, None)
KEPT = _shared("output", KeptIn, None)
WRITTEN = _shared("output", WrittenTo, None)
JSON = _shared("json", JsonTarget, None)


@benchmark.callback()
def _benchmarks() -> None:
    """Measure what rga can do."""


def _experiment(*shared: Parameter) -> Callable[[Build], Build]:
    """Make a command of a function that builds an experiment from options of its own.

    Args:
        shared: options that the command has as well, but for those of its own.
    """

    def added(build: Build) -> Build:
        own = signature(build).parameters
        parameters = {**own, **{one.name: one for one in (*shared, JSON) if one.name not in own}}
        execution = [one.name for one in shared if one.name != "output"]

        def command(**given: Any) -> None:
            experiment = build(**{name: given[name] for name in own})
            quick = " --quick" if given["quick"] else ""
            again = f"rga benchmark {experiment.name}{quick} --seed {given['seed']}"
            _perform(
                experiment,
                again + experiment.options,
                Execution(
                    folder=given["output"] if KEPT in shared else None,
                    **{name: given[name] for name in execution},
                ),
                given["output"],
                given["json"],
            )

        # From these typer reads the options.
        command.__signature__ = Signature(list(parameters.values()))  # type: ignore[attr-defined]
        command.__annotations__ = {one.name: one.annotation for one in parameters.values()}
        benchmark.command(build.__name__.replace("_", "-"), help=build.__doc__)(command)
        return build

    return added


def _perform(
    experiment: Experiment[Result],
    command: str,
    execution: Execution,
    output: Path | None,
    json: str | None,
) -> None:
    """Measure, and show what was found.

    Args:
        experiment: what is measured.
        command: that measures the same again.
        execution: how; progress is shown in the terminal.
        output: directory for the page and the figures.
        json: file for what programs read; "-": the terminal.
    """
    from rich.console import Console

    if json not in (None, "-") and Path(json).is_dir():
        # Said before the work is done.
        raise InputError("the output is a directory", json, "give a file")
    with nullcontext() if output is None else whole_directory(output) as draft:
        with shown_progress() as progress:
            result = experiment.measure(
                replace(execution, progress=lambda done: progress(experiment.name, done))
            )
        page = experiment.page(result, command)
        if draft is not None:
            (draft / page.file).write_text(page.text(), encoding="utf-8")
            experiment.write_figures(result, draft)
    if json is not None:
        write_json(experiment.content(result, command), json)
    if json != "-":
        console = Console()
        console.width = max(console.width, WIDTH)
        for part in page.terminal():
            console.print(part, crop=False)


@_experiment(WORKERS, DASK, MINUTES, KEPT)
def diagnosis(
    draws: Draws = 3000,
    generator: Generator = "bridges",
    quick: Quick = False,
    seed: Seed = 1,
    output: KeptIn = None,
    case: CaseName = None,
) -> Experiment[Any]:
    """The blind challenge: effects hidden by seed, each beside its null twin."""
    if case is not None:
        from rga_bench.diagnosis.field_design import draw_of

        _write_case(case, draw_of(case), output)
        raise typer.Exit
    from rga_bench.diagnosis.experiment import DiagnosisExperiment

    return DiagnosisExperiment.of(seed, quick=quick, count=draws, generator=generator)


@_experiment(WORKERS, DASK, MINUTES, KEPT)
def modal_diagnosis(
    draws: Draws = 400,
    quick: FewDraws = False,
    seed: Seed = 1,
    output: KeptIn = None,
    case: CaseName = None,
) -> Experiment[Any]:
    """The blind challenge with modes, alone and beside gauges; each draw beside its null twin."""
    if case is not None:
        from rga_bench.modal_diagnosis.design import ModalDraw

        _write_case(case, ModalDraw.parse(case), output)
        raise typer.Exit
    from rga_bench.modal_diagnosis.experiment import ModalDiagnosisExperiment

    return ModalDiagnosisExperiment.of(seed, quick=quick, count=draws)


def _write_case(name: str, drawn: Drawn, output: Path | None) -> None:
    """Draw a case of a blind challenge, and write its files to a directory."""
    if output is None:
        raise InputError("there is no place for the case", "--case", "give a directory with -o")
    with whole_directory(output) as draft:
        drawn.case().write(draft)
    typer.echo(f"{name} is in {output}.")


@_experiment(WRITTEN)
def diagnosis_speed(quick: Small = False, seed: Seed = 0) -> Experiment[Any]:
    """What a diagnosis costs, by rows, sensors and members, and which stage takes it."""
    from rga_bench.speed.experiment import SpeedExperiment

    return SpeedExperiment.of(seed, quick=quick)


@_experiment(KEPT)
def limits(quick: Smallest = False, seed: Seed = 0) -> Experiment[Any]:
    """Time and memory of a diagnosis up to a million rows, 500 sensors and 5 000 members."""
    from rga_bench.limits.experiment import LimitsExperiment

    return LimitsExperiment.of(seed, quick=quick)


@_experiment(WRITTEN)
def endless(quick: Short = False, seed: Seed = 0) -> Experiment[Any]:
    """What a row costs a twin that has run for long, and what a step leaves on the disk."""
    from rga_bench.endless.experiment import EndlessExperiment

    return EndlessExperiment.of(seed, quick=quick)


@_experiment(WRITTEN)
def operation(quick: Once = False, seed: Seed = 0) -> Experiment[Any]:
    """What a service loses where something is killed, what a packet costs, how a row is seen."""
    from rga_bench.operation.experiment import OperationExperiment

    return OperationExperiment.of(seed, quick=quick)


@_experiment(WRITTEN)
def solver(quick: Shorter = False, seed: Seed = 0) -> Experiment[Any]:
    """What a simulated sample costs, beside other solvers on the same structures."""
    # CHOLMOD asks for four threads, however many are allowed, and on one core these wait for each
    # other; OpenMP reads its limit when it is loaded.
    os.environ["OMP_THREAD_LIMIT"] = "1"
    from rga_bench.solver.experiment import SolverExperiment

    return SolverExperiment.of(seed, quick=quick)


@_experiment(WRITTEN)
def modes(quick: Shorter = False, seed: Seed = 0) -> Experiment[Any]:
    """What natural frequencies cost, beside other solvers on the same structures."""
    os.environ["OMP_THREAD_LIMIT"] = "1"  # as for `solver`
    from rga_bench.modes.experiment import ModesExperiment

    return ModesExperiment.of(seed, quick=quick)


@_experiment(WORKERS, WRITTEN)
def policies(quick: Few = False, seed: Seed = 0) -> Experiment[Any]:
    """What each policy of synchronisation costs, and what gap it leaves."""
    from rga_bench.policies.experiment import PoliciesExperiment

    return PoliciesExperiment.of(seed, quick=quick)


@_experiment(WORKERS, DASK, MINUTES, KEPT)
def streams(quick: FewStreams = False, seed: Seed = 1) -> Experiment[Any]:
    """The twin as it is shipped, on streams in which something changes or nothing does."""
    from rga_bench.streams.experiment import StreamsExperiment

    return StreamsExperiment.of(seed, quick=quick)


@_experiment(WORKERS, WRITTEN)
def detector(quick: Fewer = False, seed: Seed = 0) -> Experiment[Any]:
    """How soon a change is seen, at which rate of false alarms, beside the optimum."""
    from rga_bench.detection.experiment import DetectionExperiment

    return DetectionExperiment.of(seed, quick=quick)


@_experiment(WORKERS, DASK, MINUTES, KEPT)
def faults(
    draws: Broken = 340,
    quick: Fewest = False,
    data: Foreign = None,
    crossing: CrossingModel = Path("examples/rdso45m/model.json"),
    seed: Seed = 1,
) -> Experiment[Any]:
    """What a diagnosis makes of records in which channels are broken, as loggers show it."""
    from rga_bench.faults.experiment import FaultsExperiment

    return FaultsExperiment.of(seed, quick=quick, draws=draws, data=data, crossing=crossing)


@_experiment(WORKERS, DASK, MINUTES, KEPT)
def loi(
    quick: Least = False,
    splits: Splits = 10,
    seed: Seed = 0,
) -> Experiment[Any]:
    """Ways to infer contexts, at every level of integration: the paper's table."""
    from rga_bench.contexts.experiment import ContextsExperiment

    return ContextsExperiment.of(seed, quick=quick, splits=splits)
