"""Detection: is the twin still in sync with the structure?"""

from rga._core import GaussianWindow
from rga.detection.alarm_explanation import Alarm
from rga.detection.monitor import SyncMonitor, rows_between

__all__ = ["Alarm", "GaussianWindow", "SyncMonitor", "rows_between"]
