"""Results of pyOMA2: arrays Fn, Xi, Phi and Fn_std, of one window or of several."""

import json
import zipfile
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from rga.bounded_files import fault_of
from rga.errors import InputError
from rga.records.formats.bounds import most_values
from rga.records.formats.matlab import is_matlab
from rga.records.formats.matlab_file import arrays_of
from rga.records.modal.columns import DAMPING, DEVIATION, DURATION, FREQUENCY, TIME
from rga.records.modal.formats.entries import table_of_entries
from rga.records.table import Table

#: arrays of a result, and what may stand beside them
FREQUENCIES, RATIOS, SHAPES, DEVIATIONS = "Fn", "Xi", "Phi", "Fn_std"
IMAGINARY_SHAPES, POINTS = "Phi_im", "points"
RESULT = (FREQUENCIES, RATIOS, SHAPES, DEVIATIONS, IMAGINARY_SHAPES)
ARRAYS = (*RESULT, POINTS, TIME, DURATION)
_PACKED = b"PK\x03\x04"


def arrays_of_file(data: bytes, path: Path) -> dict[str, Any] | None:
    """The arrays of a result in a file; None: it has no Fn, and is something else.

    Args:
        data: what is in the file: .npz of NumPy, .mat of MATLAB 4 to 7, or JSON with an object of
            lists. Objects that Python would have to rebuild (pickles) are never read.
        path: the file.

    Raises:
        InputError: it is damaged, holds pickles, or unpacks to far more than its size.
    """
    try:
        if data.startswith(_PACKED):
            return _of_numpy(data)
        if is_matlab(data, path) and not data.startswith((b"MATLAB 7.3", b"\x89HDF")):
            return _known({name.rpartition(".")[2]: one for name, one in arrays_of(data)})
        if data.lstrip()[:1] == b"{" and f'"{FREQUENCIES}"'.encode() in data:
            content = json.loads(data)
            return _known(content) if isinstance(content, dict) else None
    except (ValueError, RecursionError, OSError, zipfile.BadZipFile, EOFError) as error:
        raise InputError(
            f"the arrays cannot be read, {fault_of(error)[:200]}",
            str(path),
            "save Fn, Xi, Phi and Fn_std again, by numpy.savez",
        ) from None
    return None


def _of_numpy(data: bytes) -> dict[str, Any] | None:
    with zipfile.ZipFile(BytesIO(data)) as parts:
        if f"{FREQUENCIES}.npy" not in parts.namelist():
            return None
        room = 16 * most_values(len(data))
        if sum(one.file_size for one in parts.infolist()) > room:
            raise ValueError("it unpacks to far more than its size lets results be")
    with np.load(BytesIO(data), allow_pickle=False) as arrays:
        return {name: arrays[name] for name in ARRAYS if name in arrays.files}


def _known(content: Mapping[str, Any]) -> dict[str, Any] | None:
    if FREQUENCIES not in content:
        return None
    return {name: content[name] for name in ARRAYS if name in content}


def table_of_arrays(arrays: Mapping[str, Any], path: Path) -> Table:
    """The modal record of arrays.

    Args:
        arrays: Fn [Hz], Xi [-] and Fn_std [Hz], each float[modes]; Phi, float or
            complex[channels, modes], or its imaginary part as Phi_im. Of several windows all have
            windows as a first axis, and NaN where a mode is missing. Beside them may stand
            `points`, names of the channels (left out: channel_1, channel_2, ...), `time` of the
            middle of each window (ISO 8601 or seconds; left out: 0, of one window alone) and
            `duration` [s].
        path: where they are from.

    Raises:
        InputError: their dimensions do not fit, one holds no numbers, or none has a frequency.

    >>> arrays = {"Fn": [1.5, 4.0], "Phi": [[1.0, 0.5], [2.0, -1.0]], "points": ["A1", "A2"]}
    >>> table_of_arrays(arrays, Path("a.npz")).frame.select("f", "A1", "A2").rows()
    [(1.5, 1.0, 2.0), (4.0, 0.5, -1.0)]
    """
    where = str(path)
    frequency = np.atleast_2d(_numbers(arrays, FREQUENCIES, where))
    if frequency.ndim > 2 or not frequency.size:
        raise _unfit(FREQUENCIES, frequency.shape, "modes, or windows and modes", where)
    windows, modes = frequency.shape
    columns = {FREQUENCY: frequency.ravel()}
    for name, column in ((DEVIATIONS, DEVIATION), (RATIOS, DAMPING)):
        if arrays.get(name) is not None:
            columns[column] = _like(_numbers(arrays, name, where), frequency, name, where).ravel()
    shapes, channels = _shapes(arrays, windows, modes, where)
    times = _of_windows(arrays.get(TIME), windows, TIME, where)
    if times is None and windows > 1:
        raise InputError(
            f"there are {windows} windows, and no time", where, "give the middle of each as time"
        )
    durations = _of_windows(arrays.get(DURATION), windows, DURATION, where)
    said: dict[str, Any] = {TIME: np.repeat(np.zeros(1) if times is None else times, modes)}
    if durations is not None:
        said[DURATION] = np.repeat(durations, modes)
    return table_of_entries(path, "results of pyOMA2", said | columns, shapes, channels)


