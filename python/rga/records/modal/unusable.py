"""What stands in a modal table and cannot be meant: shapes without phase, of zero, of two units."""

from collections.abc import Collection, Sequence

import numpy as np
import polars as pl

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.records.modal.columns import IMAGINARY
from rga.records.table import Table

#: endings of columns with what is no part of a complex shape
OF_POLAR = ("_phase", "_angle", "_arg", "_abs", "_mag", "_amplitude")
#: a complex number in one cell
COMPLEX = r"^\(?[-+0-9.eE ]+[-+][-+0-9.eE ]*[ij]\)?$"
#: share of the largest by which values of a context may differ in a window: rounding
ROUNDING = 1e-6


def check_phases(table: Table, points: Collection[str]) -> None:
    """Refuse shapes by amplitude and phase, and complex numbers in one cell.

    Raises:
        InputError: a column of a point has such.
    """
    columns = set(table.frame.columns)
    remedy = "give real parts in {0} and imaginary parts in {0}" + IMAGINARY
    for name in points:
        for polar in (name + ending for ending in OF_POLAR if name + ending in columns):
            what = f"column {polar!r} states a shape by amplitude and phase"
            raise InputError(what, str(table.path), remedy.format(name))
        if name in columns and table.frame[name].dtype == pl.String:
            told = table.frame[name].str.contains(COMPLEX).fill_null(False).to_numpy()
            if told.any():
                row = int(np.argmax(told))
                what = f"{table.frame[name][row]!r} is a complex number"
                raise InputError(what, table.where(row, name), remedy.format(name))


def check_shapes(table: Table, points: Sequence[str], shapes: FloatArray) -> None:
    """Refuse shapes in which nothing moves: it would be like no mode, and like all.

    Args:
        table: for places.
        points: of the columns.
        shapes: float[lines, points]; NaN where a point did not measure.

    Raises:
        InputError: a line has such.
    """
    seen = np.isfinite(shapes).any(axis=1)
    still = seen & ~(np.nansum(shapes**2, axis=1) > 0.0)
    if still.any():
        row = int(np.argmax(still))
        raise InputError(
            f"the shape is zero at every point, as in {int(still.sum())} of {len(shapes)} lines",
            f"{table.where(row)}, columns {', '.join(points[:6])}",
            "leave the cells empty where no shape was measured",
        )


def one_unit(table: Table, columns: Sequence[str], units: Sequence[str]) -> None:
    """Refuse shapes whose points are in different units: a shape has one scale.

    Args:
        table: for its place.
        columns: of the points.
        units: that they state, empty where they state none.

    Raises:
        InputError: two differ.
    """
    for column, unit in zip(columns, units, strict=True):
        if unit != units[0]:
            said = [one or "no unit" for one in (units[0], unit)]
            raise InputError(
                f"{columns[0]!r} is in {said[0]} and {column!r} in {said[1]}",
                str(table.path),
                "give the shape at all points in one unit: it has one scale",
            )


def check_window(table: Table, name: str, column: FloatArray, time: FloatArray) -> None:
    """Refuse a context that differs from line to line of one window.

    Raises:
        InputError: it does.
    """
    _, number = np.unique(time, return_inverse=True)
    number = number.ravel()
    first = np.full(int(number.max(initial=-1)) + 1, np.nan)
    known = np.flatnonzero(np.isfinite(column))
    first[number[known][::-1]] = column[known][::-1]
    size = float(np.nanmax(np.abs(column), initial=0.0))
    off = np.abs(column - first[number]) > ROUNDING * size
    if off.any():
        row = int(np.argmax(off))
        raise InputError(
            f"{name!r} is {column[row]:g}, and {first[number[row]]:g} in another line of the same "
            "window",
            table.where(row, name),
            "give the mean over the window in all of its lines",
        )


def check_lines(table: Table, time: FloatArray) -> None:
    """Refuse two lines of a table with a line a window that have one time and are not the same.

    Raises:
        InputError: there are such.
    """
    line: dict[float, int] = {}
    for row, moment in enumerate(time.tolist()):
        first = line.setdefault(moment, row)
        if table.frame.row(first) != table.frame.row(row):
            raise InputError(
                "two lines have the same time",
                table.where(row),
                "give a line a window",
            )
