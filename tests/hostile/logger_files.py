"""Files as loggers write them, of which nothing is wrong."""

import io
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

UNITS = {"D1": "mm", "S1": "microstrain", "S2": "microstrain", "temperature": "degC"}
#: seconds of 1970 at which records begin, and between their rows
BEGINS, STEP = 1_772_323_200, 3600


def catman_binary(channels: list[tuple[str, str, int, list[float]]]) -> bytes:
    """A catman file of version 5012: name, unit, bytes of a number and numbers of each channel."""

    def text(value: str, kind: str = "<h") -> bytes:
        return struct.pack(kind, len(value)) + value.encode("cp1252")

    heads, data = b"", b""
    for number, (name, unit, width, values) in enumerate(channels):
        extended = bytearray(148)
        struct.pack_into("<dd", extended, 0, 45323.5, 10.0)
        extended[140] = {8: 0, 4: 1, 2: 2}[width]
        heads += struct.pack("<hi", number, len(values)) + text(name) + text(unit) + text("")
        heads += struct.pack("<hhdi", 0, 8, 45323.5, 148) + bytes(extended)
        heads += bytes(3) + struct.pack("<h", 0) + text("") + text("", "<i")
        if width == 2:
            low, high = min(values), max(values)
            steps = [round((value - low) / (high - low or 1) * 32767) for value in values]
            data += struct.pack("<dd", low, high) + np.array(steps, "<u2").tobytes()
        else:
            data += np.array(values, f"<f{width}").tobytes()
    head = text("") + text("") * 32 + struct.pack("<hi", len(channels), 0)
    head += bytes(4 * len(channels)) + bytes(4) + heads
    return struct.pack("<hi", 5012, 6 + len(head)) + head + data


