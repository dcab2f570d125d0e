"""Many bridges at once: a list of models and records in, findings for each and a summary out."""

import tempfile
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing
from dataclasses import asdict, dataclass
from pathlib import Path

import polars as pl

from rga.diagnosis.pipeline import diagnose
from rga.errors import InputError, ReportError
from rga.files import as_path, check_place, made_directory, write_whole
from rga.findings import Findings
from rga.findings.criteria import Criteria, as_criteria
from rga.findings.phrases import effect_words
from rga.given import as_record
from rga.inputs import remember
from rga.model import Model, as_model
from rga.numerics.seeds import as_seed
from rga.one_writer import only_writer
from rga.outputs import check_outputs
from rga.parallel import finished
from rga.records import Record
from rga.records.read import read_table

NEEDED = ("name", "model", "record")
OPTIONAL = ("import",)
SUMMARY = "summary.csv"


@dataclass(frozen=True)
class Summary:
    """What became of a bridge; a line of summary.csv.

    Attributes:
        name: of the bridge.
        verdict: of the findings; None where there is an error.
        causes: in words.
        gain: on rows that no step saw [noise variances]; None where there is an error.
        error: what kept the bridge from being diagnosed.
    """

    name: str
    verdict: str | None = None
    causes: str | None = None
    gain: float | None = None
    error: str | None = None


@dataclass(frozen=True)
class _Bridge:
    """A line of the list."""

    name: str
    model: Model | str | Path
    record: Record | str | Path
    mapping: str | Path | None = None


@dataclass(frozen=True)
class _Task:
    """All that a worker needs, which may share no disk with us."""

    name: str
    model: Model
    record: Record
    criteria: Criteria
    seed: int


@dataclass(frozen=True)
class _Done:
    """The files of a diagnosis, by name, and why its report could not be drawn."""

    files: dict[str, bytes]
    fault: ReportError | None


def diagnose_many(
    bridges: str | Path | Mapping[str, tuple[Model | str | Path, Record | str | Path]],
    output: str | Path,
    *,
    criteria: Criteria | str | Path | None = None,
    seed: int = 0,
    workers: int = 1,
    dask: str | None = None,
    progress: Callable[[str, float], None] | None = None,
) -> list[Summary]:
    """Diagnose many bridges; an error of one does not stop the others.

    Findings, extended model and report of a bridge are written to a directory of its name as soon
    as they are there, and `summary.csv` at the end. They do not depend on where the work is done.

    Args:
        bridges: CSV or Parquet file, a bridge a line: `name`, `model`, `record` and, where wanted,
            `import` (a mapping); files relative to the list. Or model and record by the name of
            the bridge, themselves or their files.
        output: directory for the results.
        criteria: what decides each verdict, or their file; None: the default ones.
        seed: of each diagnosis.
        workers: processes at work on this machine.
        dask: address of the scheduler of a Dask cluster, whose workers do the work instead; they
            need rga, and none of the files.
        progress: called with a stage and the share of it that is done.

    Returns:
        A summary for each bridge, in the order of the list.

    Raises:
        InputError: the list cannot be used, the output cannot be written, the seed is none, or
            there is no cluster.
        ReportError: a report could not be drawn; all else is written.
    """
    listed, chosen, seed = _listed(bridges), as_criteria(criteria), as_seed(seed)
    output = made_directory(output)
    for bridge in listed:
        for given in (bridge.model, bridge.record, bridge.mapping):
            if isinstance(given, str | Path):
                # It is read after others were written.
                remember(Path(given))
    check_place(output / SUMMARY)
    for bridge in listed:
        check_outputs(output / bridge.name)
    errors: dict[str, Exception] = {}
    faults: list[ReportError] = []
    summary_of: dict[str, Summary] = {}
    tasks = _tasks(listed, chosen, seed, errors)
    done = finished(_work, tasks, workers=workers, dask=dask)
    with only_writer(output / SUMMARY), closing(done):
        for task, future in done:
            error = future.exception()
            if isinstance(error, Exception):
                errors[task.name] = error
            else:
                kept: _Done = future.result()
                summary_of[task.name] = _keep(task.name, kept, output / task.name)
                if kept.fault is not None:
                    faults.append(ReportError(kept.fault.reason, output / task.name))
            if progress is not None:
                progress("diagnosing bridges", len({*summary_of, *errors}) / len(listed))
        for name, error in errors.items():
            words = " ".join(str(error).split()) or type(error).__name__
            summary_of[name] = Summary(name, error=words)
        summaries = [summary_of[bridge.name] for bridge in listed]
        frame = pl.DataFrame([asdict(one) for one in summaries], infer_schema_length=None)
        write_whole({output / SUMMARY: frame.write_csv().encode()})
    for error in errors.values():
        if not isinstance(error, InputError):
            raise error
    for fault in faults:
        raise fault
    return summaries


