"""TDMS files of National Instruments, by npTDMS."""

import logging
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl

from rga.errors import InputError
from rga.lazy import needing_extras
from rga.records.formats.blocks import chosen_block
from rga.records.formats.tdms_parts import check_parts, parts_of, with_rows_together
from rga.records.mapping import FileMapping
from rga.records.table import StatedTime, Table
from rga.records.times.named import time_of

if TYPE_CHECKING:
    from nptdms import TdmsChannel

MARK = b"TDSm"
_UNITS = ("unit_string", "NI_UnitDescription", "Unit", "unit", "Units")
#: starts before it are those of a clock that was never set: it begins at 1904
_FIRST_START = np.datetime64("1905-01-01")
#: column of the time, which the properties of a channel give
TIME = "time [s]"


def read_tdms(data: bytes, path: Path, mapping: FileMapping) -> Table:
    """Read a TDMS file: the first channels of one length and start, unless `block` is stated.

    Raises:
        InputError: it is damaged, has no channel with numbers, or was written in parts whose
            rows do not belong together.
        MissingPackageError: npTDMS is not installed.
    """
    with needing_extras():
        from nptdms import TdmsFile

    heard: list[str] = []
    try:
        with _listening(heard):
            parts = list(parts_of(data))
            file = TdmsFile.read(BytesIO(with_rows_together(data, parts)))
            known = [channel for group in file.groups() for channel in group.channels()]
            channels = [channel for channel in known if len(channel)]
            values = {channel.path: np.asarray(channel[:]) for channel in channels}
    except MemoryError:
        raise
    except Exception as error:  # npTDMS says what is damaged in many ways
        raise InputError(
            f"the TDMS file cannot be read: {' '.join(str(error).split()) or type(error).__name__}",
            str(path),
            "copy it again in full, or export it as CSV",
        ) from None
    blocks: dict[tuple[Any, ...], list[TdmsChannel]] = {}
    for channel in channels:
        kind = values[channel.path].dtype.kind
        if kind in "iufMb":
            blocks.setdefault(_timing(channel), []).append(channel)
    if not blocks:
        raise InputError("no channel with numbers is in the file", str(path), "give another file")
    said = [f"{len(one)} channels of {len(one[0])} rows" for one in blocks.values()]
    chosen, notes = chosen_block(list(blocks.values()), said, mapping.block, path)
    plain = Counter(channel.name for channel in chosen)
    names = {
        channel.path: channel.name
        if plain[channel.name] == 1
        else f"{channel.group_name}/{channel.name}"
        for channel in chosen
    }
    check_parts(parts, names, path)
    frame = pl.DataFrame({names[channel.path]: values[channel.path] for channel in chosen})
    units = {
        names[channel.path]: str(channel.properties[key])
        for channel in chosen
        for key in _UNITS[::-1]
        if channel.properties.get(key)
    }
    time, more = _time(chosen[0], frame, units)
    return Table(
        path=path,
        frame=frame,
        row_name="row",
        first=1,
        format="TDMS",
        units=units,
        time=time,
        notes=(*notes, *more, *([] if units else ["the file states no units"])),
        warnings=tuple(f"the file is not whole: {said[:200]}" for said in dict.fromkeys(heard)),
    )


@contextmanager
def _listening(heard: list[str]) -> Iterator[None]:
    """Takes up what npTDMS says on the screen of files that are cut off."""
    from nptdms.log import log_manager

    screen = log_manager.console_handler
    loggers = list(log_manager.loggers.values())
    listener = logging.Handler(logging.WARNING)
    listener.emit = lambda record: heard.append(record.getMessage())  # type: ignore[method-assign]
    for logger in loggers:
        logger.removeHandler(screen)
        logger.addHandler(listener)
    try:
        yield
    finally:
        for logger in loggers:
            logger.removeHandler(listener)
            logger.addHandler(screen)


def _timing(channel: "TdmsChannel") -> tuple[Any, ...]:
    keys = ("wf_start_time", "wf_start_offset", "wf_increment")
    return (len(channel), *(str(channel.properties.get(key)) for key in keys))


def _time(
    channel: "TdmsChannel", frame: pl.DataFrame, units: dict[str, str]
) -> tuple[StatedTime | None, list[str]]:
    """Time of a waveform by its properties, else of a channel that has it."""
    said = channel.properties
    if step := said.get("wf_increment"):
        seconds = float(step) if isinstance(step, int | float) else np.nan
        start = said.get("wf_start_time")
        if start is None:
            return StatedTime(step=seconds), ["the waveform has no start: seconds are taken"]
        try:
            offset = round(float(said.get("wf_start_offset") or 0.0) * 1e6)
            begin = np.datetime64(start, "us") + np.timedelta64(offset, "us")
            if begin < _FIRST_START:
                raise ValueError
        except (TypeError, ValueError, OverflowError):
            return StatedTime(step=seconds), ["its start cannot be read: seconds are taken"]
        return StatedTime(start=f"{begin}+00:00", step=seconds), []
    for name in frame.columns:
        if frame[name].dtype.is_temporal():
            return StatedTime((name,)), [f"{name} is the time (UTC)"]
    found = time_of(frame.head(1).cast(pl.String), units)
    if found is not None:
        return found, [f"{found.columns[0]} is the time"]
    return None, ["the file states no time: state [time] sampling_rate_hz"]
