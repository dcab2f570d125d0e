"""What a caller gives: an object, or the file that holds it; contexts by name, or as a table."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rga.errors import InputError
from rga.model import Model, load_model
from rga.model.effect import seconds
from rga.records import Record, RecordMapping, load_record


class Frame(Protocol):
    """A table with named columns, as polars and pandas have them."""

    @property
    def columns(self) -> Any: ...

    def __getitem__(self, column: Any, /) -> Any: ...


#: contexts by name, each a value a row or one for all; or a table of them
Contexts: TypeAlias = Mapping[str, ArrayLike] | Frame


def as_model(given: Model | str | Path) -> Model:
    """A model, read where its file is given.

    Raises:
        InputError: the file cannot be used; this is no model.
    """
    if isinstance(given, Model):
        return given
    if isinstance(given, str | Path):
        return load_model(given)
    raise _other(given, "model", "give a Model, or the path of its file")


def as_record(
    given: Record | str | Path,
    model: Model,
    mapping: str | Path | RecordMapping | None = None,
) -> Record:
    """A record, read against a model where its file is given.

    Args:
        given: the record, or its file.
        model: that names its channels.
        mapping: how to read the file, as `load_record` takes it.

    Raises:
        InputError: the file cannot be used; this is no record.
    """
    if isinstance(given, Record):
        return given
    if isinstance(given, str | Path):
        return load_record(given, model, mapping)
    raise _other(given, "record", "give a Record, or the path of its file")


def as_contexts(given: Contexts) -> Mapping[str, ArrayLike]:
    """Contexts by name. Times of a table, or text of ISO 8601, become seconds since 1970.

    Args:
        given: names with values, or a table with a column for each: polars, pandas or alike.

    Raises:
        InputError: this is neither.

    >>> import polars as pl
    >>> table = as_contexts(pl.DataFrame({"time": ["2024-01-01", "2024-01-02"], "load": [1, 2]}))
    >>> np.diff(table["time"]), table["load"].tolist()
    (array([86400.]), [1, 2])
    """
    if isinstance(given, Mapping):
        return given
    if isinstance(given, str | Path) or not hasattr(given, "columns"):
        raise _other(given, "contexts", "give names with values, or a table with columns")
    return dict(_columns(given))


def _columns(frame: Frame) -> Iterator[tuple[str, ArrayLike]]:
    for column in frame.columns:
        values = np.asarray(frame[column])
        yield str(column), _clock(values) if str(column) == "time" else values


def _clock(values: Any) -> Any:
    if np.issubdtype(values.dtype, np.datetime64):
        return values.astype("datetime64[us]").astype(float) / 1e6
    if values.dtype.kind in "OUT" and all(isinstance(one, str) for one in values):
        try:
            return np.array([seconds(one) for one in values])
        except ValueError as error:
            remedy = "write seconds or ISO 8601"
            raise InputError(f"a time cannot be read: {error}", "contexts, time", remedy) from None
    return values


def _other(given: Any, what: str, remedy: str) -> InputError:
    return InputError(f"a {type(given).__name__} is no {what}", what, remedy)
