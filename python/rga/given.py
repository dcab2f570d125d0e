"""A record as a caller gives it: itself, or the files or the data frame that hold it."""

from pathlib import Path

from rga.errors import InputError, kind_of
from rga.model import Model
from rga.records import Record, RecordMapping, RecordSource, load_record
from rga.records.frames import is_frame


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
        InputError: the file cannot be used, the record is of another model, or this is neither.
    """
    if isinstance(given, Record):
        if foreign := [name for name in given.sensors if name not in model.sensors]:
            what = f"the model has no sensor {foreign[0]!r}"
            raise InputError(what, "record", "read the record with this model")
        return given
    if isinstance(given, (str, Path, list, tuple)) or is_frame(given):
        return load_record(given, model, mapping)
    what = f"{kind_of(given)} is no record"
    raise InputError(what, "record", "give a Record, or the path of its file")