def tdms(frame: pl.DataFrame, *, timed: bool) -> bytes:
    """Channels of a waveform, or with a time of their own, in two segments."""
    nptdms = pytest.importorskip("nptdms")
    waveform = {} if timed else {"wf_start_time": np.datetime64(BEGINS, "s"), "wf_increment": STEP}
    content = io.BytesIO()
    with nptdms.TdmsWriter(content) as writer:
        for part in (slice(0, len(frame) // 2), slice(len(frame) // 2, len(frame))):
            objects = [
                nptdms.ChannelObject("strain", name, frame[name].to_numpy()[part], waveform)
                for name in frame.columns
            ]
            if timed:
                moments = _seconds(frame)[part].astype("datetime64[s]").astype("datetime64[us]")
                objects.append(nptdms.ChannelObject("strain", "moment", moments))
            writer.write_segment(objects)
    return content.getvalue()


def matlab(frame: pl.DataFrame, *, packed: bool, form: str = "5") -> bytes:
    """Vectors beside a struct of a matrix, and words; of version 4, vectors alone."""
    from scipy.io import savemat

    values: dict[str, Any] = {name: frame[name].to_numpy() for name in frame.columns}
    values["t"] = STEP * np.arange(len(frame), dtype=float)
    if form == "5":
        values |= {"more": {"fs": 0.5, "inner": {"matrix": np.ones((2, 2))}}, "word": "x"}
        values["words"] = np.array(["x", "y"], dtype=object)
    content = io.BytesIO()
    savemat(content, values, do_compression=packed, format=form)
    return content.getvalue()


def catman(frame: pl.DataFrame, width: int) -> bytes:
    """Channels of a width of numbers [bytes], behind their time."""
    time = [float(STEP * k) for k in range(len(frame))]
    channels = [(name, UNITS[name], width, frame[name].to_list()) for name in frame.columns]
    return catman_binary([("Time  1 - default sample rate", "s", 8, time), *channels])


def catman_text(frame: pl.DataFrame) -> str:
    """Its export as text, with decimal commas."""
    names = "\t".join(f"{name} [{UNITS[name]}] CH={k}" for k, name in enumerate(frame.columns))
    rows = "\n".join(
        "\t".join(f"{value:.6f}".replace(".", ",") for value in (STEP * k, *row))
        for k, row in enumerate(frame.iter_rows())
    )
    head = f"catmanEasy\nT0 = 01.03.2026 00:00:00\n\nZeit  1 - Standardmessrate [s]\t{names}"
    return f"{head}\n{rows}\n"


def labview(frame: pl.DataFrame) -> str:
    """A segment of its text files, whose rows are counted."""
    count = len(frame.columns)
    head = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t.\nX_Columns\tNo\n"
    said = {
        "Channels": str(count), "Samples": "\t".join(count * [str(len(frame))]),
        "Date": "\t".join(count * ["2026/03/01"]), "Time": "\t".join(count * ["00:00:00"]),
        "Y_Unit_Label": "\t".join(UNITS.values()), "X0": "\t".join(count * ["0"]),
        "Delta_X": "\t".join(count * [str(STEP)]), "***End_of_Header***": "",
    }  # fmt: skip
    segment = "\n".join(f"{name}\t{value}" for name, value in said.items())
    names = "\t".join(("X_Value", *frame.columns, "Comment"))
    rows = "\n".join("\t" + "\t".join(map(str, row)) for row in frame.iter_rows())
    return f"{head}***End_of_Header***\t\n\n{segment}\n{names}\n{rows}\n"


def toa5(frame: pl.DataFrame) -> str:
    """A table of a Campbell logger."""
    names = ",".join(f'"{name}"' for name in frame.columns)
    units = ",".join(f'"{unit}"' for unit in UNITS.values())
    kinds = ",".join('"Smp"' for _ in frame.columns)
    rows = "\n".join(
        f'"{moment}",{k},{",".join(map(str, row))}'
        for k, (moment, row) in enumerate(zip(_moments(frame), frame.iter_rows(), strict=True))
    )
    return (
        f'"TOA5","L","CR6","1","2","3","4","Hourly"\n"TIMESTAMP","RECORD",{names}\n'
        f'"TS","RN",{units}\n"","",{kinds}\n{rows}\n'
    )


def mts(frame: pl.DataFrame) -> str:
    """A table of a testing machine."""
    names = "\t".join(("Time", *frame.columns))
    units = "\t".join(("sec", *UNITS.values()))
    rows = "\n".join(
        "\t".join(map(str, (float(STEP * k), *row))) for k, row in enumerate(frame.iter_rows())
    )
    return f"MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A\n\nData Header:\n{names}\n{units}\n{rows}\n"


def line_protocol(frame: pl.DataFrame) -> str:
    """Points of a database of time series."""
    return "".join(
        f"bridge {','.join(f'{n}={v}' for n, v in row.items())} {BEGINS + STEP * k}\n"
        for k, row in enumerate(frame.iter_rows(named=True))
    )


def senml(frame: pl.DataFrame) -> str:
    """A pack of measurements."""
    pack: list[dict[str, Any]] = [
        {"n": name, "t": BEGINS + STEP * k, "v": value}
        for k, row in enumerate(frame.iter_rows(named=True))
        for name, value in row.items()
    ]
    return json.dumps(pack)


def sensorthings(frame: pl.DataFrame) -> str:
    """Observations of a server."""
    value = [
        {"phenomenonTime": f"{moment}Z".replace(" ", "T"), "result": result,
         "Datastream": {"name": name, "unitOfMeasurement": {"symbol": UNITS[name]}}}
        for moment, row in zip(_moments(frame), frame.iter_rows(named=True), strict=True)
        for name, result in row.items()
    ]  # fmt: skip
    return json.dumps({"value": value})


def _seconds(frame: pl.DataFrame) -> np.ndarray[Any, Any]:
    return BEGINS + STEP * np.arange(len(frame))


def _moments(frame: pl.DataFrame) -> list[str]:
    return [str(one).replace("T", " ") for one in _seconds(frame).astype("datetime64[s]")]


def made(record: Path) -> dict[str, bytes]:
    """By name: files of a record, one of every logger that is known."""
    whole = pl.read_csv(record, try_parse_dates=True)
    frame = whole.select(*UNITS)
    content = io.BytesIO()
    whole.write_parquet(content)
    texts = {
        "catman.asc": catman_text(frame),
        "labview.lvm": labview(frame),
        "logger.dat": toa5(frame),
        "machine.dat": mts(frame),
        "points.lp": line_protocol(frame),
        "pack.json": senml(frame),
        "observations.json": sensorthings(frame),
    }
    return {
        "waveform.tdms": tdms(frame, timed=False),
        "timed.tdms": tdms(frame, timed=True),
        "plain.mat": matlab(frame, packed=False),
        "packed.mat": matlab(frame, packed=True),
        "old.mat": matlab(frame, packed=False, form="4"),
        "wide.bin": catman(frame, 8),
        "short.bin": catman(frame, 4),
        "steps.bin": catman(frame, 2),
        "table.parquet": content.getvalue(),
    } | {name: text.encode() for name, text in texts.items()}
