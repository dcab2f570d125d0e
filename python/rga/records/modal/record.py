"""Modes that were found in windows of time, before anybody knows which is which."""

from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.model.effect import seconds
from rga.records.record import time_label


@dataclass(frozen=True)
class ModalRecord:
    """One entry for each mode that was found in a window; one that was not found has none.

    Attributes:
        time: middle of the window [s], float[entries], on the scale of `start`.
        start: ISO 8601 time stamp of time 0, or a number of seconds.
        duration: of the window [s], float[entries]; NaN where it is not said.
        frequency: [Hz], float[entries].
        frequency_sd: standard deviation that the identification states [Hz], float[entries]; NaN
            where it states none. It weighs windows against each other, and is not believed.
        damping: share of the critical one, float[entries]; NaN where it is not said.
        points: names of the model's points at which shapes were measured.
        shapes: motion there, float[entries, points], turned to be as real as it can be; NaN where
            a point did not measure.
        realness: share of a shape that is in phase, float[entries]; 1 where only real parts are
            given.
        hint: what the file calls the mode, one text an entry; empty where it says nothing.
        contexts: context variables that the file has beside, float[entries] each.
        left_out: columns that say nothing of this.
        sha256: hash of the file.
        repeated: entries that stood there more than once, and count once.
    """

    time: FloatArray
    start: str | float
    duration: FloatArray
    frequency: FloatArray
    frequency_sd: FloatArray
    damping: FloatArray
    points: tuple[str, ...]
    shapes: FloatArray
    realness: FloatArray
    hint: tuple[str, ...]
    contexts: dict[str, FloatArray]
    left_out: tuple[str, ...]
    sha256: str
    repeated: int = 0

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def origin(self) -> float:
        """Time 0 on the scale of onsets [s]: as in the file, or since 1970."""
        return seconds(self.start)

    def time_label(self, elapsed: float) -> str | float:
        """A time [s since time 0] as the record writes it: ISO 8601 text, or seconds."""
        return time_label(self.start, elapsed)

    def entries(self, chosen: BoolArray) -> "ModalRecord":
        """The record of some of its entries.

        Args:
            chosen: bool[entries].
        """
        columns = {
            name: getattr(self, name)[chosen]
            for name in (
                "time", "duration", "frequency", "frequency_sd", "damping", "shapes", "realness",
            )
        }  # fmt: skip
        hint = tuple(one for one, kept in zip(self.hint, chosen, strict=True) if kept)
        contexts = {name: column[chosen] for name, column in self.contexts.items()}
        return replace(self, **columns, hint=hint, contexts=contexts)

    def once(self) -> "ModalRecord":
        """The record without entries that repeat another: time, frequency, hint and shape."""
        hint = np.unique(np.array(self.hint), return_inverse=True)[1].ravel()
        shapes = np.nan_to_num(self.shapes, nan=np.inf)  # nothing measured is like itself
        entries = np.column_stack([self.time, self.frequency, hint, shapes])
        first = np.unique(entries, axis=0, return_index=True)[1]
        kept = np.isin(np.arange(len(self)), first)
        return replace(self.entries(kept), repeated=self.repeated + int((~kept).sum()))

    @property
    def windows(self) -> IntArray:
        """Number of the window of each entry, int[entries], in the order of time."""
        _, number = np.unique(self.time, return_inverse=True)
        return np.asarray(number.ravel(), dtype=np.int64)
