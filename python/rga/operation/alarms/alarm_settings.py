"""When alarms are raised, as a configuration says it."""

from typing import Annotated

from pydantic import Field

from rga.operation.alarms.condition import AlarmKind
from rga.operation.settings_types import Duration, SettingsTable, Wait


class DelaySettings(SettingsTable):
    """How long a condition is looked at.

    Attributes:
        on: how long something is wrong before an alarm is raised [s].
        off: how long it is well before the alarm is cleared [s].
    """

    on: Wait = Field("60 s", validate_default=True)
    off: Wait = Field("60 s", validate_default=True)


class AlarmSettings(SettingsTable):
    """When alarms are raised; those of the twin's monitor have settings of their own.

    Attributes:
        disk: share of the disk that has to be free [-].
        lag: by which a twin may be behind its rows [s].
        quality, source, service: delays of the alarms of sensors, sources and the service.
    """

    disk: Annotated[float, Field(ge=0, le=1)] = 0.1
    lag: Duration = Field("1 h", validate_default=True)
    quality: DelaySettings = DelaySettings.model_validate({"off": "10 min"})
    source: DelaySettings = DelaySettings()
    service: DelaySettings = DelaySettings()

    @property
    def delays(self) -> dict[AlarmKind, tuple[float, float]]:
        """Delays of every class [s]; what a twin says of itself counts at once."""
        return {
            "gap": (0.0, 0.0),
            "proposal": (0.0, 0.0),
            "quality": (self.quality.on, self.quality.off),
            "source": (self.source.on, self.source.off),
            "service": (self.service.on, self.service.off),
        }
