"""The twin that keeps itself true: architecture, queries and responses, and the loop."""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
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

# They are opened on first use, so that a part is used without the others.
_HOMES = {
    "Accept": "rga.twin.commands.command",
    "ContextEstimator": "rga.twin.calibration.estimator",
    "Event": "rga.twin.history",
    "Exclude": "rga.twin.commands.command",
    "Forget": "rga.twin.commands.command",
    "History": "rga.twin.history",
    "Lesson": "rga.twin.calibration.lesson",
    "Note": "rga.twin.commands.command",
    "Outcome": "rga.twin.outcome",
    "Recalibrate": "rga.twin.commands.command",
    "Reject": "rga.twin.commands.command",
    "Rollback": "rga.twin.commands.command",
    "Settings": "rga.twin.settings",
    "Twin": "rga.twin.twin",
    "Version": "rga.twin.history",
    "carry_out": "rga.twin.twin",
    "rollback": "rga.twin.twin",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
