"""Where a run stands: all that a resumed run needs beyond what the repository holds in tables."""

from typing import Literal

from pydantic import BaseModel, ConfigDict

from rga.twin.commands.exclusion import Excluded
from rga.twin.settings import Inference

Stage = Literal[
    "initialise", "gather", "calibrate", "watch", "recalibrate", "diagnose", "close", "report",
    "done",
]  # fmt: skip


class Standing(BaseModel):
    """Where a run stands.

    Attributes:
        stage: what is to be done next.
        row: the next row of the record.
        calibrated: rows of the first calibration.
        stuck: channels that stood still on these.
        alarm: row of an alarm that has not been dealt with.
        since: first row that the alarm is about.
        synchronised: rows when the twin was last calibrated, recalibrated or given a version.
        interval: rows from there to the next recalibration by the clock.
        draws: seeds drawn so far.
        own: whether an estimator of the caller's own infers.
        state: number of the kept state that is in force; None: none is.
        inference: the way to infer contexts; "auto" until one is chosen.
        learned_under: version of the model that the estimators are about.
        optimism: gap of rows that the calibration did not learn from, over that of its own [-].
        share: by which the model was off on the rows of the first calibration [-].
        distinct: least distance of a novel context, in shares of the ranges.
        diagnosed: rows of the last diagnosis.
        changed: rows when the version last changed.
        proposed: first of the rows that stand under what was proposed last; None: nothing was.
        about_change: whether the last diagnosis asked what has changed.
        ended: whether no more rows will come.
        excluded: readings that are not used: a sensor, and the clock from and to which [s]; None:
            it goes on.
        keep: latest rows whose readings are kept; None: all are.
        forgotten: row up to which readings were looked through for what can be forgotten.
        forgotten_rows: first row of, and row behind, stretches whose readings are forgotten.
        commanded: number of the last command that was taken from the inbox.
        doubted: whether a recalibration did not bring the gap down, or a version was put in force
            by hand that does not explain the latest rows, and nothing has explained them.
    """

    model_config = ConfigDict(extra="forbid")
    stage: Stage = "initialise"
    row: int = 0
    calibrated: int = 0
    stuck: tuple[str, ...] = ()
    alarm: int | None = None
    since: int | None = None
    synchronised: int = 0
    interval: int = 0
    draws: int = 0
    own: bool = False
    state: int | None = None
    inference: Inference = "auto"
    learned_under: int = 0
    optimism: float = 1.0
    share: float = 0.0
    distinct: float = 0.0
    diagnosed: int | None = None
    changed: int = 0
    proposed: int | None = None
    about_change: bool = False
    ended: bool = False
    excluded: tuple[Excluded, ...] = ()
    keep: int | None = None
    forgotten: int = 0
    forgotten_rows: tuple[tuple[int, int], ...] = ()
    commanded: int = 0
    doubted: bool = False

    @property
    def out_of_sync(self) -> bool:
        """Whether readings have left what the model lets expect, and nothing in force explains it.

        It is so while an alarm is dealt with, and where what came of it left the model in doubt.
        """
        return self.alarm is not None or self.doubted
