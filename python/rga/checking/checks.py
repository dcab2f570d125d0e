"""All checks of a model, and of a record beside it, at once."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TypeVar

import numpy as np

from rga.checking.checked import CheckResult
from rga.checking.finding import Finding, refused
from rga.checking.measured import Measured
from rga.checking.of_record.channels import channels
from rga.checking.over_ranges import OverRanges
from rga.checking.record_summary import summary_of
from rga.checking.registry import OF_MODEL, OF_RECORD
from rga.errors import InputError
from rga.given import as_record
from rga.model import Model, as_model
from rga.records import Record, RecordMapping, RecordSource

T = TypeVar("T")
ORDER = ("error", "warning", "note")


def check(
    model: Model | str | Path,
    record: Record | RecordSource | None = None,
    *,
    mapping: str | Path | RecordMapping | None = None,
) -> CheckResult:
    """Everything that looks wrong or odd of a model, and of a record beside it.

    What cannot be read is a finding as well, so that all others come with it.

    Args:
        model: the model, or its file.
        record: the record, or its file; None: the model alone.
        mapping: how to read the file of the record, as `load_record` takes it.

    Returns:
        What was read as the record; errors, then warnings, then notes.

    >>> bar = {"nodes": ["A", "B"], "section": "bar", "material": "steel"}
    >>> from rga.model import read_model
    >>> checked = check(read_model({
    ...     "rga_model": 1, "name": "bar", "plane": "xz",
    ...     "materials": {"steel": {"E": 210}}, "sections": {"bar": {"A": 0.01}},
    ...     "nodes": {"A": [0, 0, 0], "B": [3, 0, 0]}, "members": {"bar": bar},
    ...     "supports": {"west": {"node": "A", "fixed": ["ux", "uz"]}},
    ... }, "bar.json"))
    >>> checked.ok, [one.what for one in checked.findings[:2]]  # doctest: +NORMALIZE_WHITESPACE
    (False, ["nothing resists a motion of node 'B' in uz",
             'E is 210 Pa, which no material of a structure has'])
    """
    try:
        structure = as_model(model)
    except InputError as error:
        return CheckResult(tuple(refused(error)))
    over = OverRanges(structure)
    found = list(_all(OF_MODEL, over))
    summary = None
    if record is not None:
        try:
            given = as_record(record, over.model, mapping)
        except InputError as error:
            found += refused(error)
        else:
            summary = summary_of(given, over.model)
            found += _of_record(over, given)
    # What several checks meet is told once.
    found = list(dict.fromkeys(found))
    ordered = sorted(found, key=lambda one: ORDER.index(one.severity))
    return CheckResult(tuple(ordered), summary)


def _of_record(over: OverRanges, record: Record) -> list[Finding]:
    measured = Measured(over, record)
    enough = len(record) >= measured.criteria.record.least_rows
    return list(_all(OF_RECORD if enough else [channels], measured))


def _all(checks: Iterable[Callable[[T], Iterable[Finding]]], of: T) -> Iterator[Finding]:
    for one in checks:
        try:
            # Numbers of a hostile model overflow; what comes of it is compared all the same.
            with np.errstate(all="ignore"):
                found = list(one(of))
        except InputError as error:
            found = refused(error)
        yield from found
