"""Observations of many channels, each with a time of its own, as columns of one table."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import polars as pl

from rga.errors import InputError
from rga.records.table import StatedTime, Table


def table_of_points(
    path: Path,
    points: pl.DataFrame,
    format_name: str,
    units: Mapping[str, str],
    names: Mapping[str, str],
    notes: Sequence[str] = (),
) -> Table:
    """A column for each channel, a row for each time, in the order of time.

    Args:
        path: the file.
        points: columns `time`, `channel` and `value`.
        format_name: as a reader is told.
        units: by channel.
        names: by channel, how else it is called.
        notes: what was understood of the file, in words.

    Raises:
        InputError: a channel has two values at one time.
    """
    doubled = points.filter(points.select("time", "channel").is_duplicated())
    if doubled.height:
        time, channel = doubled.row(0)[:2]
        raise InputError(f"{channel!r} has two values at {time}", str(path), "take one of them out")
    order = points["channel"].unique(maintain_order=True).to_list()
    if "time" in order:
        raise InputError("a channel has the name 'time'", str(path), "give it another")
    wide = points.pivot(on="channel", index="time", values="value").sort("time")
    frame = wide.select("time", *order)
    return Table(
        path=path,
        frame=frame,
        row_name="row in the order of time",
        first=1,
        format=format_name,
        units=dict(units),
        names=dict(names),
        time=StatedTime(("time",)),
        notes=tuple(notes),
    )