def _shapes(
    arrays: Mapping[str, Any], windows: int, modes: int, where: str
) -> tuple[np.ndarray, list[str]]:
    """Shapes, complex[windows * modes, channels], and names of the channels."""
    if arrays.get(SHAPES) is None:
        if arrays.get(IMAGINARY_SHAPES) is not None:
            raise InputError(
                f"there is {IMAGINARY_SHAPES} and no {SHAPES}", where, "give the real part as well"
            )
        return np.zeros((windows * modes, 0)), []
    shapes = _numbers(arrays, SHAPES, where)
    if shapes.ndim < 2:  # MATLAB forgets axes of one
        shapes = shapes.reshape((-1, modes) if windows == 1 else (windows, -1, modes))
    shapes = shapes[None] if shapes.ndim == 2 and windows == 1 else shapes
    if shapes.ndim != 3 or (len(shapes), shapes.shape[2]) != (windows, modes):
        given = shapes.shape[1:] if windows == 1 else shapes.shape
        raise _unfit(SHAPES, given, f"channels and {modes} modes", where)
    if arrays.get(IMAGINARY_SHAPES) is not None:
        imaginary = _numbers(arrays, IMAGINARY_SHAPES, where)
        shapes = shapes + 1j * _like(imaginary, shapes, IMAGINARY_SHAPES, where)
    count = shapes.shape[1]
    points = arrays.get(POINTS)
    names = [f"channel_{k}" for k in range(1, count + 1)]
    if points is not None:
        names = [str(one) for one in np.ravel(np.asarray(points))]
    if len(names) != count:
        raise InputError(
            f"there are {len(names)} points, and {SHAPES} has {count} channels",
            where,
            "name the channels in their order",
        )
    return shapes.transpose(0, 2, 1).reshape(windows * modes, count), names


def _numbers(arrays: Mapping[str, Any], name: str, where: str) -> np.ndarray:
    try:
        found = np.asarray(arrays[name])
        if not np.iscomplexobj(found):
            found = found.astype(float)
        elif name != SHAPES:
            raise ValueError
    except (TypeError, ValueError):
        raise InputError(
            f"{name} holds no numbers, or lists of unequal length",
            where,
            "give an array, NaN where a mode is missing",
        ) from None
    return found


def _like(found: np.ndarray, other: np.ndarray, name: str, where: str) -> np.ndarray:
    if found.size != other.size:
        raise _unfit(name, found.shape, f"{other.shape[-1]} modes as {FREQUENCIES}", where)
    return found.reshape(other.shape)


def _of_windows(given: Any, windows: int, name: str, where: str) -> np.ndarray | None:
    """A value for each window, of one for each or of one for all."""
    if given is None:
        return None
    found = np.ravel(np.asarray(given))
    if found.dtype.kind in "OM":
        found = found.astype(str)
    if len(found) not in ({windows} if name == TIME else {1, windows}):
        raise InputError(
            f"{name} has {len(found)} values, and there are {windows} windows",
            where,
            "give one a window",
        )
    return np.broadcast_to(found, windows)


def _unfit(name: str, shape: tuple[int, ...], wanted: str, where: str) -> InputError:
    return InputError(
        f"{name} has the dimensions {' x '.join(map(str, shape)) or '0'}",
        where,
        f"give {wanted}",
    )
