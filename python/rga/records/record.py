"""A measured record: time, sensor channels and the contexts that were measured."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError, kind_of
from rga.files import write_table
from rga.model.effect import seconds
from rga.notebook import short_html
from rga.quantities import counted

if TYPE_CHECKING:
    import polars as pl
    from matplotlib.axes import Axes

#: what no unit of any sensor reaches
LARGEST = 1e30


@dataclass(frozen=True)
class Record:
    """Measured data in the units of the model.

    Attributes:
        time: float[n], seconds since the first row of the file; strictly increasing.
        start: time stamp of the first row of the file: ISO 8601 text, or seconds.
        time_format: how the file gives time, "iso" or "seconds".
        sensors: names of the channels present, in the order of the model.
        readings: float[n, len(sensors)], NaN where a value is missing.
        contexts: measured context variables, float[n] each, NaN where a value is missing.
        unused: channels that are left out, with the reason.
        zero: interval [s since the first row] whose mean was taken off every channel, if any.
        warnings: what the reader should know of the data, in words.
        notes: what was understood of the files, and what was assumed, in words.
        sha256: hash of the file.

    Raises:
        InputError: times, readings or contexts are no numbers, are not of these shapes, or times
            do not rise.

    >>> record = Record(np.arange(3.0), 10.0, "seconds", ("D1",), np.zeros((3, 1)))
    >>> record.time_label(1.5)
    11.5
    >>> record.rows(slice(1, None)).time
    array([1., 2.])
    """

    time: FloatArray
    start: str | float
    time_format: Literal["iso", "seconds"]
    sensors: tuple[str, ...]
    readings: FloatArray
    contexts: dict[str, FloatArray] = field(default_factory=dict)
    unused: dict[str, str] = field(default_factory=dict)
    zero: tuple[float, float] | None = None
    warnings: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    sha256: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.contexts, Mapping):
            what = f"{kind_of(self.contexts)} holds no contexts"
            raise InputError(what, "record", "give their values by their names")
        time = _floats(self.time, "time")
        rows, columns = (time.size,), (len(self.sensors),)
        found = {
            "time": _shaped(time, rows, "time"),
            "readings": _shaped(_floats(self.readings, "readings"), rows + columns, "readings"),
            "contexts": {
                name: _shaped(_floats(values, f"context {name!r}"), rows, f"context {name!r}")
                for name, values in self.contexts.items()
            },
        }
        for name, given in found.items():
            object.__setattr__(self, name, given)
        if not (np.isfinite(self.time).all() and (np.diff(self.time) > 0).all()):
            raise InputError("the times do not rise", "record", "sort the rows, each with its time")

    def __len__(self) -> int:
        return len(self.time)

    @property
    def origin(self) -> float:
        """Time of the first row on the scale of onsets [s]: as in the file, or since 1970."""
        return seconds(self.start)

    def time_label(self, elapsed: float) -> str | float:
        """A time [s since the first row] as the record writes it: ISO 8601 text, or seconds."""
        return time_label(self.start, elapsed)

    def rows(self, chosen: NDArray[np.bool_] | NDArray[np.int64] | slice) -> "Record":
        """The chosen rows; time still counts from the first row of the file.

        Raises:
            InputError: there are no such rows, or their times do not rise.
        """
        try:
            time = self.time[chosen]
        except (IndexError, ValueError) as error:
            what = f"there are no such rows: {error}"
            raise InputError(what, "record", "choose others") from None
        return replace(
            self,
            time=time,
            readings=self.readings[chosen],
            contexts={name: values[chosen] for name, values in self.contexts.items()},
        )

    def plot(self, ax: "Axes | None" = None, channels: Sequence[str] | None = None) -> "Axes":
        """Channels and measured contexts over time in axes of matplotlib.

        Args:
            ax: axes; None: those of a new figure.
            channels: names; None: all, the first 40.

        Raises:
            InputError: the record has no row, or no such channel.
        """
        # What draws stands above the records: it is reached through the front of the package.
        import rga

        return rga.plot_record(self, ax, channels)

    def to_frame(self) -> "pl.DataFrame":
        """Time and all channels and contexts, one row a reading.

        Time is that of the record's clock where it writes dates, else seconds.

        >>> Record(np.arange(2.0), 10.0, "seconds", ("D1",), np.ones((2, 1))).to_frame().rows()
        [(10.0, 1.0), (11.0, 1.0)]
        """
        import polars as pl

        if isinstance(self.start, str):
            # Dates without a zone: the clock of the record is kept as it is.
            first = datetime.fromisoformat(self.start).replace(tzinfo=None)
            steps = pl.Series(np.round(self.time * 1e6).astype(np.int64)).cast(pl.Duration("us"))
            time = pl.Series("time", [first] * len(self), dtype=pl.Datetime("us")) + steps
        else:
            time = pl.Series("time", self.start + self.time)
        columns = [pl.Series(name, self.readings[:, k]) for k, name in enumerate(self.sensors)]
        columns += [pl.Series(name, values) for name, values in self.contexts.items()]
        return pl.DataFrame([time, *columns])

    def write(self, path: str | Path) -> None:
        """Write all rows in the units of the model, as CSV or Parquet; `load_record` reads them.

        What was taken off the readings as a zero is to be stated for the new file too.

        Raises:
            InputError: another format, or a place that cannot be written to.

        >>> from tempfile import TemporaryDirectory
        >>> record = Record(np.arange(2.0), 10.0, "seconds", ("D1",), np.array([[0.1], [np.nan]]))
        >>> with TemporaryDirectory() as folder:
        ...     record.write(f"{folder}/record.csv")
        ...     print(Path(f"{folder}/record.csv").read_text())
        time,D1
        10.0,0.1
        11.0,
        <BLANKLINE>
        """
        import polars as pl

        columns = {name: self.readings[:, k] for k, name in enumerate(self.sensors)}
        frame = pl.DataFrame({**columns, **self.contexts}).fill_nan(None)
        time = pl.Series("time", [self.time_label(one) for one in self.time.tolist()])
        write_table(frame.insert_column(0, time), path)

    def _repr_html_(self) -> str:
        last = self.time_label(self.time[-1]) if len(self) else self.start
        first = self.time_label(self.time[0]) if len(self) else self.start
        channels = f"{len(self.sensors)} channels and {len(self.contexts)} contexts"
        said = f"{counted(len(self), 'row')} of {channels}, from {first} to {last}"
        return short_html("record", said, self.to_frame())

    def channels(self, keep: Sequence[str]) -> "Record":
        """The record with the sensors `keep` only, in their present order.

        Raises:
            KeyError: a sensor to keep is not in the record.
        """
        if absent := set(keep) - set(self.sensors):
            raise KeyError(f"the record has no channel {sorted(absent)}")
        columns = [column for column, name in enumerate(self.sensors) if name in keep]
        return replace(
            self,
            sensors=tuple(self.sensors[column] for column in columns),
            readings=self.readings[:, columns],
        )


def _floats(given: object, name: str) -> FloatArray:
    """Numbers as they are computed with: the same array where it is one of floats.

    Raises:
        InputError: these are no numbers.
    """
    try:
        found = np.asarray(given)
    except (TypeError, ValueError):
        found = np.asarray(None)
    # What a mask hides would be read.
    if found.dtype.kind not in "fiu" or isinstance(given, np.ma.MaskedArray):
        remedy = "give an array of floats, NaN where a value is missing"
        raise InputError("these are no plain numbers", f"{name} of the record", remedy)
    return found.astype(np.float64, copy=False)


def _shaped(values: FloatArray, shape: tuple[int, ...], name: str) -> FloatArray:
    """Values, where there is one for every row, and for every sensor if they are readings.

    Raises:
        InputError: there is not.
    """
    if values.shape != shape:
        what, where = f"its shape is {values.shape} instead of {shape}", f"{name} of the record"
        raise InputError(what, where, "give a value for every row and sensor")
    return values


def time_label(start: str | float, elapsed: float) -> str | float:
    """A time as a record writes it: ISO 8601 text, or seconds.

    Args:
        start: time stamp of its first row, in the same way.
        elapsed: seconds since the first row.

    >>> time_label("2026-03-01T12:00:00", 90.5)
    '2026-03-01T12:01:30.500'
    """
    if isinstance(start, str):
        moment = datetime.fromisoformat(start) + timedelta(seconds=float(elapsed))
        whole_ms = moment.microsecond and moment.microsecond % 1000 == 0
        return moment.isoformat(timespec="milliseconds" if whole_ms else "auto")
    return round(start + float(elapsed), 9)
