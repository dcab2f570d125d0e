"""Contexts as a caller gives them: by name, or as a table with a column for each."""

from collections.abc import Collection, Mapping
from datetime import datetime
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from rga.errors import InputError, kind_of
from rga.model.effect import seconds


class ColumnTable(Protocol):
    """A table with named columns, as polars and pandas have them."""

    @property
    def columns(self) -> Any: ...

    def __getitem__(self, column: Any, /) -> Any: ...


#: context variables by name, each a value a row or one for all; or a table of them
Contexts: TypeAlias = Mapping[str, ArrayLike] | ColumnTable


def contexts_by_name(given: Contexts, known: Collection[str]) -> Mapping[str, ArrayLike]:
    """Contexts by name. Times that are dates, or text of ISO 8601, become seconds since 1970.

    Args:
        given: names with values, or a table with a column for each: polars, pandas or alike.
        known: names of the contexts of the model. A table may have more columns: readings, notes.

    Raises:
        InputError: this is neither, there is no such context, or a time cannot be read.

    >>> import polars as pl
    >>> times = ["2024-01-01", "2024-01-02"]
    >>> given = pl.DataFrame({"time": times, "load": [1, 2], "note": ["dry", "wet"]})
    >>> table = contexts_by_name(given, ["load"])
    >>> np.diff(table["time"]), table["load"].tolist(), "note" in table
    (array([86400.]), [1, 2], False)
    """
    if isinstance(given, Mapping):
        named = dict(given)
        if unknown := [name for name in named if name != "time" and name not in known]:
            raise InputError(
                f"there is no context variable {unknown[0]!r}",
                "contexts",
                f"the model has {', '.join(known) or 'none'}",
            )
    elif hasattr(given, "columns") and hasattr(given, "__getitem__"):
        columns = {str(column): column for column in given.columns}
        wanted = [name for name in ("time", *known) if name in columns]
        named = {name: np.asarray(given[columns[name]]) for name in wanted}
    else:
        raise InputError(
            f"contexts are {kind_of(given)}",
            "contexts",
            "give names with values, or a table with columns",
        )
    if "time" in named:
        named["time"] = _clock(np.asarray(named["time"]))
    return named


def _clock(time: Any) -> Any:
    """Times in seconds, where they are dates."""
    if np.issubdtype(time.dtype, np.datetime64):
        return time.astype("datetime64[us]").astype(float) / 1e6
    moments = time.ravel().tolist()
    if time.dtype.kind not in "OU" or not all(isinstance(one, str | datetime) for one in moments):
        return time
    texts = [one if isinstance(one, str) else one.isoformat() for one in moments]
    try:
        return np.array([seconds(one) for one in texts])
    except ValueError as error:
        raise InputError(str(error), "contexts, time", "write seconds or ISO 8601") from None
