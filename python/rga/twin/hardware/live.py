"""Sensors that go on reading: rows as they arrive, out of the inbox of a twin."""

from datetime import datetime

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.simulation import Simulator
from rga.twin.hardware.inbox import Inbox
from rga.twin.hardware.interface import LIVE, Packet, Station


class Live:
    """The rows that wait for a twin.

    Args:
        inbox: keeps them.
        name: of the twin.

    Raises:
        InputError: no row has ever arrived.
    """

    def __init__(self, inbox: Inbox, name: str) -> None:
        station = inbox.station
        if station is None:
            raise InputError("no row has arrived yet", f"twin {name!r}", "feed rows to it")
        self.source, self.station = f"{LIVE}{name}", station
        self._inbox = inbox

    @property
    def rows(self) -> int:
        """Rows that have arrived."""
        return self._inbox.rows

    @property
    def ended(self) -> bool:
        """Whether no more will come."""
        return self._inbox.ended

    def packet(self, first: int, rows: int) -> Packet:
        """At most so many rows from a row on.

        Raises:
            InputError: the first of them was taken in before, and is asked for again.
        """
        packet = self._inbox.packet(self.station, first, rows)
        if first < self.rows and (packet.first != first or not len(packet.time)):
            raise InputError(
                f"row {first} was taken in before, and the repository does not have it",
                f"twin {self.source!r}",
                "bring the repository back from a copy, or begin another twin",
            )
        return packet

    def taken(self, rows: int) -> None:
        """So many rows are in the repository: the inbox need not keep them."""
        self._inbox.drop(rows)


def check_lives(model: Model) -> None:
    """Whether a twin of a model can go on for ever.

    Raises:
        InputError: it cannot.
    """
    place = f"model {model.name!r}"
    if zeroed := [name for name, one in model.sensors.items() if one.zero is not None]:
        raise InputError(
            f"the zero of {', '.join(zeroed)} is that of rows in a record",
            place,
            "feed readings without it, and state no zero",
        )
    if hindrance := Simulator(model).hindrance:
        raise InputError(hindrance, place, "mend it, or play finished records with rga run")
    if moving := [name for name, one in model.context.items() if one.law == "linear"]:
        raise InputError(
            f"{', '.join(moving)} moves along a line over a whole record",
            place,
            "analyse each passage as a record of its own, with rga diagnose",
        )


def station_for(model: Model, rows: Record) -> Station:
    """What is mounted, as the first rows of a live twin show it.

    Raises:
        InputError: a sensor that the model lacks, or none.
    """
    place = f"model {model.name!r}"
    if unknown := sorted(set(rows.sensors) - set(model.sensors)):
        raise InputError(f"it has no sensor {', '.join(unknown)}", place, "add it, or leave it out")
    if not rows.sensors:
        raise InputError("the rows hold no sensor of it", place, "give one")
    measured = tuple(name for name in model.context if name in rows.contexts)
    start = rows.time_label(float(rows.time[0]))
    none = {name: np.zeros(0) for name in (*measured, "time")}
    return Station(tuple(rows.sensors), measured, start, rows.time_format, none)


def as_rows(station: Station, rows: Record) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Time since the first row of all, readings and measured contexts of rows.

    A channel that is left out is missing. Times are those that a record of the same rows has when
    it is written and read again.

    Raises:
        InputError: a channel or context that the first rows did not have, or another clock.
    """
    place = "rows of a live twin"
    others = set(rows.sensors) - set(station.channels)
    others |= set(rows.contexts) - set(station.measured)
    if others:
        raise InputError(
            f"the first rows had no {', '.join(sorted(others))}",
            place,
            "feed the same channels always, or begin another twin",
        )
    if rows.time_format != station.time_format:
        raise InputError("they write time otherwise than the first did", place, "feed one clock")
    if rows.zero is not None:
        raise InputError("a zero was taken off them", place, "feed readings without it")
    count = len(rows)
    readings = np.full((count, len(station.channels)), np.nan)
    readings[:, [station.channels.index(name) for name in rows.sensors]] = rows.readings
    contexts = np.full((count, len(station.measured)), np.nan)
    for name, values in rows.contexts.items():
        contexts[:, station.measured.index(name)] = values
    labels = [rows.time_label(one) for one in rows.time.tolist()]
    return elapsed_since(station.start, labels), readings, contexts


def elapsed_since(start: str | float, labels: list[str | float]) -> FloatArray:
    """Seconds from one time stamp to others, as whoever reads a record counts them, float[n].

    Raises:
        InputError: some have a time zone and some have none.

    >>> elapsed_since("2026-03-01T23:59:59", ["2026-03-02T00:00:00.250"]).tolist()
    [1.25]
    """
    if not isinstance(start, str):
        return np.array([float(one) - start for one in labels])
    first = datetime.fromisoformat(start)
    moments = [datetime.fromisoformat(str(one)) for one in labels]
    if any((one.tzinfo is None) != (first.tzinfo is None) for one in moments):
        raise InputError(
            "some times have a time zone and some have none",
            "rows of a live twin",
            "write all times alike",
        )
    return np.array([(one - first).total_seconds() for one in moments])
