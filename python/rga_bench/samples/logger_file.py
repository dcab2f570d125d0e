"""A record as a logger's own file: preamble, decimal commas, units as people write them."""

from datetime import datetime, timedelta
from typing import NamedTuple

import numpy as np

from rga_bench.synthetic.case import Case
from rga_bench.synthetic.noise import stream

#: units as they stand in the file, where they are not those of the model
WRITTEN = {"microstrain": "µm/m", "degC": "°C", "kN/m2": "kN/m²"}
DATE, TIME = "Datum", "Uhrzeit"
DATE_FORMAT, TIME_FORMAT = "%d.%m.%Y", "%H:%M:%S"
SPARE = "Reserve"
ENCODING = "cp1252"
#: steps of the file in a deviation of the noise
FINE = 20.0


class LoggerFile(NamedTuple):
    """A logger's file: its bytes, and the line of the columns' names, from 1 on."""

    content: bytes
    header_line: int


def logger_file(case: Case, site: str, station: str, start: datetime, seed: int) -> LoggerFile:
    """The record of a case as its logger wrote it.

    Args:
        site, station: what stands in the preamble.
        start: the time of the first row.
        seed: of the spare channel, and of which of the missing cells are said to be overranges.
    """
    rng = stream(seed, "logger file")
    units = {name: one["unit"] for name, one in case.model["sensors"].items()}
    units |= {name: one["unit"] for name, one in case.model["context"].items()}
    names = [*case.channels, SPARE]
    head = [
        f"Datenlogger DL-40;Seriennummer 40-{1000 + seed * 37 % 9000};Firmware 3.12",
        f"Bauwerk;{site}",
        f"Messstelle;{station}",
        f"Messintervall;{case.time[1] - case.time[0]:.0f} s",
        "Bemerkung;Dehnungen temperaturkompensiert, Wege positiv nach oben",
        "",
        ";".join([DATE, TIME, *names]),
        ";".join(["", "", *(WRITTEN.get(units[name], units[name]) for name in names[:-1]), "V"]),
    ]
    columns = [_cells(course, _decimals(name, case)) for name, course in case.channels.items()]
    columns.append(_cells(0.02 * rng.standard_normal(len(case.time)), 3))
    for cells in columns:
        for row in np.flatnonzero(np.array(cells) == ""):
            cells[row] = "Overrange" if rng.random() < 0.3 else "-9999"
    moments = [start + timedelta(seconds=float(since)) for since in case.time]
    rows = [
        ";".join([moment.strftime(DATE_FORMAT), moment.strftime(TIME_FORMAT), *cells])
        for moment, *cells in zip(moments, *columns, strict=True)
    ]
    text = "\r\n".join([*head, *rows]) + "\r\n"
    return LoggerFile(text.encode(ENCODING), len(head) - 1)


def _decimals(name: str, case: Case) -> int:
    sensor = case.model["sensors"].get(name)
    noise = 0.1 if sensor is None else float(sensor["noise"])
    return max(0, int(np.ceil(-np.log10(noise / FINE))))


def _cells(course: np.ndarray, decimals: int) -> list[str]:
    """Numbers as the file has them; nothing for one that is missing."""
    return ["" if np.isnan(x) else f"{x:.{decimals}f}".replace(".", ",") for x in course]
