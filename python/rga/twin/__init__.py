"""The twin that keeps itself true: architecture, queries and responses, and the loop."""

from rga.lazy import needing_extras

with needing_extras():
    from rga.twin.calibration.estimator import ContextEstimator
    from rga.twin.calibration.lesson import Lesson
    from rga.twin.commands.command import (
        Accept,
        Exclude,
        Forget,
        Note,
        Recalibrate,
        Reject,
        Rollback,
    )
    from rga.twin.history import Event, History, Version
    from rga.twin.outcome import Outcome
    from rga.twin.settings import Settings
    from rga.twin.twin import Twin, carry_out, rollback

__all__ = [
    "Accept",
    "ContextEstimator",
    "Event",
    "Exclude",
    "Forget",
    "History",
    "Lesson",
    "Note",
    "Outcome",
    "Recalibrate",
    "Reject",
    "Rollback",
    "Settings",
    "Twin",
    "Version",
    "carry_out",
    "rollback",
]