def _tasks(
    bridges: Iterable[_Bridge],
    criteria: Criteria,
    seed: int,
    errors: dict[str, Exception],
) -> Iterator[_Task]:
    """Bridges as they are read; errors are kept by the name of the bridge."""
    for bridge in bridges:
        try:
            model = as_model(bridge.model)
            record = as_record(bridge.record, model, bridge.mapping)
        except Exception as error:
            errors[bridge.name] = error
        else:
            yield _Task(bridge.name, model, record, criteria, seed)


def _work(task: _Task) -> _Done:
    findings = diagnose(task.model, task.record, criteria=task.criteria, seed=task.seed)
    fault = None
    with tempfile.TemporaryDirectory() as folder:
        try:
            findings.write(folder)
        except ReportError as error:
            fault = error
        return _Done({path.name: path.read_bytes() for path in Path(folder).iterdir()}, fault)


def _keep(name: str, done: _Done, directory: Path) -> Summary:
    write_whole({directory / name: content for name, content in done.files.items()})
    findings = Findings.model_validate_json(done.files["findings.json"])
    causes = " and ".join(effect_words(cause.effect) for cause in findings.causes)
    return Summary(name, findings.verdict, causes, findings.gap.held_out.gain)


def _listed(
    bridges: str | Path | Mapping[str, tuple[Model | str | Path, Record | str | Path]],
) -> list[_Bridge]:
    if not isinstance(bridges, Mapping):
        return _read(as_path(bridges, "bridges"))
    seen: dict[str, str] = {}
    for name in bridges:
        where = f"bridge {name!r}"
        _check_name(name, where)
        if (first := seen.setdefault(name.casefold(), name)) != name:
            raise InputError(f"the name stands twice, as {first!r} too", where, "give another")
    return [_Bridge(name, model, record) for name, (model, record) in bridges.items()]


def _check_name(name: str, where: str) -> None:
    """Refuse a name that cannot be that of a directory of results."""
    if not name or name.startswith(".") or not name.isprintable() or {*name} & {"/", "\\", ":"}:
        raise InputError(
            f"{name!r} cannot name a directory",
            where,
            "leave out slashes, colons and a dot in front",
        )
    if name.casefold() == SUMMARY:
        raise InputError(f"{name!r} is the name of the summary", where, "give another")


def _read(path: Path) -> list[_Bridge]:
    table = read_table(path)
    columns = table.frame.columns
    if missing := [name for name in NEEDED if name not in columns]:
        raise InputError(
            f"the list has no column {missing[0]!r}", str(path), f"give {', '.join(NEEDED)}"
        )
    if unknown := [name for name in columns if name not in NEEDED + OPTIONAL]:
        known = ", ".join(NEEDED + OPTIONAL)
        raise InputError(f"the column {unknown[0]!r} is unknown", str(path), f"known are {known}")
    seen: dict[str, int] = {}
    bridges = []
    for number, row in enumerate(table.frame.iter_rows(named=True)):
        for column in NEEDED:
            if not isinstance(row[column], str):
                raise InputError(
                    f"there is no {column}", table.where(number, column), "fill the cell with text"
                )
        name = row["name"]
        _check_name(name, table.where(number, "name"))
        # Disks that do not distinguish capitals would mix up their results.
        if (first := seen.setdefault(name.casefold(), number)) < number:
            raise InputError(
                f"the name {name!r} stands twice",
                table.where(number, "name"),
                f"give another than in {table.row_name} {table.first + first}",
            )
        model, record = path.parent / row["model"], path.parent / row["record"]
        mapping = path.parent / row["import"] if row.get("import") else None
        bridges.append(_Bridge(name, model, record, mapping))
    return bridges
