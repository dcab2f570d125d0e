"""Where notices go, as a configuration says it."""

from datetime import time
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, field_validator

from rga.operation.settings_types import Rate, SettingsTable

#: classes of alarms, and causes within them; `alarm` is the alarm of the twin's monitor
Topic = Literal[
    "alarm", "gap", "quality", "source", "service", "proposal",
    "silent", "stuck", "out of range", "conflict", "refused", "doubted",
    "down", "missing", "numbers", "clock", "fault",
    "disk", "lag", "rows", "repository", "inbox", "parked", "account", "undelivered",
]  # fmt: skip


class NotifySettings(SettingsTable):
    """Where notices go.

    Attributes:
        url_file: of one line or more, each an address as apprise takes it; a secret.
        on: classes of alarms that are told of, or causes of them.
        at_most: messages within an hour or a day; what is held back is counted in the next.
        all_is_well: when a line is sent every day, whatever there is to tell, in UTC; None: never.
    """

    url_file: Path
    on: Annotated[tuple[Topic, ...], Field(min_length=1)] = (
        "alarm", "proposal", "quality", "source", "service",
    )  # fmt: skip
    at_most: Rate = Field("12 an hour", validate_default=True)
    all_is_well: time | None = None

    @field_validator("all_is_well")
    @classmethod
    def _in_utc(cls, given: time | None) -> time | None:
        if given is not None and given.tzinfo is not None:
            raise ValueError("it is in UTC: write it as '07:00'")
        return given

    @property
    def name(self) -> str:
        """By which it is known: nothing of what is secret."""
        return self.url_file.name
