"""Modes that another program found, as lines of a modal record."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from rga.errors import InputError
from rga.records.modal.columns import COLUMNS, DEVIATION, FREQUENCY, IMAGINARY
from rga.records.table import Table


def table_of_entries(
    path: Path,
    format_name: str,
    entries: Mapping[str, Any],
    shapes: np.ndarray,
    channels: Sequence[str],
) -> Table:
    """A line for each mode, where it was found.

    Args:
        path: of the file.
        format_name: as a reader is told.
        entries: columns of a modal record, each [entries]; NaN where nothing is said. A mode
            whose frequency is NaN was not found.
        shapes: float or complex[entries, channels]; NaN where a channel did not measure.
        channels: their names.

    Raises:
        InputError: a name stands twice or is that of a column of the record, or no mode was found.

    >>> entries = {"time": [0.0, 0.0], "f": [1.5, float("nan")]}
    >>> table_of_entries(Path("a"), "b", entries, np.array([[1j], [0j]]), ["A1"]).frame.to_dicts()
    [{'time': 0.0, 'f': 1.5, 'A1': 0.0, 'A1_im': 1.0}]
    """
    imaginary = np.iscomplexobj(shapes) and bool(np.nan_to_num(shapes.imag).any())
    columns = {name: np.real(shapes[:, at]) for at, name in enumerate(channels)}
    if imaginary:
        columns |= {name + IMAGINARY: shapes[:, at].imag for at, name in enumerate(channels)}
    if len(columns) < len(channels) * (1 + imaginary) or not columns.keys().isdisjoint(COLUMNS):
        doubled = [name for at, name in enumerate(channels) if name in [*channels[:at], *COLUMNS]]
        name = doubled[0] if doubled else f"...{IMAGINARY}"
        raise InputError(
            f"the channel {name!r} has the name of another channel, or of a column of the record",
            str(path),
            "give every channel a name of its own",
        )
    found = ~np.isnan(np.asarray(entries[FREQUENCY], dtype=float))
    if not found.any():
        raise InputError("no mode was found in any window", str(path), "give one that was")
    said = {name: np.asarray(column)[found] for name, column in entries.items()}
    if DEVIATION in said:  # some programs write 0 where they did not reckon it
        said[DEVIATION] = np.where(said[DEVIATION] > 0, said[DEVIATION], np.nan)
    frame = pl.DataFrame(said | {name: column[found] for name, column in columns.items()})
    return Table(
        path=path,
        frame=frame.with_columns(pl.selectors.float().fill_nan(None)),
        row_name="mode",
        first=1,
        format=format_name,
    )
