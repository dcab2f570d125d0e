"""Reading a modal record: one line a mode found in a window, or a column a mode."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.records.mapping import TimeColumns
from rga.records.modal.columns import (
    COLUMNS,
    DAMPING,
    DEVIATION,
    DURATION,
    FREQUENCY,
    HINT,
    IMAGINARY,
    TIME,
)
from rga.records.modal.formats import read_modal_table
from rga.records.modal.record import ModalRecord
from rga.records.modal.unusable import (
    check_lines,
    check_phases,
    check_shapes,
    check_window,
    one_unit,
)
from rga.records.table import Table
from rga.records.times import read_clock

#: column of a wide table, by the number of a mode: f1, f_2
_NUMBERED = re.compile(r"f_?(\d+)")
#: unit of a column, where a file states one
_UNITS = {FREQUENCY: "Hz", DEVIATION: "Hz", DURATION: "s", DAMPING: "-"}


def load_modal_record(path: str | Path, model: Model) -> ModalRecord:
    """Read modes found in windows: columns time, f and, where there are any, the others.

    `time` is the middle of the window, `f` [Hz] the frequency; `duration` [s], `f_sd` [Hz], `zeta`
    [-] and `mode`, a hint, may be there, and columns named after points and context variables of
    the model. The imaginary part of a shape at point A1 is in a column A1_im.

    A wide table has a line a window, and in place of `f` columns of frequencies [Hz]: of a mode L1
    of the model L1, f_L1, or the name of the sensor of its frequency; f1, f2, ... of modes of which
    nobody says which they are. An empty cell: the mode was not found. It tells no shapes.

    Results of other programs are read as well (`rga.records.modal.formats`); their channels are
    points of the model by name.

    Args:
        path: CSV, Parquet or any other format of records; results of pyOMA2 (.npz, .mat, .json),
            NetCDF of pyOMA, or a universal file with modes.
        model: whose points and contexts name columns.

    Raises:
        InputError: a column is missing, holds no number or has another unit; a frequency is not
            above zero, as those that are normalised; a shape is zero, is without phase or has two
            units; a context has two values in a window; or no entry is there.
        MissingPackageError: a package that reads the format is not installed.
    """
    named = modes_of_columns(model)
    table = read_modal_table(path, known=(*COLUMNS, *model.points, *model.context, *named))
    return modal_record_of(table, model)


def modal_record_of(table: Table, model: Model) -> ModalRecord:
    """The modal record that a table holds, long or wide.

    Args:
        table: with the columns of `load_modal_record`.
        model: whose points and contexts name columns.

    Raises:
        InputError: as `load_modal_record` does.
    """
    table = _without_units(table, model)
    columns = table.frame.columns
    wide = {} if FREQUENCY in columns else _wide_columns(columns, model)
    if wide:
        return _wide(table, model, wide)
    if FREQUENCY not in columns:
        raise InputError(
            f"there is no column {FREQUENCY!r}",
            f"{table.path}, columns {', '.join(columns[:12])}",
            "give natural frequencies in Hz in a column f, one line a mode and window, or columns "
            "named after the model's modes",
        )
    frequency = table.numbers(FREQUENCY)
    bad = ~(frequency > 0)
    if bad.any():
        row = int(np.argmax(bad))
        raise InputError(
            _no_frequency(float(frequency[row])),
            table.where(row, FREQUENCY),
            "give frequencies in Hz, not normalised; leave out the line of a mode not found",
        )
    points = tuple(name for name in model.points if name in columns)
    alone = [name for name in model.points if name + IMAGINARY in columns and name not in columns]
    if alone:
        raise InputError(
            f"column {alone[0] + IMAGINARY!r} has an imaginary part, and there is no {alone[0]!r}",
            str(table.path),
            "give the real part as well: without it the phase is not known",
        )
    check_phases(table, model.points)
    shapes, realness = _shapes(table, points)
    check_shapes(table, points, shapes)
    time, start = _time(table)
    contexts = {name: table.numbers(name) for name in model.context if name in columns}
    for name, column in contexts.items():
        check_window(table, name, column, time)
    used = {*COLUMNS, *points, *model.context, *(name + IMAGINARY for name in points)}
    return ModalRecord(
        time=time,
        start=start,
        duration=_above_zero(table, DURATION),
        frequency=frequency,
        frequency_sd=_above_zero(table, DEVIATION),
        damping=_given(table, DAMPING),
        points=points,
        shapes=shapes,
        realness=realness,
        hint=tuple(
            "" if one is None else str(one)
            for one in (table.frame[HINT] if HINT in columns else [None] * len(frequency))
        ),
        contexts=contexts,
        left_out=tuple(name for name in columns if name not in used),
        sha256=table.sha256,
    ).once()


def _no_frequency(value: float) -> str:
    return "there is no frequency" if np.isnan(value) else f"{value:g} Hz is no natural frequency"


def modes_of_columns(model: Model) -> dict[str, str]:
    """The mode whose frequency a column of a wide table has, by the column's name."""
    sensors = {
        name: one.mode for name, one in model.modal_sensors.items() if one.kind == "frequency"
    }
    return {**sensors, **{name: name for name in model.modes}}


