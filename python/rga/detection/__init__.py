"""Detection: is the twin still in sync with the structure?"""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
    from rga._core import GaussianWindow
    from rga.detection.alarm_explanation import Alarm
    from rga.detection.monitor import SyncMonitor
    from rga.detection.rarity import rows_between

__all__ = [
    "Alarm",
    "GaussianWindow",
    "SyncMonitor",
    "rows_between",
]

# They are opened on first use, so that a part is used without the others.
_HOMES = {
    "Alarm": "rga.detection.alarm_explanation",
    "GaussianWindow": "rga._core",
    "SyncMonitor": "rga.detection.monitor",
    "rows_between": "rga.detection.rarity",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
