"""Rows that go on arriving at bridges in which nothing happens."""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

import rga
from rga.model import Model
from rga.records import Record
from rga.twin import Settings
from rga_bench.speed.sized_case import SizedCase

#: rows that are drawn; they come again and again
DRAWN = 5_000
#: seconds from row to row
EVERY = 60.0
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Stream:
    """A bridge that reads a row a minute, all contexts measured.

    Attributes:
        sensors, panels: how many there are.
        settings: of its twin.
        seed: of what is drawn.
    """

    sensors: int
    panels: int
    settings: Settings
    seed: int

    @cached_property
    def _case(self) -> tuple[Model, Record]:
        return SizedCase(DRAWN, self.sensors, self.panels, "nothing", self.seed).draw()

    @property
    def model(self) -> Model:
        """As it is given."""
        return self._case[0]

    @property
    def record(self) -> Record:
        """The rows that are drawn."""
        return self._case[1]

    def rows(self, first: int, end: int) -> Record:
        """Rows from one to before another, however many there were before."""
        chosen = np.arange(first, end)
        part = self.record.rows(chosen % DRAWN)
        return replace(
            part, time=EVERY * chosen.astype(np.float64), start=0.0, time_format="seconds"
        )

    def twin(self, directory: Path) -> rga.LiveTwin:
        """The live twin in a directory."""
        return rga.live(self.model, directory, settings=self.settings, seed=self.seed)

    def play(self, twin: rga.LiveTwin, first: int, end: int) -> float:
        """Feed rows and let a twin take them in.

        Returns:
            What a row took [s].
        """
        rows, begun = self.rows(first, end), time.perf_counter()
        twin.feed(rows)
        twin.play()
        return (time.perf_counter() - begun) / (end - first)


def settings(packet: int, **more: object) -> Settings:
    """Of twins that raise no false alarm: what is measured is what every row costs."""
    stated = {"packet": packet, "calibration_rows": 200, "settle": 100, "arl0": 1e12}
    return Settings.model_validate({**stated, **more})