def _wide_columns(columns: Sequence[str], model: Model) -> dict[str, str]:
    """Columns of frequencies, and the mode that each names: a hint, and no identity."""
    named = modes_of_columns(model)
    known = {**named, **{f"{FREQUENCY}_{name}": name for name in model.modes}}
    numbered = {
        name: found[1]
        for name in columns
        if name not in {**model.context, **model.points}
        and (found := _NUMBERED.fullmatch(name)) is not None
    }
    return {name: one for name in columns if (one := {**numbered, **known}.get(name)) is not None}


def _without_units(table: Table, model: Model) -> Table:
    """The table with the names of columns as they are without units in them.

    Raises:
        InputError: a column has another unit than it must have, or points have two.
    """
    shaped = {point + part for point in model.points for part in ("", IMAGINARY)}
    bare = {
        name: one
        for name, one in table.names.items()
        if one in {*_UNITS, HINT, *shaped, *_wide_columns([one], model)}
        and one not in table.frame.columns
    }
    frame = table.frame.rename(bare)
    wide = {} if FREQUENCY in frame.columns else _wide_columns(frame.columns, model)
    units = {bare.get(name, name): unit for name, unit in table.units.items()}
    for name, wanted in {**_UNITS, **dict.fromkeys(wide, "Hz")}.items():
        if name in frame.columns and (unit := units.get(name, wanted)) != wanted:
            raise InputError(
                f"the unit of {name!r} is {unit!r}", str(table.path), f"give it in {wanted}"
            )
    of_shapes = [name for name in frame.columns if name in shaped]
    one_unit(table, of_shapes, [units.get(name, "") for name in of_shapes])
    return replace(table, frame=frame, units=units)


def _wide(table: Table, model: Model, named: Mapping[str, str]) -> ModalRecord:
    """The record of a table with a line a window and a column a mode."""
    columns, chosen = table.frame.columns, list(named)
    found = np.array([table.numbers(name) for name in chosen]).T
    bad = found <= 0
    if bad.any():
        row, column = np.argwhere(bad)[0]
        raise InputError(
            _no_frequency(float(found[row, column])),
            table.where(int(row), chosen[column]),
            "give frequencies in Hz, not normalised; leave the cell of a mode not found empty",
        )
    rows, of = np.nonzero(np.isfinite(found))
    if not len(rows):
        raise InputError("no mode was found in any window", str(table.path), "give one that was")
    time, start = _time(table)
    check_lines(table, time)
    nothing = np.full(len(rows), np.nan)
    used = {TIME, DURATION, *chosen, *model.context}
    return ModalRecord(
        time=time[rows],
        start=start,
        duration=_above_zero(table, DURATION)[rows],
        frequency=found[rows, of],
        frequency_sd=nothing,
        damping=nothing,
        points=(),
        shapes=np.zeros((len(rows), 0)),
        realness=np.ones(len(rows)),
        hint=tuple(named[chosen[column]] for column in of),
        contexts={name: table.numbers(name)[rows] for name in model.context if name in columns},
        left_out=tuple(name for name in columns if name not in used),
        sha256=table.sha256,
    ).once()


