"""Where data of a twin comes from, as the file of a service says it."""

import re
from pathlib import Path
from typing import Annotated, Literal
from urllib.parse import urlsplit

from pydantic import Field, StrictBool, field_validator, model_validator
from sqlalchemy.engine import make_url
from sqlalchemy.exc import ArgumentError

from rga.operation.packets.formats import PayloadFormat, StatedFormat
from rga.operation.packets.topics import TopicPattern
from rga.operation.settings_types import Duration, Name, SettingsTable
from rga.operation.sources.clock import ClockRule

#: address of a variable: numbers of namespace and server, and a number, name, GUID or bytes
_NODE = re.compile(r"(?:(?:ns|srv)=\d+;|nsu=[^;]+;)*(?:i=\d+|[sgb]=.+)", re.DOTALL)


class ClockSettings(SettingsTable):
    """What is believed of the clock of a logger.

    Attributes:
        check: False: all, as where a record is played faster than it was measured.
        tolerance: by which it may be ahead of that of this machine [s].
        backlog: how long before they arrive readings may be from [s].
    """

    check: StrictBool = True
    tolerance: Duration = Field("30 min", validate_default=True)
    backlog: Duration = Field("7 d", validate_default=True)

    @property
    def rule(self) -> ClockRule | None:
        """None: all is believed."""
        return ClockRule(self.tolerance, self.backlog) if self.check else None


class SourceSettings(SettingsTable):
    """What every source states.

    Attributes:
        name: by which it is accounted for; left out, its kind.
        mapping: import.toml of the logger, beside the configuration.
        clock: what is believed of its clock.
    """

    name: Name | None = None
    mapping: Path | None = None
    clock: ClockSettings = ClockSettings()

    @property
    def stated(self) -> StatedFormat:
        """What is known of the payloads before they come."""
        return StatedFormat("packet")


class PayloadSettings(SourceSettings):
    """What a source states whose payloads are those of loggers.

    Attributes:
        format: of all payloads; left out, each is looked at.
        columns: names of the columns of rows that are sent without them, in their order.
    """

    format: PayloadFormat | None = None
    columns: Annotated[list[str], Field(default_factory=list)]

    @property
    def stated(self) -> StatedFormat:
        """What is known of the payloads before they come."""
        return StatedFormat(self.format, None, tuple(self.columns))

    @model_validator(mode="after")
    def _columns_of_rows(self) -> "PayloadSettings":
        if self.format == "row" and not self.columns:
            raise ValueError('format = "row" needs columns = ["time", "D1"], as they are sent')
        if self.columns and self.format != "row":
            raise ValueError('columns are of rows: state format = "row" too, or leave them out')
        if len(set(self.columns)) < len(self.columns):
            raise ValueError("columns: name every column once")
        return self


class HttpSource(PayloadSettings):
    """Loggers that send to this service."""

    kind: Literal["http"]

    @field_validator("format")
    @classmethod
    def _named(cls, stated: PayloadFormat | None) -> PayloadFormat | None:
        if stated == "number":
            raise ValueError("a number that is sent to the service names no channel")
        return stated


class MqttSource(PayloadSettings):
    """A broker that loggers send to.

    Attributes:
        url: mqtt:// or mqtts://, host and port.
        topics: that hold data; + and # as in MQTT.
        channel_topic: where a topic names the channel of a number, such as "site/+/{channel}".
        credentials: file of two lines, user and password.
        tell: whether the broker is told how the twin is: state, gaps, alarms, events, proposals.
    """

    kind: Literal["mqtt"]
    url: str
    topics: Annotated[list[str], Field(min_length=1)]
    channel_topic: str | None = None
    credentials: Path | None = None
    tell: StrictBool = False

    @property
    def stated(self) -> StatedFormat:
        """What is known of the payloads before they come."""
        pattern = TopicPattern(self.channel_topic) if self.channel_topic else None
        return StatedFormat(self.format, pattern, tuple(self.columns))

    @field_validator("channel_topic")
    @classmethod
    def _pattern(cls, pattern: str | None) -> str | None:
        if pattern is not None:
            TopicPattern(pattern)
        return pattern

    @model_validator(mode="after")
    def _broker(self) -> "MqttSource":
        _check_address(self.url, ("mqtt", "mqtts"), "broker", "mqtt://host:1883")
        if self.format == "number" and self.channel_topic is None:
            raise ValueError('format = "number" needs channel_topic = "site/{channel}"')
        if self.channel_topic is not None and self.format != "number":
            raise ValueError('channel_topic is of numbers: state format = "number" too')
        return self


