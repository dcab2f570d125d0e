"""A record as a caller gives it: itself, or the files or the data frame that hold it."""

from pathlib import Path

import numpy as np

from rga.errors import InputError, kind_of
from rga.model import Model
from rga.records import Record, RecordMapping, RecordSource, load_record
from rga.records.frames import is_frame
from rga.records.record import LARGEST


def as_record(
    given: Record | RecordSource,
    model: Model,
    mapping: str | Path | RecordMapping | None = None,
) -> Record:
    """A record, read against a model where its files or a data frame are given.

    Args:
        given: the record, or what `load_record` takes.
        model: that names its channels.
        mapping: how to read the file, as `load_record` takes it.

    Raises:
        InputError: the file cannot be used, the record is of another model or has a value that
            nothing measures, or this is neither.
    """
    if isinstance(given, Record):
        if foreign := [name for name in given.sensors if name not in model.sensors]:
            what = f"the model has no sensor {foreign[0]!r}"
            raise InputError(what, "record", "read the record with this model")
        _check_measured(given)
        return given
    if isinstance(given, (str, Path, list, tuple)) or is_frame(given):
        return load_record(given, model, mapping)
    what = f"{kind_of(given)} is no record"
    raise InputError(what, "record", "give a Record, or the path of its file")


def _check_measured(record: Record) -> None:
    """Refuse values beyond what anything measures, as those of a file are.

    Raises:
        InputError: there is one.
    """
    columns = {**record.contexts, **dict(zip(record.sensors, record.readings.T, strict=True))}
    for name, values in columns.items():
        if (wrong := np.flatnonzero(np.abs(values) > LARGEST)).size:
            raise InputError(
                f"{name} is {values[wrong[0]]:g} in row {wrong[0]}",
                "record",
                "give NaN where none was read",
            )