def as_real(shapes: np.ndarray) -> tuple[FloatArray, FloatArray]:
    """Complex shapes turned so that the sum of the squares of their real parts is largest.

    Args:
        shapes: complex[entries, points]; NaN where a point did not measure.

    Returns:
        float[entries, points], and the share of each that is real.

    >>> turned, share = as_real(np.array([[1j, -2j]]))
    >>> np.abs(turned.round(9)).tolist(), share.tolist()
    ([[1.0, 2.0]], [1.0])
    """
    angle = 0.5 * np.angle(np.nansum(shapes**2, axis=1))
    turned = shapes * np.exp(-1j * angle)[:, None]
    whole = np.nansum(np.abs(turned) ** 2, axis=1)
    real = np.nansum(turned.real**2, axis=1)
    return turned.real, np.divide(real, whole, out=np.ones_like(whole), where=whole > 0)


def _shapes(table: Table, points: tuple[str, ...]) -> tuple[FloatArray, FloatArray]:
    rows = table.frame.height
    real = np.array([table.numbers(name) for name in points]).reshape(-1, rows).T
    phased = [name for name in points if name + IMAGINARY in table.frame.columns]
    if not phased:
        return real, np.ones(rows)
    if len(phased) < len(points):
        lacking = next(name for name in points if name not in phased)
        raise InputError(
            f"there is no column {lacking + IMAGINARY!r}, and other points have an imaginary part",
            str(table.path),
            "give it for all points, or for none",
        )
    imaginary = np.array([table.numbers(name + IMAGINARY) for name in points])
    return as_real(real + 1j * imaginary.reshape(-1, rows).T)


def _time(table: Table) -> tuple[FloatArray, str | float]:
    """Times of all lines; several modes of one window have the same."""
    if TIME not in table.frame.columns:
        raise InputError(
            f"there is no column {TIME!r}",
            f"{table.path}, columns {', '.join(table.frame.columns[:12])}",
            "give the middle of each window in a column time",
        )
    stamps = table.frame[TIME]
    if stamps.null_count():
        row = int(np.argmax(stamps.is_null().to_numpy()))
        raise InputError("there is no time", table.where(row, TIME), "give one")
    numbered = table.frame.select(TIME).with_row_index("row")
    once = _in_time(numbered.unique(TIME, keep="first", maintain_order=True))
    rows_once = once["row"].to_list()
    clock = read_clock(replace(table, frame=table.frame[rows_once], rows=rows_once), TimeColumns())
    number = {stamp: row for row, stamp in enumerate(once[TIME])}
    rows = np.array([number[stamp] for stamp in stamps], dtype=np.int64)
    return clock.seconds[rows], clock.start


def _in_time(once: pl.DataFrame) -> pl.DataFrame:
    """Lines in the order of their times, where that of these is told without a calendar."""
    stamps = once[TIME]
    number = stamps.cast(pl.Float64, strict=False)
    if not number.null_count():
        return once[number.arg_sort()]
    year_first = stamps.cast(pl.String).str.contains(r"^\d{4}-").all()
    return once.sort(TIME) if year_first else once


def _given(table: Table, column: str) -> FloatArray:
    if column not in table.frame.columns:
        return np.full(table.frame.height, np.nan)
    return table.numbers(column)


def _above_zero(table: Table, column: str) -> FloatArray:
    found = _given(table, column)
    bad = found <= 0
    if bad.any():
        row = int(np.argmax(bad))
        raise InputError(
            f"{found[row]:g} is not above zero", table.where(row, column), "leave the cell empty"
        )
    return found
