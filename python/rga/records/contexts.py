"""Context files: the input of a simulation."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.model.effect import seconds
from rga.records.mapping import TimeColumns
from rga.records.read import read_table
from rga.records.times import read_clock
from rga.records.units import conversion


@dataclass(frozen=True)
class ContextTable:
    """Contexts as they stand in a file.

    Attributes:
        frame: the columns time and context variables as in the file, for a result to begin with.
        values: context variables, float[n] each; `time` on the scale of onsets [s] if given.
    """

    frame: pl.DataFrame
    values: dict[str, FloatArray]


def load_contexts(path: str | Path, model: Model) -> ContextTable:
    """Read contexts, of any format: columns named after context variables, and `time` if needed.

    Columns named after sensors are passed over, so that a record serves as well.

    Raises:
        InputError: an unknown column, a missing value, or a file that cannot be read.
    """
    table = read_table(path, known=(*model.context, *model.sensors))
    names = [name for name in table.frame.columns if name not in model.sensors]
    unknown = [name for name in names if name != "time" and name not in model.context]
    if unknown:
        raise InputError(
            f"the model has no context variable {unknown[0]!r}",
            str(table.path),
            "it has " + (", ".join(model.context) or "none"),
        )
    values: dict[str, FloatArray] = {}
    kept = {}
    for name in names:
        if name == "time":
            clock = read_clock(table, TimeColumns())
            values[name] = seconds(clock.start) + clock.seconds
            as_number = clock.time_format == "seconds"
            kept[name] = pl.Series(values[name]) if as_number else table.frame[name]
            continue
        factor, offset = 1.0, 0.0
        if unit := table.units.get(name):
            where = f"{table.path}, column {name!r}"
            factor, offset = conversion(unit, name, model, where)
        values[name] = table.numbers(name) * factor + offset
        kept[name] = pl.Series(values[name])
        missing = np.isnan(values[name])
        if missing.any():
            raise InputError(
                "the context has no value", table.where(int(np.argmax(missing)), name), "give one"
            )
    if not values:
        raise InputError("there is no context in the file", str(table.path), "give a column")
    return ContextTable(pl.DataFrame(kept), values)
