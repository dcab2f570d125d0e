"""The detector of a run, as its settings ask for it."""

from collections.abc import Sequence

from rga.twin.settings import Settings
from rga.twin.sync.monitor import Monitored
from rga.twin.sync.protocol import Synchrony
from rga.twin.sync.window_rule import WindowRule


def synchrony(channels: Sequence[str], settings: Settings) -> Synchrony:
    """The detector that settings ask for.

    Args:
        channels: names of the sensors.
        settings: of the run.
    """
    kind = Monitored if settings.detector == "monitor" else WindowRule
    return kind(channels, settings)
