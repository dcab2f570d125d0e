"""NetCDF files of long monitoring with pyOMA (Weimar): time x modes x channels.

Source: pyoma-monitoring, `monitoring.py`: NetCDF-4, written by xarray and h5netcdf, with variables
`frequencies`, `std_frequencies`, `damping` (time, modes) and `modeshapes` (time, modes, channels),
complex; damping in per cent; `time` the begin of each window in UTC, `length` its samples and
`sample_rate` [Hz]. Modes are numbered window by window: a number is no identity.
"""

import re
from datetime import UTC, datetime
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from rga.errors import InputError
from rga.lazy import needing_extras
from rga.records.formats.bounds import most_values
from rga.records.modal.columns import DAMPING, DEVIATION, DURATION, FREQUENCY, TIME
from rga.records.modal.formats.entries import table_of_entries
from rga.records.table import Table

#: how files begin: HDF5, which NetCDF-4 is, and classic NetCDF
MARK, CLASSIC = b"\x89HDF\r\n\x1a\n", (b"CDF\x01", b"CDF\x02", b"CDF\x05")
FREQUENCIES, DEVIATIONS, RATIOS, SHAPES = "frequencies", "std_frequencies", "damping", "modeshapes"
SAMPLES, RATE, CHANNELS = "length", "sample_rate", "channels"
#: seconds of a unit of time
_UNITS = {
    "days": 86400.0, "hours": 3600.0, "minutes": 60.0, "seconds": 1.0, "milliseconds": 1e-3,
    "microseconds": 1e-6, "nanoseconds": 1e-9,
}  # fmt: skip
_SINCE = re.compile(r"(\w+) since (\d{4}-\d\d-\d\d)[ T]?(\d\d:\d\d:\d\d(?:\.\d{1,6})?\d*)?Z?")
_CALENDARS = ("standard", "gregorian", "proleptic_gregorian")


def is_netcdf(data: bytes) -> bool:
    """Whether a file is NetCDF by its first bytes."""
    return data.startswith((MARK, *CLASSIC))


def read_netcdf(data: bytes, path: Path) -> Table:
    """The modal record of such a file; the time becomes that of the middle of each window.

    Raises:
        InputError: it is damaged or classic, lacks a variable, has frequencies in another unit
            than Hz, or its dimensions do not fit.
        MissingPackageError: pyfive, which reads HDF5, is not installed.
    """
    if not data.startswith(MARK):
        raise InputError(
            "this is classic NetCDF, which holds no complex shapes",
            str(path),
            "write NetCDF-4, by xarray: to_netcdf(..., engine='h5netcdf')",
        )
    with needing_extras():
        import pyfive
    try:
        file = pyfive.File(BytesIO(data))
        variables = {name: file[name] for name in file}
        read = {name: _read(variables, name, len(data)) for name in _needed(variables)}
        told = {name: _words(variables[name].attrs) for name in (TIME, FREQUENCIES) if name in read}
    except MemoryError:
        raise
    except Exception as error:  # pyfive says what is damaged in many ways
        raise InputError(
            f"the NetCDF file cannot be read: {' '.join(str(error).split())[:200]}",
            str(path),
            "copy it again in full",
        ) from None
    return _table(read, told, path)


def _needed(variables: dict[str, Any]) -> list[str]:
    wanted = (TIME, FREQUENCIES, DEVIATIONS, RATIOS, SHAPES, SAMPLES, RATE, CHANNELS)
    return [name for name in wanted if name in variables]


def _read(variables: dict[str, Any], name: str, size: int) -> np.ndarray:
    if np.prod(variables[name].shape, dtype=float) > most_values(size):
        raise ValueError(f"{name} has far more numbers than its size lets results be")
    return np.asarray(variables[name][...])


def _words(attributes: Any) -> dict[str, str]:
    """Attributes that are words."""
    said = {name: attributes[name] for name in ("units", "calendar") if name in attributes}
    return {
        name: one.decode() if isinstance(one, bytes) else str(one) for name, one in said.items()
    }


def _table(read: dict[str, np.ndarray], told: dict[str, dict[str, str]], path: Path) -> Table:
    for name in (TIME, FREQUENCIES):
        if name not in read:
            raise InputError(
                f"there is no variable {name!r}",
                f"{path}, variables {', '.join(read) or 'of other names'}",
                "give a file of modal results, as pyOMA writes it for monitoring",
            )
    unit = told[FREQUENCIES].get("units", "Hz")
    if unit != "Hz":
        raise InputError(f"{FREQUENCIES} are in {unit!r}", str(path), "give them in Hz")
    frequency = read[FREQUENCIES]
    if frequency.ndim != 2 or len(frequency) != read[TIME].size:
        raise _unfit(FREQUENCIES, frequency, "time and modes", path)
    windows, modes = frequency.shape
    for name in (DEVIATIONS, RATIOS):
        if name in read and read[name].shape != frequency.shape:
            raise _unfit(name, read[name], "time and modes", path)
    duration = np.full(windows, np.nan)
    if {SAMPLES, RATE} <= read.keys() and read[SAMPLES].shape == read[RATE].shape == (windows,):
        duration = np.divide(read[SAMPLES], read[RATE], where=read[RATE] > 0, out=duration)
    begin = _seconds(read[TIME], told[TIME], path)
    middle = begin + np.nan_to_num(duration) / 2
    columns: dict[str, Any] = {
        TIME: np.repeat([datetime.fromtimestamp(one, UTC).isoformat() for one in middle], modes),
        DURATION: np.repeat(duration, modes),
        FREQUENCY: frequency.ravel().astype(float),
    }
    if DEVIATIONS in read:
        columns[DEVIATION] = read[DEVIATIONS].ravel().astype(float)
    if RATIOS in read:
        columns[DAMPING] = read[RATIOS].ravel() / 100.0
    shapes, channels = np.zeros((windows, modes, 0)), list[str]()
    if SHAPES in read:
        shapes = read[SHAPES]
        channels = [
            one.decode() if isinstance(one, bytes) else str(one)
            for one in read.get(CHANNELS, np.zeros(0)).ravel()
        ]
        if shapes.shape != (windows, modes, len(channels)):
            raise _unfit(SHAPES, shapes, "time, modes and channels", path)
    flat = shapes.reshape(windows * modes, len(channels))
    return table_of_entries(path, "NetCDF of pyOMA", columns, flat, channels)


def _seconds(time: np.ndarray, told: dict[str, str], path: Path) -> np.ndarray:
    """Times [s since 1970] by the conventions of climate and forecast (CF), in UTC."""
    said = _SINCE.fullmatch(told.get("units", ""))
    if said is None or said[1] not in _UNITS or told.get("calendar", "standard") not in _CALENDARS:
        raise InputError(
            f"the unit of the time is {told.get('units', 'not said')!r}",
            str(path),
            "give 'minutes since 2026-03-01 12:00:00', say, of the usual calendar",
        )
    start = datetime.fromisoformat(f"{said[2]}T{said[3] or '00:00:00'}").replace(tzinfo=UTC)
    seconds = start.timestamp() + time.ravel() * _UNITS[said[1]]
    # Of a clock that is not set nothing can be said, nor of one beyond the year 9999.
    if not (np.abs(seconds) < 2e11).all():
        raise InputError("a time lies beyond all years", str(path), "mend the times")
    return np.asarray(seconds, dtype=float)


def _unfit(name: str, found: np.ndarray, wanted: str, path: Path) -> InputError:
    shape = " x ".join(map(str, found.shape))
    return InputError(f"{name} has the dimensions {shape}", str(path), f"give {wanted}")
