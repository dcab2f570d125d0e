"""MATLAB files (.mat): variables as channels."""

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from rga.errors import InputError
from rga.records.formats.blocks import chosen_block
from rga.records.formats.matlab_file import Arrays, arrays_of
from rga.records.mapping import FileMapping
from rga.records.table import StatedTime, Table

_TIMES = ("time", "t", "Time", "T", "zeit", "Zeit", "timestamp", "Timestamp", "datenum")
_RATES = ("fs", "Fs", "FS", "sampling_rate", "samplingRate", "SampleRate", "sample_rate", "fsamp")
_STEPS = ("dt", "Dt", "delta_t", "Ts")
#: MATLAB's day numbers from 1954 on, and that of 1970
_DAYS, _DAY_1970 = (714_000, 803_000), 719_529
#: elements of the greatest array of columns that is taken apart
_MOST_COLUMNS = 1000


def is_matlab(data: bytes, path: Path) -> bool:
    """Whether a file is MATLAB's by its first bytes or its suffix."""
    return data.startswith(b"MATLAB ") or path.suffix.lower() == ".mat"


def read_matlab(data: bytes, path: Path, mapping: FileMapping) -> Table:
    """Read a MATLAB file of version 4 to 7.

    Variables that are vectors are channels by their names, fields of structs as `struct.field`, and
    columns of a matrix as `matrix 1`, `matrix 2`.

    Raises:
        InputError: it is of version 7.3, damaged, or has no vector of numbers.
    """
    if data.startswith((b"MATLAB 7.3", b"\x89HDF")):
        raise InputError(
            "this is a MATLAB file of version 7.3 (HDF5), which is not read",
            str(path),
            "save it in MATLAB by save(..., '-v7'), or write a table by writetable",
        )
    vectors: dict[int, dict[str, np.ndarray[Any, Any]]] = {}
    scalars: dict[str, float] = {}
    try:
        for name, value in _channels(data):
            if value.ndim == 0:
                scalars[name] = float(value)
            elif value.ndim == 1 and len(value) > 1:
                vectors.setdefault(len(value), {})[name] = value
    except ValueError as error:
        raise InputError(
            f"the MATLAB file is damaged: {error}",
            str(path),
            "save it again, or write a table by writetable",
        ) from None
    if not vectors:
        raise InputError("no vector of numbers is in the file", str(path), "give another file")
    blocks = sorted(vectors.values(), key=lambda one: -len(one))
    said = [f"{', '.join(list(one)[:4])} of {len(next(iter(one.values())))} rows" for one in blocks]
    chosen, notes = chosen_block(blocks, said, mapping.block, path)
    frame = pl.DataFrame({name: np.asarray(value, dtype=float) for name, value in chosen.items()})
    frame, time, more = _time(frame, scalars)
    return Table(
        path=path,
        frame=frame,
        row_name="row",
        first=1,
        format="MATLAB",
        time=time,
        notes=(*notes, *more, "the file states no units"),
    )


def _channels(data: bytes) -> Arrays:
    """Real arrays by their names, matrices as columns."""
    for name, array in arrays_of(data):
        if np.iscomplexobj(array):
            continue
        if array.ndim < 2:
            yield name, array
        elif array.ndim == 2 and min(array.shape) <= _MOST_COLUMNS:
            columns = array if array.shape[0] >= array.shape[1] else array.T
            for number, column in enumerate(columns.T, 1):
                yield f"{name} {number}", column


def _time(
    frame: pl.DataFrame, scalars: dict[str, float]
) -> tuple[pl.DataFrame, StatedTime | None, list[str]]:
    """The time: a vector of its name, else a rate or a step that is a number of its own."""
    last = {name: name.rsplit(".", 1)[-1] for name in frame.columns}
    named = next((name for one in _TIMES for name in frame.columns if last[name] == one), None)
    if named is not None:
        values = frame[named].to_numpy()
        if np.all((_DAYS[0] < values) & (values < _DAYS[1])):
            # Such a number tells no less than 10 microseconds apart.
            stamps = 10 * np.round((values - _DAY_1970) * 86400e5).astype("int64")
            moments = pl.Series(named, stamps).cast(pl.Datetime("us"))
            return frame.with_columns(moments), StatedTime((named,)), [
                f"{named} is read as MATLAB's day numbers, without a time zone"
            ]  # fmt: skip
        return frame, StatedTime((named,)), [f"{named} is taken as the time in seconds"]
    for known in (_RATES, _STEPS):
        found = {
            name: value
            for name, value in scalars.items()
            if name.rsplit(".", 1)[-1] in known and value > 0
        }
        said = " and ".join(f"{name} = {value:g}" for name, value in found.items())
        if len(set(found.values())) > 1:
            return frame, None, [f"{said} differ: state [time] sampling_rate_hz"]
        for value in found.values():
            step = 1 / value if known is _RATES else value
            return frame, StatedTime(step=step), [f"rows are counted by {said}"]
    return frame, None, ["the file states no time: name it, or state [time] sampling_rate_hz"]
