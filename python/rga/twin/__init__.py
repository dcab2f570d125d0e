"""The twin that keeps itself true: architecture, queries and responses, and the loop."""

from rga.lazy import needing_extras

with needing_extras():
    from rga.twin.calibration.estimator import ContextEstimator
    from rga.twin.calibration.lesson import Lesson
    from rga.twin.history import Event, History, Version
    from rga.twin.outcome import Outcome
    from rga.twin.settings import Settings
    from rga.twin.twin import Twin, rollback

__all__ = [
    "ContextEstimator",
    "Event",
    "History",
    "Lesson",
    "Outcome",
    "Settings",
    "Twin",
    "Version",
    "rollback",
]