class FolderSource(PayloadSettings):
    """A folder that files are written to.

    Attributes:
        path: of it.
        files: names of the files, * for any text.
        poll: how often it is looked at [s].
    """

    kind: Literal["folder"]
    path: Path
    files: str = "*"
    poll: Duration = Field("5 s", validate_default=True)

    @field_validator("files")
    @classmethod
    def _within(cls, files: str) -> str:
        if not files or files.startswith("/") or ".." in files.split("/"):
            raise ValueError("files: give a pattern of names within the folder, such as '*.dat'")
        return files


class SqlSource(SourceSettings):
    """A table that somebody else writes to.

    Attributes:
        url: of the database, as SQLAlchemy has it, without a password.
        password: file of one line.
        table: its name, or "schema.name".
        time: column of the time of a reading.
        position: column that rises from row to row, by which new rows are found.
        channel, value: columns of name and number where a row is one reading; left out, every
            other column is a channel.
        overlap: how far behind the highest position rows are looked for again, as one may become
            visible after others that came later: in numbers, or in seconds where positions are
            times.
        poll: how often it is looked at [s].
    """

    kind: Literal["sql"]
    url: str
    password: Path | None = None
    table: Annotated[str, Field(min_length=1)]
    time: str = "time"
    position: str
    channel: str | None = None
    value: str | None = None
    overlap: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 60.0
    poll: Duration = Field("5 s", validate_default=True)

    @model_validator(mode="after")
    def _database(self) -> "SqlSource":
        try:
            url = make_url(self.url)
        except ArgumentError:
            raise ValueError(f"{self.url!r} is no address of a database") from None
        if url.password is not None:
            raise ValueError("url holds a password: name a file of it as password instead")
        if (self.channel is None) != (self.value is None):
            raise ValueError("channel and value: give both, or neither of the two")
        return self


class OpcUaSource(SourceSettings):
    """Variables of a server of OPC UA.

    Attributes:
        url: opc.tcp://, host and port.
        nodes: address of the variable, such as "ns=2;s=D1", by channel.
        credentials: file of two lines, user and password.
        poll: how often what was told is kept [s].
    """

    kind: Literal["opcua"]
    url: str
    nodes: Annotated[dict[str, str], Field(min_length=1)]
    credentials: Path | None = None
    poll: Duration = Field("1 s", validate_default=True)

    @property
    def stated(self) -> StatedFormat:
        """What is known of the payloads before they come: their channels too."""
        return StatedFormat("packet", columns=tuple(self.nodes))

    @field_validator("nodes")
    @classmethod
    def _addresses(cls, nodes: dict[str, str]) -> dict[str, str]:
        if wrong := next((one for one in nodes.values() if not _NODE.fullmatch(one)), None):
            raise ValueError(f"{wrong!r} is no address of a variable: write 'ns=2;s=D1'")
        return nodes

    @model_validator(mode="after")
    def _server(self) -> "OpcUaSource":
        _check_address(self.url, ("opc.tcp",), "server", "opc.tcp://host:4840")
        return self


AnySource = HttpSource | MqttSource | FolderSource | SqlSource | OpcUaSource


def source_name(source: AnySource) -> str:
    """Name of a source in its twin."""
    return source.name or source.kind


def _check_address(url: str, schemes: tuple[str, ...], what: str, example: str) -> None:
    parts = urlsplit(url)
    if parts.scheme not in schemes or not parts.hostname:
        raise ValueError(f"{url!r} is no {what}: write {example}")
    if parts.username or parts.password:
        raise ValueError("url holds a password: name a file of credentials instead")
