"""Where a run stands, in few words."""

from dataclasses import dataclass

from rga.twin.history import Event
from rga.twin.run_state import Stage

#: events that are shown, the latest
SHOWN = 5
#: what a run does next
NEXT: dict[Stage, str] = {
    "initialise": "it has not begun",
    "gather": "it gathers rows for the first calibration",
    "calibrate": "it calibrates next",
    "watch": "it watches",
    "recalibrate": "it recalibrates next",
    "diagnose": "it asks the diagnosis next",
    "close": "it asks the closing diagnosis next",
    "report": "it writes its report next",
    "done": "it is done",
}


@dataclass(frozen=True)
class Status:
    """Where a run stands.

    Attributes:
        structure: name of the model.
        stage: what is to be done next.
        rows: that were taken in.
        time: of the last of them, as the record writes it; None before the first.
        version: number of the model version in force.
        causes: effects that it has beyond the model as given, in words.
        out_of_sync: whether an alarm is open: readings have left what the model lets expect, and
            nothing in force explains it.
        undecided: the proposal that nobody has decided about, in words; None: there is none.
        forgotten: first and last row of stretches whose readings are forgotten.
        acknowledged_at: wall clock at the last step, UTC, as ISO 8601 text.
        events: the latest, in the order in which they happened.
    """

    structure: str
    stage: Stage
    rows: int
    time: str | float | None
    version: int
    causes: tuple[str, ...]
    out_of_sync: bool
    undecided: str | None
    forgotten: tuple[tuple[int, int], ...]
    acknowledged_at: str
    events: tuple[Event, ...]

    def words(self) -> str:
        """The same in a few lines."""
        last = "" if self.time is None else f", the last of {_moment(self.time)}"
        causes = f" with {', '.join(self.causes)}" if self.causes else ""
        state = "out of sync" if self.out_of_sync else "no alarm is open"
        told = []
        if self.undecided is not None:
            told.append(f"To be decided: {self.undecided}.")
        if self.forgotten:
            count = sum(end + 1 - first for first, end in self.forgotten)
            begin, end = self.forgotten[0][0], self.forgotten[-1][1]
            told.append(f"Readings of {count} rows from {begin} to {end} are forgotten.")
        return "\n".join(
            [
                f"{self.structure}: {self.rows} rows{last}; {NEXT[self.stage]}.",
                f"Model version {self.version} is in force{causes}; {state}.",
                *told,
                *(f"row {one.row:>6}  {one.kind}: {one.words}" for one in self.events),
                f"Last step: {self.acknowledged_at}.",
            ]
        )


def _moment(time: str | float) -> str:
    return time if isinstance(time, str) else f"{time:g} s"
